"""What the tests of the package share: a copy of a scenario, programs that misbehave, processes."""

import os
import shutil
import tempfile
import time
import unittest
from pathlib import Path
from typing import List

SOURCE = Path(os.environ["PARALLAX_SOURCE"]).resolve()


def children() -> List[int]:
    """Processes that this one has started and that still run."""
    found = []
    for entry in Path("/proc").iterdir():
        if not entry.name.isdigit():
            continue
        try:
            fields = (entry / "stat").read_text().rsplit(")", 1)[1].split()
        except (OSError, IndexError):
            continue
        if int(fields[1]) == os.getpid() and fields[0] != "Z":
            found.append(int(entry.name))
    return found


def is_gone(pid: int, wait_s: float = 20.0) -> bool:
    """Whether the process ends in that time; generous, since a machine may be busy."""
    end = time.monotonic() + wait_s
    while time.monotonic() < end:
        try:
            state = Path("/proc/%d/stat" % pid).read_text().rsplit(")", 1)[1].split()[0]
        except (OSError, IndexError):
            return True
        if state == "Z":
            return True
        time.sleep(0.02)
    return False


class InFolder(unittest.TestCase):
    """Runs each test in a fresh folder with the files of scenarios/two_regions."""

    def setUp(self) -> None:
        self._before = os.getcwd()
        self._folder = tempfile.TemporaryDirectory()
        self.folder = Path(self._folder.name)
        shutil.copytree(SOURCE / "scenarios" / "two_regions", self.folder, dirs_exist_ok=True)
        os.chdir(self.folder)

    def tearDown(self) -> None:
        self.assertEqual(children(), [], "a process was left behind")
        os.chdir(self._before)
        self._folder.cleanup()

    def program(self, body: str, version: str = "parallax 0.2.0 (test)") -> str:
        """A program that answers --version and otherwise does what `body` says in sh."""
        path = self.folder / "fake-parallax"
        path.write_text('#!/bin/sh\nif [ "$1" = --version ]; then echo "%s"; exit 0; fi\n%s\n'
                        % (version, body))
        path.chmod(0o755)
        return str(path)


LAMP = """sort lamp
lamp A,B
fluent On(lamp)
event Press(lamp)
[lamp,time] Initiates(Press(lamp),On(lamp),time).
[lamp] !HoldsAt(On(lamp),0).
[lamp] !ReleasedAt(On(lamp),0).
range time 0 2
"""
