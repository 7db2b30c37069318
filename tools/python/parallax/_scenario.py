"""A scenario: a model, a plan, and a world where it is simulated."""

import os
from typing import Optional, Sequence, Union

from ._model import Model
from ._process import PathLike, TemporaryFolder, ask, flags, paths_of
from ._runs import Rates, Run, read_samples, write_page


class Scenario(Model):
    """A scenario file (`.yaml`). What can be asked about its model is that of `Model`; `run` and
    `rates` simulate. `jobs` of them are the simulations at the same time, `allow_commands` lets the
    scenario start the command that it names as its simulator where that is forbidden."""

    def __init__(self, file: PathLike, options: Sequence[str] = ()) -> None:
        super().__init__(file, options=options)
        self.file = os.fspath(file)

    def __repr__(self) -> str:
        return "Scenario(%r)" % self.file

    def run(self, seed: Optional[int] = None, jobs: Optional[int] = None,
            keep_going: bool = False, max_runs: Optional[int] = None,
            search: Optional[int] = None, execution: Optional[str] = None,
            criterion: Optional[str] = None, confidence: Optional[float] = None,
            epsilon: Optional[float] = None, out: Optional[PathLike] = None,
            record: Optional[str] = None, time_limit: Optional[float] = None,
            allow_commands: bool = False, options: Sequence[str] = ()) -> Run:
        """The whole loop: trace, sample, simulate, compare, confidence, next trace. `out` is a new
        folder that stays; without it the run folder goes with the result."""
        keep = TemporaryFolder()
        folder = os.path.join(keep.path, "run") if out is None else os.fspath(out)
        samples = os.path.join(keep.path, "samples.jsonl")
        said = ask(["run", *paths_of([self.file]), *self._options, *options, *flags(
            out=folder, samples=samples, seed=seed, jobs=jobs, keep_going=keep_going,
            max_runs=max_runs, search=search, execution=execution, criterion=criterion,
            confidence=confidence, epsilon=epsilon, record=record, time_limit=time_limit,
            allow_commands=allow_commands)])
        return Run.of(said, folder, read_samples(samples), keep if out is None else None)

    def rates(self, runs: Optional[int] = None, trace: Optional[int] = None,
              seed: Optional[int] = None, jobs: Optional[int] = None,
              until_width: Optional[float] = None, confidence: Optional[float] = None,
              time_limit: Optional[float] = None, allow_commands: bool = False,
              options: Sequence[str] = ()) -> Rates:
        """How often each trace goes wrong, and why: uniform runs, counted by cause."""
        folder = TemporaryFolder()
        samples = os.path.join(folder.path, "samples.jsonl")
        said = ask(["rates", *paths_of([self.file]), *self._options, *options, *flags(
            samples=samples, runs=runs, trace=trace, seed=seed, jobs=jobs,
            until_width=until_width, confidence=confidence, time_limit=time_limit,
            allow_commands=allow_commands)])
        return Rates.of(said, read_samples(samples))


def run(scenario: PathLike, **how: object) -> Run:
    """`Scenario(scenario).run(...)`"""
    return Scenario(scenario).run(**how)  # type: ignore[arg-type]


def rates(scenario: PathLike, **how: object) -> Rates:
    """`Scenario(scenario).rates(...)`"""
    return Scenario(scenario).rates(**how)  # type: ignore[arg-type]


def report(*runs: Union[Run, PathLike], page: Optional[PathLike] = None) -> str:
    """Writes a page about a run, or about how several runs differ, and returns its path."""
    folders = [one.folder if isinstance(one, Run) else os.fspath(one) for one in runs]
    return write_page(folders, page)
