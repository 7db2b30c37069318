"""Why: axioms that contradict each other or a run, and the chain behind a fact."""

from dataclasses import dataclass, field
from typing import Optional, Tuple

from . import _html
from ._json import Object, objects, optional_int, texts


@dataclass(frozen=True)
class Axiom:
    """An axiom of the model, where it stands, and its instances that play a part."""

    text: str
    file: str
    line: Optional[int] = None
    what: str = ""
    instances: Tuple[str, ...] = ()

    @classmethod
    def of(cls, said: Object) -> "Axiom":
        return cls(str(said.get("text", "")), str(said.get("file", "")), optional_int(said, "line"),
                   str(said.get("what", "")), texts(said, "instances"))


@dataclass(frozen=True)
class Conflict:
    """A minimal set of axioms that cannot hold together. `proof` is the verdict of a checker."""

    axioms: Tuple[Axiom, ...]
    words: str = ""
    proof: str = ""


@dataclass(frozen=True)
class Explanation:
    """Why a model has no trace, or cannot follow a run. Without `conflicts` it can. `cause` is
    `always`, `region`, `random` or `simulator` (docs/guide/repair.md)."""

    satisfiable: bool
    conflicts: Tuple[Conflict, ...] = ()
    cause: Optional[str] = None
    words: str = ""
    rule: Optional[str] = None
    raw: Object = field(default_factory=dict, repr=False, compare=False)

    @classmethod
    def of(cls, said: Object) -> "Explanation":
        sets = tuple(
            Conflict(tuple(Axiom.of(axiom) for axiom in objects(one, "axioms")),
                     str(one.get("words", "")), str(one.get("proof", "")))
            for one in objects(said, "sets")
        )
        rule = said.get("rule") or said.get("where") or {}
        return cls(said.get("satisfiable") is True, sets, said.get("cause"),
                   str(said.get("cause_words", "")), rule.get("text"), said)

    def _repr_html_(self) -> str:
        return _html.explanation(self)


@dataclass(frozen=True)
class Step:
    """A fact and what it rests on."""

    fact: str
    why: str  # stated, effect, inertia, axiom, completion, forced, chosen or undecided
    axiom: Optional[Axiom] = None
    premises: Tuple[str, ...] = ()


@dataclass(frozen=True)
class Why:
    """The facts behind a fact of a trace, earliest first."""

    fact: str
    trace: int
    steps: Tuple[Step, ...] = ()
    raw: Object = field(default_factory=dict, repr=False, compare=False)

    @classmethod
    def of(cls, said: Object) -> "Why":
        steps = tuple(
            Step(str(one["fact"]), str(one["why"]),
                 Axiom.of(one["axiom"]) if "axiom" in one else None, texts(one, "premises"))
            for one in objects(said, "steps")
        )
        return cls(str(said["fact"]), int(said["trace"]), steps, said)
