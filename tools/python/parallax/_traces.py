"""What the program tells of a model: traces, counts, answers about properties."""

from dataclasses import dataclass, field
from typing import Any, List, Optional, Tuple

from . import _html
from ._errors import Diagnostic, diagnostics_of
from ._frames import frame
from ._json import Object, objects, optional_int, texts


@dataclass(frozen=True)
class Timepoint:
    """What is true at one timepoint of a trace. Atoms are texts without blanks, sorted."""

    time: int
    happens: Tuple[str, ...]
    holds: Tuple[str, ...]
    released: Tuple[str, ...] = ()


@dataclass(frozen=True)
class Trace:
    """One execution. `predicates` are the true atoms of user predicates; nothing is known of the
    `undetermined` atoms (docs/reference/formats.md). `ended` tells how a plan ended."""

    number: int
    timepoints: Tuple[Timepoint, ...]
    predicates: Tuple[str, ...] = ()
    undetermined: Tuple[str, ...] = ()
    ended: Optional[str] = None
    initial_states: int = 1
    orbit: Optional[int] = None
    raw: Object = field(default_factory=dict, repr=False, compare=False)

    @classmethod
    def of(cls, said: Object) -> "Trace":
        points = tuple(
            Timepoint(int(one["time"]), texts(one, "happens"), texts(one, "holds"),
                      texts(one, "released"))
            for one in objects(said, "timepoints")
        )
        return cls(
            number=int(said.get("trace", 1)),
            timepoints=points,
            predicates=texts(said, "predicates"),
            undetermined=texts(said, "undetermined"),
            ended=said.get("ended"),
            initial_states=int(said.get("initial_states", 1)),
            orbit=optional_int(said, "orbit"),
            raw=said,
        )

    @property
    def events(self) -> List[str]:
        """All events, in the order of timepoints."""
        return [event for point in self.timepoints for event in point.happens]

    def holds(self, fluent: str, time: int) -> bool:
        """Whether `RobotIn(r1)` holds at the timepoint. Raises IndexError beyond the last one."""
        if not 0 <= time < len(self.timepoints):
            raise IndexError("the trace has no timepoint %d" % time)
        return fluent.replace(" ", "") in self.timepoints[time].holds

    def frame(self) -> Any:
        """A pandas frame: a row for each timepoint, a column of truths for each fluent that holds
        at some time, and `happens`."""
        names = sorted({name for point in self.timepoints for name in point.holds})
        rows = [
            dict({name: name in point.holds for name in names}, happens=" ".join(point.happens))
            for point in self.timepoints
        ]
        return frame(rows, names + ["happens"], index=[point.time for point in self.timepoints],
                     index_name="time")

    def _repr_html_(self) -> str:
        return _html.timeline(self)


@dataclass(frozen=True)
class Summary:
    """How a list of traces ended. Where it is not `complete`, there may be more traces."""

    traces: int
    complete: bool
    exploration: str
    proof: Optional[str] = None
    raw: Object = field(default_factory=dict, repr=False, compare=False)

    @classmethod
    def of(cls, said: Object) -> "Summary":
        return cls(int(said.get("traces", 0)), said.get("complete") is True,
                   str(said.get("exploration", "stopped")), said.get("proof"), said)


@dataclass(frozen=True)
class Count:
    """A number of traces. If it is not `complete`, there are at least so many."""

    traces: int
    complete: bool
    exploration: str
    raw: Object = field(default_factory=dict, repr=False, compare=False)

    @classmethod
    def of(cls, said: Object) -> "Count":
        return cls(int(said["traces"]), said["complete"] is True, str(said["exploration"]), said)

    def __int__(self) -> int:
        return self.traces

    def __str__(self) -> str:
        return "%d%s" % (self.traces, "" if self.complete else " or more")


@dataclass(frozen=True)
class Check:
    """What is wrong, or odd, with a model or a scenario. True if there is no error."""

    diagnostics: Tuple[Diagnostic, ...] = ()

    @classmethod
    def of(cls, said: Object) -> "Check":
        return cls(diagnostics_of(said))

    @property
    def errors(self) -> Tuple[Diagnostic, ...]:
        return tuple(one for one in self.diagnostics if one.severity == "error")

    @property
    def warnings(self) -> Tuple[Diagnostic, ...]:
        return tuple(one for one in self.diagnostics if one.severity != "error")

    def __bool__(self) -> bool:
        return not self.errors

    def _repr_html_(self) -> str:
        return _html.check(self)


@dataclass(frozen=True)
class Answer:
    """The answer about a property. `verdict` is `holds` (up to the horizon), `violated` (by
    `trace`), or `inconclusive`. `proof` is `checked` where an independent checker accepted one."""

    verdict: str
    horizon: int
    trace: Optional[Trace] = None
    timepoint: Optional[int] = None
    proof: Optional[str] = None
    words: Optional[str] = None
    raw: Object = field(default_factory=dict, repr=False, compare=False)

    @classmethod
    def of(cls, said: Object) -> "Answer":
        trace = said.get("trace")
        broken = said.get("broken") or {}
        return cls(str(said["verdict"]), int(said["horizon"]),
                   None if trace is None else Trace.of(trace), optional_int(said, "timepoint"),
                   said.get("proof"), broken.get("words"), said)

    @property
    def holds(self) -> Optional[bool]:
        """None: a limit ended the search first."""
        return {"holds": True, "violated": False}.get(self.verdict)

    def _repr_html_(self) -> str:
        return _html.answer(self)
