"""Tables and pictures for notebooks. Everything that is not ours is escaped; colours are those of
the notebook (`currentColor`) or legible on light and dark ground."""

import math
from html import escape
from typing import TYPE_CHECKING, Callable, Dict, List, Sequence, Tuple, Union

if TYPE_CHECKING:
    from ._explanations import Explanation
    from ._runs import Discrepancy, Rates, Run, Sample
    from ._traces import Answer, Check, Trace

_BLUE, _RED, _GREY, _GREEN = "#4a86d8", "#d9534f", "#8c8c8c", "#3f9f5f"
_ROWS, _COLUMNS, _MARKS = 60, 120, 4000  # what is drawn at most

Cells = Sequence[Union[str, int, float, None]]


def _text(value: object) -> str:
    return escape("" if value is None else str(value))


def _counted(number: int, what: str) -> str:
    return "%d %s%s" % (number, what, "" if number == 1 else "s")


def _number(value: float) -> str:
    return "%.4g" % value


def _table(head: Sequence[str], rows: Sequence[Cells]) -> str:
    cell = '<td style="text-align:left;vertical-align:top">%s</td>'
    out = "<table><thead><tr>%s</tr></thead><tbody>" % "".join(
        '<th style="text-align:left">%s</th>' % _text(one) for one in head)
    for row in rows[:_ROWS]:
        out += "<tr>%s</tr>" % "".join(cell % _text(one) for one in row)
    out += "</tbody></table>"
    if len(rows) > _ROWS:
        out += "<p>%d further rows are not shown</p>" % (len(rows) - _ROWS)
    return out


def _svg(width: float, height: float, title: str, body: str) -> str:
    return (
        '<svg xmlns="http://www.w3.org/2000/svg" role="img" viewBox="0 0 %.0f %.0f" width="%.0f" '
        'style="max-width:100%%;height:auto;color:inherit" font-family="sans-serif" font-size="12">'
        "<title>%s</title>%s</svg>" % (width, height, width, _text(title), body))


def _words(x: float, y: float, text: str, more: str = "") -> str:
    return '<text x="%.1f" y="%.1f" fill="currentColor" %s>%s</text>' % (x, y, more, _text(text))


def _shortened(text: str, length: int = 36) -> str:
    return text if len(text) <= length else text[: length - 1] + "…"


def timeline(trace: "Trace") -> str:
    """A row for each fluent that holds at some time, a bar where it holds, events between the
    timepoints at which they happen and the next ones."""
    points = trace.timepoints[:_COLUMNS]
    names: List[str] = []
    for point in points:
        names += [name for name in point.holds if name not in names]
    shown = names[:_ROWS]
    longest = max([len(_shortened(event, 24)) for point in points for event in point.happens] or [0])
    step, row, top = max(74.0, 12.0 + 7.5 * longest), 20.0, 24.0
    left = 14.0 + 7.0 * max([len(_shortened(name)) for name in shown] or [1])
    most = max([len(point.happens) for point in points] or [0])
    above = top + 14.0 * max(most, 1) + 8.0
    width = left + step * max(len(points) - 1, 0) + 40.0
    height = above + row * len(shown) + 8.0
    body = ""
    for at, point in enumerate(points):
        x = left + step * at
        body += '<line x1="%.1f" y1="%.1f" x2="%.1f" y2="%.1f" stroke="currentColor" ' \
                'stroke-opacity="0.2"/>' % (x, top, x, height)
        body += _words(x, 14, str(point.time), 'text-anchor="middle" font-size="11"')
        for line, event in enumerate(point.happens):
            body += _words(x + 3, top + 12 + 14 * line, _shortened(event, 24), 'font-weight="bold"')
    for line, name in enumerate(shown):
        y = above + row * line
        body += _words(0, y + 13, _shortened(name))
        for at, point in enumerate(points):
            if name in point.holds:
                last = at + 1 == len(points)
                body += '<rect x="%.1f" y="%.1f" width="%.1f" height="12" fill="%s"/>' % (
                    left + step * at, y + 3, 10 if last else step, _BLUE)
    out = _svg(width, height, "trace %d" % trace.number, body)
    left_out = []
    if len(names) > len(shown):
        left_out.append("%d further fluents" % (len(names) - len(shown)))
    if len(trace.timepoints) > len(points):
        left_out.append("timepoints from %d on" % trace.timepoints[len(points)].time)
    said = "trace %d" % trace.number
    if trace.ended:
        said += ", plan ended: " + trace.ended
    if trace.predicates:
        said += "; " + " ".join(trace.predicates[:_ROWS])
    if left_out:
        said += "; not drawn: " + ", ".join(left_out)
    return "<div><p>%s</p>%s</div>" % (_text(said), out)


def check(found: "Check") -> str:
    if not found.diagnostics:
        return "<p>no errors, no warnings</p>"
    return _table(["where", "", "", "what to do"], [
        [one.location, "%s %s" % (one.severity, one.code), one.message, one.fix or one.help]
        for one in found.diagnostics])


def answer(said: "Answer") -> str:
    if said.trace is None:
        words = {"holds": "holds up to horizon %d" % said.horizon,
                 "inconclusive": "not known: a limit ended the search"}[said.verdict]
        if said.proof:
            words += "; proof: " + said.proof
        return "<p>%s</p>" % _text(words)
    words = "violated at timepoint %s" % said.timepoint
    if said.words:
        words += ": " + said.words
    return "<p>%s</p>%s" % (_text(words), timeline(said.trace))


def explanation(found: "Explanation") -> str:
    if found.satisfiable:
        return "<p>nothing contradicts: the model has a trace, or admits what was observed</p>"
    out = "<p>%s</p>" % _text(found.words) if found.words else ""
    if found.rule:
        out += "<p>fails where %s</p>" % _text(found.rule)
    for number, one in enumerate(found.conflicts, 1):
        words = one.words or "these axioms exclude each other"
        out += "<p>set %d: %s</p>" % (number, _text(words))
        out += _table(["axiom", "where"], [
            [axiom.text, "%s:%s" % (axiom.file, axiom.line) if axiom.line else axiom.file]
            for axiom in one.axioms])
    return "<div>%s</div>" % out


# A kind of outcome: how it is drawn, and what it is called.
_OUTCOMES: Dict[str, Tuple[str, str]] = {
    "clean": (_GREEN, "ring"), "admitted": (_BLUE, "ring"), "discrepancy": (_RED, "square"),
    "unfinished": (_GREY, "square"), "lost": (_GREY, "cross")}


def _mark(x: float, y: float, outcome: str, title: str) -> str:
    colour, shape = _OUTCOMES.get(outcome, (_GREY, "cross"))
    tip = "<title>%s</title>" % _text(title)
    if shape == "square":
        return '<rect x="%.1f" y="%.1f" width="8" height="8" fill="%s" fill-opacity="0.8">%s</rect>' \
            % (x - 4, y - 4, colour, tip)
    if shape == "cross":
        return '<path d="M%.1f %.1fl8 8m0 -8l-8 8" stroke="%s" stroke-width="2">%s</path>' % (
            x - 4, y - 4, colour, tip)
    return '<circle cx="%.1f" cy="%.1f" r="4" fill="none" stroke="%s" stroke-width="2">%s</circle>' \
        % (x, y, colour, tip)


def _separation(values: Sequence[float], bad: Sequence[bool]) -> float:
    """How well a border in this variable parts what went wrong from what did not: from 0 to 0.5,
    the distance of the area under the ROC curve from one half (ties count half)."""
    positives = sum(bad)
    if positives in (0, len(bad)):
        return 0.0
    order = sorted(zip(values, bad))
    ranks, at = 0.0, 0
    while at < len(order):
        end = at
        while end < len(order) and order[end][0] == order[at][0]:
            end += 1
        mean = (at + end + 1) / 2
        ranks += mean * sum(one for _, one in order[at:end])
        at = end
    area = (ranks - positives * (positives + 1) / 2) / (positives * (len(bad) - positives))
    return abs(area - 0.5)


def _varying(samples: Sequence["Sample"]) -> List[str]:
    """Variables that differ among the starts, those first that part what went wrong."""
    bad = [one.outcome == "discrepancy" for one in samples]
    ranked = []
    for name in sorted({name for one in samples for name in one.start}):
        values = [one.start.get(name) for one in samples]
        numbers = [float(one) for one in values
                   if isinstance(one, (int, float)) and math.isfinite(one)]
        if len(numbers) == len(samples) and len(set(numbers)) > 1:
            ranked.append((-_separation(numbers, bad), name))
    return [name for _, name in sorted(ranked)]


def _unit(name: str) -> str:
    last = name.rsplit(".", 1)[-1]
    return {"x": " [m]", "y": " [m]", "z": " [m]", "yaw": " [rad]", "mass": " [kg]"}.get(last, "")


def _scale(values: Sequence[float], low: float, high: float) -> Callable[[float], float]:
    least, most = min(values), max(values)
    span = most - least or 1.0
    return lambda value: low + (value - least) / span * (high - low)


def starts(samples: Sequence["Sample"]) -> str:
    """Starts in the two variables that matter most, as far as the outcomes tell; with one variable
    alone against the number of the simulation."""
    shown = samples[:_MARKS]
    names = _varying(shown)
    if not names:
        return ""
    xs = [float(one.start[names[0]]) for one in shown]
    label_y = names[1] + _unit(names[1]) if len(names) > 1 else "simulation"
    ys = [float(one.start[names[1]]) for one in shown] if len(names) > 1 else [
        float(at) for at in range(1, len(shown) + 1)]
    left, top, right, bottom = 64.0, 30.0, 440.0, 280.0
    to_x, to_y = _scale(xs, left + 8, right - 8), _scale(ys, bottom - 8, top + 8)
    body = '<rect x="%.0f" y="%.0f" width="%.0f" height="%.0f" fill="none" stroke="currentColor" ' \
           'stroke-opacity="0.4"/>' % (left, top, right - left, bottom - top)
    for value, anchor in ((min(xs), "start"), (max(xs), "end")):
        at = left if anchor == "start" else right
        body += _words(at, bottom + 16, _number(value), 'text-anchor="%s" font-size="11"' % anchor)
    for value, y in ((min(ys), bottom), (max(ys), top + 10)):
        body += _words(left - 6, y, _number(value), 'text-anchor="end" font-size="11"')
    body += _words((left + right) / 2, bottom + 16, names[0] + _unit(names[0]),
                   'text-anchor="middle"')
    body += _words(left - 48, (top + bottom) / 2, label_y, 'text-anchor="middle" transform='
                   '"rotate(-90 %.1f %.1f)"' % (left - 48, (top + bottom) / 2))
    at = left
    for outcome in sorted({one.outcome for one in shown}, key=list(_OUTCOMES).index
                          if all(one.outcome in _OUTCOMES for one in shown) else None):
        count = sum(one.outcome == outcome for one in shown)
        words = "%d %s" % (count, outcome)
        body += _mark(at + 4, 14, outcome, outcome) + _words(at + 14, 18, words)
        at += 30 + 7 * len(words)
    for one, x, y in zip(shown, xs, ys):
        tip = "%s: %s" % (one.id, one.cause or one.outcome)
        body += _mark(to_x(x), to_y(y), one.outcome, tip)
    out = _svg(460, 304, "starts of %d simulations" % len(shown), body)
    if len(samples) > len(shown):
        out += "<p>the first %d of %d simulations</p>" % (len(shown), len(samples))
    return out


def _discrepancy(found: "Discrepancy") -> str:
    words = "%s: %s" % (found.id, found.words)
    rows = [[one.fluent, str(one.predicted).lower(), str(one.observed).lower(), one.measured]
            for one in found.fluents]
    return "<p>%s</p>%s" % (_text(words), _table(["fluent", "predicted", "observed", "measured"],
                                                 rows))


def run(result: "Run") -> str:
    out = "<p><b>%s</b>: %s, seed %d, %s of %s (%s)</p>" % (
        _text(result.verdict), _text(result.scenario), result.seed,
        _counted(result.simulations, "simulation"), _counted(result.iterations, "trace"),
        _text(result.exploration))
    out += _table(["trace", "events", "verdict", "simulations", "clean", "claim"], [
        [one.trace, " ".join(one.events), one.verdict, one.simulations, one.clean, one.claim]
        for one in result.traces])
    out += "".join(_discrepancy(one) for one in result.discrepancies[:3])
    if len(result.discrepancies) > 3:
        out += "<p>%d further discrepancies</p>" % (len(result.discrepancies) - 3)
    return "<div>%s%s</div>" % (out, starts(result.samples))


def _interval(rate: float, lower: float, upper: float) -> str:
    left, width = 4.0, 200.0
    body = '<line x1="4" y1="9" x2="204" y2="9" stroke="currentColor" stroke-opacity="0.2"/>'
    body += '<line x1="%.1f" y1="9" x2="%.1f" y2="9" stroke="%s" stroke-width="5"/>' % (
        left + width * lower, left + width * upper, _BLUE)
    body += '<circle cx="%.1f" cy="9" r="5" fill="%s"/>' % (left + width * rate, _BLUE)
    title = "%s, from %s to %s" % (_number(rate), _number(lower), _number(upper))
    return _svg(208, 18, title, body)


def rates(result: "Rates") -> str:
    level = "" if result.confidence is None else " with %g %% confidence" % (
        100 * result.confidence)
    out = "<p>%s, seed %d; intervals%s%s</p>" % (
        _text(result.scenario), result.seed, level,
        "" if result.complete else "; stopped before all runs were made")
    out += '<table><thead><tr><th style="text-align:left">trace</th><th style="text-align:left">' \
           'cause</th><th>count</th><th>rate</th><th>interval</th></tr></thead><tbody>'
    for trace in result.traces[:_ROWS]:
        for one in (trace.any, *trace.causes)[:_ROWS]:
            out += '<tr><td style="text-align:left">%d</td><td style="text-align:left">%s</td>' \
                   "<td>%d of %d</td><td>%.1f %%</td><td>%s</td></tr>" % (
                       trace.trace, _text(one.cause), one.count, trace.runs, 100 * one.rate,
                       _interval(one.rate, one.lower, one.upper))
    return "<div>%s</tbody></table>%s</div>" % (out, starts(result.samples))


