"""A model, alone or with a plan, and what can be asked about it."""

import os
from typing import Dict, List, Optional, Sequence, Union

from ._errors import UsageError
from ._explanations import Explanation, Why
from ._process import PathLike, TemporaryFolder, ask, flags, paths_of
from ._stream import TraceStream
from ._traces import Answer, Check, Count

Texts = Union[str, Sequence[str]]


def listed(value: Union[None, PathLike, Sequence[PathLike]]) -> List[str]:
    """One name or several, as texts."""
    if value is None:
        return []
    if isinstance(value, (str, os.PathLike)):
        return [os.fspath(value)]
    return [os.fspath(one) for one in value]


class Model:
    """Model files (`.e`), several of which are one model, a compiled model (`.dec.cnf`), or a
    scenario (`.yaml`) with its plan and constraints. Names are relative to the current folder.

    `horizon` is the last timepoint; `until` are formulas at whose first hit traces end; `plan` and
    `bind` add a plan; `include` are folders where `load` looks; `options` are further options of the
    command line, for all questions."""

    def __init__(self, *files: PathLike, horizon: Optional[int] = None, until: Texts = (),
                 plan: Union[None, PathLike, Sequence[PathLike]] = None,
                 bind: Optional[PathLike] = None, regions: Optional[PathLike] = None,
                 include: Union[None, PathLike, Sequence[PathLike]] = None,
                 compat: Optional[str] = None, options: Sequence[str] = ()) -> None:
        if not files:
            raise UsageError("a model is at least one file; Model.from_text takes a text")
        self.files = tuple(os.fspath(name) for name in files)
        self._common = [*paths_of(files)]
        self._common += flags(include=listed(include), horizon=horizon, until=listed(until),
                              compat=compat)
        self._plan = flags(plan=listed(plan), bind=None if bind is None else os.fspath(bind),
                           regions=None if regions is None else os.fspath(regions))
        self._options = list(options)
        self._folder: Optional[TemporaryFolder] = None

    @classmethod
    def from_text(cls, text: str, name: str = "model.e", horizon: Optional[int] = None,
                  until: Texts = (), include: Union[None, PathLike, Sequence[PathLike]] = None,
                  options: Sequence[str] = ()) -> "Model":
        """A model of a notebook's cell. Its file lives as long as the object; `load` looks in
        `include` and in the current folder."""
        if os.path.basename(name) != name or not name.endswith(".e"):
            raise UsageError("`%s` is no name of a model file, which ends in .e" % name)
        folder = TemporaryFolder()
        path = os.path.join(folder.path, name)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        model = cls(path, horizon=horizon, until=until, include=include, options=options)
        model._folder = folder
        return model

    def __repr__(self) -> str:
        return "Model(%s)" % ", ".join(repr(name) for name in self.files)

    def _arguments(self, command: str, **values: object) -> List[str]:
        return [command, *self._common, *self._plan, *self._options, *flags(**values)]

    def check(self) -> Check:
        """All errors and warnings. Raises only where the program could not look."""
        return Check.of(ask(self._arguments("check"), accept_errors=True))

    def traces(self, limit: Optional[int] = None, start: int = 1,
               minimize: Texts = (), symmetry: bool = False, strategy: Optional[str] = None,
               time_limit: Optional[float] = None) -> TraceStream:
        """The traces, one by one as they are found; all of them without `limit`. `start` is the
        number of the first one, `minimize` are objectives, `symmetry` lists one of each orbit,
        `time_limit` is in seconds."""
        values: Dict[str, object] = {
            "limit": 0 if limit is None else limit, "minimize": listed(minimize),
            "up_to_symmetry": symmetry, "strategy": strategy, "time_limit": time_limit}
        if start != 1:
            values["from_"] = start
        return TraceStream(self._arguments("traces", **values), keep=self)

    def count(self, symmetry: bool = False, time_limit: Optional[float] = None) -> Count:
        """How many traces there are, exactly, however many."""
        return Count.of(ask(self._arguments("traces", count=True, up_to_symmetry=symmetry,
                                            time_limit=time_limit)))

    def verify(self, property: str, certify: Optional[PathLike] = None, jobs: Optional[int] = None,
               time_limit: Optional[float] = None) -> Answer:
        """Does the formula hold in all traces, at all times? `certify` is the file for a proof."""
        return Answer.of(ask(self._arguments(
            "verify", property=property, certify=None if certify is None else os.fspath(certify),
            jobs=jobs, time_limit=time_limit)))

    def explain(self, all: bool = False, limit: Optional[int] = None) -> Explanation:
        """Why there is no trace: the axioms that exclude each other, a smallest set of them or all
        minimal ones."""
        return Explanation.of(ask(["explain", *self._common, *self._options,
                                   *flags(all=all, limit=limit)]))

    def why(self, fact: str, trace: int = 1) -> Why:
        """What is behind a fact of a trace: `HoldsAt(F(a),3)`, `Happens(E(),2)`, `!HoldsAt(..)`."""
        return Why.of(ask(["explain", *self._common, *self._options,
                           *flags(why=fact, trace=trace)]))
