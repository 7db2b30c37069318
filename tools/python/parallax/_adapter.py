"""Checks a simulator against the protocol."""

import os
import sys
from dataclasses import dataclass, field
from typing import Mapping, Optional, Sequence, Tuple, Union

from ._json import Object, objects
from ._process import PathLike, ask, flags


@dataclass(frozen=True)
class AdapterCheck:
    """What is wrong with a simulator, and what claims it supports. True if there is no fault."""

    simulator: str
    faults: Tuple[str, ...]
    warnings: Tuple[str, ...]
    claims: Mapping[str, str]
    raw: Object = field(default_factory=dict, repr=False, compare=False)

    @classmethod
    def of(cls, said: Object) -> "AdapterCheck":
        found = [(one.get("severity"), "%s: %s" % (one.get("check"), one.get("text")))
                 for one in objects(said, "findings")]
        simulator = said.get("simulator") or {}
        return cls(
            str(simulator.get("name", "")),
            tuple(text for kind, text in found if kind == "fault"),
            tuple(text for kind, text in found if kind == "warning"),
            {str(key): str(value) for key, value in (said.get("claims") or {}).items()},
            said,
        )

    def __bool__(self) -> bool:
        return not self.faults


def adapter_check(command: Union[PathLike, Sequence[str]], act: Sequence[str] = (),
                  scenario: Optional[PathLike] = None) -> AdapterCheck:
    """Starts a simulator, asks it what a run asks and what none should, and tells what is wrong. A
    name that ends in `.py` is run by this Python; `act` are actions: `push target.x=1.5`."""
    if isinstance(command, (str, os.PathLike)):
        name = os.fspath(command)
        command = [sys.executable, name] if name.endswith(".py") else [name]
    values = flags(act=list(act), scenario=None if scenario is None else os.fspath(scenario))
    return AdapterCheck.of(ask(["adapter-check", *values], behind=["--", *command]))
