"""Results of simulations: runs, discrepancies, rates, and a row for each simulation."""

import os
from dataclasses import dataclass, field
from typing import Any, Dict, Iterable, List, Mapping, Optional, Tuple, Union

from . import _html
from ._explanations import Explanation
from ._frames import frame
from ._json import Object, objects, optional_float, optional_int, parse_object, texts
from ._process import PathLike, ask, flags, paths_of

Value = Union[float, bool, str]


@dataclass(frozen=True)
class Sample:
    """One simulation (docs/guide/running.md). `start` has the variables of its start: places in metres,
    angles in radians. `drawn` is False for starts that a search chose."""

    trace: int
    sample: int
    seed: int
    outcome: str  # clean, admitted, discrepancy, unfinished or lost
    start: Mapping[str, Value]
    drawn: bool
    cause: Optional[str] = None
    reason: Optional[str] = None
    event: Optional[int] = None
    sim_time_s: float = 0.0
    margins: Tuple[Tuple[int, Mapping[str, float]], ...] = ()
    raw: Object = field(default_factory=dict, repr=False, compare=False)

    @classmethod
    def of(cls, said: Object) -> "Sample":
        margins = tuple((int(one["event"]), dict(one["margins"]))
                        for one in objects(said, "margins"))
        return cls(int(said["trace"]), int(said["sample"]), int(said["seed"]),
                   str(said["outcome"]), dict(said["state"]), said.get("start") == "drawn",
                   said.get("cause"), said.get("reason"), optional_int(said, "event"),
                   float(said["sim_time_s"]), margins, said)

    @property
    def id(self) -> str:
        """`TRACE.SAMPLE`, as options of the program take it."""
        return "%d.%d" % (self.trace, self.sample)


def read_samples(path: PathLike) -> Tuple[Sample, ...]:
    """The rows that `--samples FILE.jsonl` wrote; none if there is no file."""
    rows: List[Sample] = []
    try:
        with open(path, encoding="utf-8") as file:
            for line in file:
                said = parse_object(line)
                if said is not None:
                    rows.append(Sample.of(said))
    except FileNotFoundError:
        pass
    return tuple(rows)


def samples_frame(samples: Iterable[Sample]) -> Any:
    """A pandas frame with a row for each simulation, variables as `start.NAME`, margins as
    `margin.EVENT.NAME`."""
    rows: List[Dict[str, object]] = []
    columns = ["trace", "sample", "seed", "drawn", "outcome", "event", "cause", "reason",
               "sim_time_s"]
    for one in samples:
        row: Dict[str, object] = {
            "trace": one.trace, "sample": one.sample, "seed": one.seed, "drawn": one.drawn,
            "outcome": one.outcome, "event": one.event, "cause": one.cause, "reason": one.reason,
            "sim_time_s": one.sim_time_s}
        row.update({"start." + name: value for name, value in one.start.items()})
        for event, margins in one.margins:
            row.update({"margin.%d.%s" % (event, name): value for name, value in margins.items()})
        columns += [name for name in row if name not in columns]
        rows.append(row)
    return frame(rows, columns)


@dataclass(frozen=True)
class DivergingFluent:
    """A fluent that was not as the model said, with what was measured."""

    fluent: str
    timepoint: int
    predicted: bool
    observed: bool
    measured: str = ""

    @classmethod
    def of(cls, said: Object) -> "DivergingFluent":
        return cls(str(said["fluent"]), int(said["timepoint"]), said["predicted"] is True,
                   said["observed"] is True, str(said.get("measured", "")))


@dataclass(frozen=True)
class Discrepancy:
    """A simulation that the model cannot follow. `replay` is the command that repeats it."""

    trace: int
    sample: int
    seed: int
    words: str
    cause: str
    first_divergence: int
    kind: str
    fluents: Tuple[DivergingFluent, ...] = ()
    start: Mapping[str, Value] = field(default_factory=dict)
    replay: str = ""
    raw: Object = field(default_factory=dict, repr=False, compare=False)

    @classmethod
    def of(cls, said: Object) -> "Discrepancy":
        cause = said.get("cause") or {}
        return cls(int(said["trace"]), int(said["sample"]), int(said["seed"]),
                   str(said.get("words", "")), str(cause.get("text", "")),
                   int(said["first_divergence"]), str(said.get("kind", "")),
                   tuple(DivergingFluent.of(one) for one in objects(said, "fluents")),
                   dict(said.get("start") or {}), str(said.get("replay", "")), said)

    @property
    def id(self) -> str:
        return "%d.%d" % (self.trace, self.sample)


@dataclass(frozen=True)
class Claim:
    """Discrepancy probabilities of `epsilon` and more are excluded with this confidence."""

    confidence: float
    epsilon: float


@dataclass(frozen=True)
class TraceRun:
    """What came of one trace. `claim` says in words exactly what is claimed."""

    trace: int
    verdict: str
    events: Tuple[str, ...]
    simulations: int
    clean: int
    lost: int
    rejected: int
    certified: Claim
    claim: str
    caveats: Tuple[str, ...] = ()
    raw: Object = field(default_factory=dict, repr=False, compare=False)

    @classmethod
    def of(cls, said: Object) -> "TraceRun":
        certified = said["certified"]
        return cls(int(said["trace"]), str(said["verdict"]), texts(said, "events"),
                   int(said["simulations"]), int(said["clean"]), int(said["lost"]),
                   int(said["rejected"]),
                   Claim(float(certified["confidence"]), float(certified["epsilon"])),
                   str(said["claim"]), texts(said, "caveats"), said)


@dataclass(frozen=True)
class Run:
    """The result of a run. `verdict` is `discrepancy`, `no-discrepancy` or `inconclusive`; `folder`
    holds its journal and recordings."""

    scenario: str
    seed: int
    verdict: str
    iterations: int
    simulations: int
    exploration: str
    traces: Tuple[TraceRun, ...]
    discrepancies: Tuple[Discrepancy, ...]
    samples: Tuple[Sample, ...]
    folder: str
    raw: Object = field(default_factory=dict, repr=False, compare=False)
    keep: object = field(default=None, repr=False, compare=False)

    @classmethod
    def of(cls, said: Object, folder: str, samples: Tuple[Sample, ...], keep: object) -> "Run":
        return cls(str(said["scenario"]), int(said["seed"]), str(said["verdict"]),
                   int(said["iterations"]), int(said["simulations"]), str(said["exploration"]),
                   tuple(TraceRun.of(one) for one in objects(said, "traces")),
                   tuple(Discrepancy.of(one) for one in objects(said, "discrepancies")),
                   samples, folder, said, keep)

    def explain(self, sample: Optional[str] = None, runs: Optional[int] = None,
                allow_commands: bool = False) -> Explanation:
        """Why the model cannot follow a discrepancy, the first one or that of TRACE.SAMPLE, and
        what kind of cause it has. Makes at most `runs` further simulations (60)."""
        return Explanation.of(ask(["explain", *paths_of([self.folder]),
                                   *flags(sample=sample, runs=runs,
                                          allow_commands=allow_commands)]))

    def report(self, page: Optional[PathLike] = None, explain: bool = False,
               repair: bool = False) -> str:
        """Writes one self-contained HTML page and returns its path; `report.html` in the run's
        folder if no page is named."""
        return write_page([self.folder], page, explain=explain, repair=repair)

    def frame(self) -> Any:
        """A pandas frame with a row for each simulation."""
        return samples_frame(self.samples)

    def _repr_html_(self) -> str:
        return _html.run(self)


def write_page(folders: List[str], page: Optional[PathLike], **values: object) -> str:
    said = ask(["report", *paths_of(folders),
                *flags(out=None if page is None else os.fspath(page), **values)])
    return str(said["page"])


@dataclass(frozen=True)
class Rate:
    """How often something went wrong, with the bounds of its interval."""

    cause: str
    count: int
    rate: float
    lower: float
    upper: float
    example: Optional[int] = None
    raw: Object = field(default_factory=dict, repr=False, compare=False)

    @classmethod
    def of(cls, said: Object) -> "Rate":
        return cls(str(said["cause"]), int(said["count"]), float(said["rate"]),
                   float(said["lower"]), float(said["upper"]), optional_int(said, "example"), said)


@dataclass(frozen=True)
class TraceRates:
    """Rates of one trace: of any discrepancy, and of each cause."""

    trace: int
    events: str
    runs: int
    lost: int
    any: Rate
    causes: Tuple[Rate, ...]
    raw: Object = field(default_factory=dict, repr=False, compare=False)

    @classmethod
    def of(cls, said: Object) -> "TraceRates":
        return cls(int(said["trace"]), str(said["events"]), int(said["runs"]), int(said["lost"]),
                   Rate.of(said["any"]), tuple(Rate.of(one) for one in objects(said, "causes")),
                   said)


@dataclass(frozen=True)
class Rates:
    """How often each trace goes wrong, and why. Intervals have this confidence."""

    scenario: str
    seed: int
    confidence: Optional[float]
    complete: bool
    traces: Tuple[TraceRates, ...]
    samples: Tuple[Sample, ...]
    raw: Object = field(default_factory=dict, repr=False, compare=False)

    @classmethod
    def of(cls, said: Object, samples: Tuple[Sample, ...]) -> "Rates":
        return cls(str(said["scenario"]), int(said["seed"]), optional_float(said, "confidence"),
                   said.get("complete") is True,
                   tuple(TraceRates.of(one) for one in objects(said, "traces")), samples, said)

    def frame(self) -> Any:
        """A pandas frame: a row for each trace and cause; the cause `any` comes first."""
        rows: List[Dict[str, object]] = [
            {"trace": trace.trace, "cause": one.cause, "count": one.count, "runs": trace.runs,
             "rate": one.rate, "lower": one.lower, "upper": one.upper}
            for trace in self.traces for one in (trace.any, *trace.causes)
        ]
        return frame(rows, ["trace", "cause", "count", "runs", "rate", "lower", "upper"])

    def samples_frame(self) -> Any:
        """A pandas frame with a row for each simulation."""
        return samples_frame(self.samples)

    def _repr_html_(self) -> str:
        return _html.rates(self)
