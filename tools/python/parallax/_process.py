"""Starts the program, and ends it in every case: whatever interrupts Python leaves no process."""

import os
import re
import shutil
import signal
import subprocess
import tempfile
import weakref
from typing import IO, Dict, List, Optional, Sequence, Tuple, Union

from . import _errors as errors
from ._json import Object, objects, parse, parse_object
from ._version import __version__

PathLike = Union[str, "os.PathLike[str]"]

_TERM_WAIT_S = 5.0  # the program ends its simulators in two
_STDERR_KEPT = 4000  # characters of its messages in an exception

_chosen: Optional[str] = None
_versions: Dict[Tuple[str, int, int], str] = {}


def use_program(path: Optional[PathLike]) -> None:
    """Takes this program from now on. None: as at first."""
    global _chosen
    _chosen = None if path is None else os.fspath(path)


def program() -> str:
    """The program that is started: the one of `use_program`, else that of the environment variable
    PARALLAX_PROGRAM, else `parallax` on the PATH. Checks that it is there and of this version."""
    named = _chosen or os.environ.get("PARALLAX_PROGRAM") or "parallax"
    found = shutil.which(named)
    if found is None:
        raise errors.ProgramNotFound(
            "there is no program `%s`: install parallax, put its folder on the PATH, or name it in "
            "PARALLAX_PROGRAM or by parallax.use_program" % named)
    _check_version(found)
    return found


def _check_version(path: str) -> None:
    status = os.stat(path)
    key = (path, status.st_mtime_ns, status.st_size)
    if key not in _versions:
        try:
            said = subprocess.run([path, "--version"], stdin=subprocess.DEVNULL, timeout=60,
                                  stdout=subprocess.PIPE, stderr=subprocess.DEVNULL).stdout
        except (OSError, subprocess.TimeoutExpired) as error:
            raise errors.ProgramNotFound("`%s` cannot be started: %s" % (path, error)) from None
        match = re.match(r"parallax (\d+\.\d+)(\.\d+)?\b", said.decode("utf-8", "replace"))
        _versions[key] = match.group(1) if match else ""
    version = _versions[key]
    if version != ".".join(__version__.split(".")[:2]):
        what = "of version %s" % version if version else "no parallax"
        raise errors.WrongVersion(
            "`%s` is %s, and this package is for %s: install both from one source"
            % (path, what, __version__))


def paths_of(names: Sequence[PathLike]) -> List[str]:
    """Names of files as arguments; none is taken for an option."""
    texts = [os.fspath(name) for name in names]
    return ["./" + text if text.startswith("-") else text for text in texts]


def flags(**values: object) -> List[str]:
    """`horizon=3` is `--horizon=3`, True a flag; None and False are left out, a list repeats."""
    out: List[str] = []
    for name, value in values.items():
        option = "--" + name.rstrip("_").replace("_", "-")
        if value is None or value is False:
            continue
        if value is True:
            out.append(option)
        elif isinstance(value, (list, tuple)):
            out += ["%s=%s" % (option, one) for one in value]
        else:
            out.append("%s=%s" % (option, value))
    return out


def end(process: "subprocess.Popen[bytes]") -> None:
    """Ends the process (TERM, then KILL), and returns when it is gone."""
    for stream in (process.stdin, process.stdout):
        if stream is not None:
            try:
                stream.close()
            except OSError:
                pass
    if process.poll() is not None:
        return
    process.terminate()
    try:
        process.wait(_TERM_WAIT_S)
    except subprocess.TimeoutExpired:
        pass
    finally:
        if process.poll() is None:
            process.kill()
            process.wait()


class TemporaryFolder:
    """A folder that goes with the object, or at the end of Python."""

    def __init__(self) -> None:
        self.path = tempfile.mkdtemp(prefix="parallax-")
        weakref.finalize(self, shutil.rmtree, self.path, ignore_errors=True)


class Running:
    """The program at work. Its standard output is a pipe; what it says goes into a file without a
    name, so that it never waits for anybody to read that."""

    def __init__(self, arguments: Sequence[str]) -> None:
        path = program()
        self.command = [path, *arguments]
        self.said: IO[bytes] = tempfile.TemporaryFile()
        try:
            self.process = subprocess.Popen(self.command, stdin=subprocess.DEVNULL,
                                            stdout=subprocess.PIPE, stderr=self.said)
        except OSError as error:
            self.said.close()
            raise errors.ProgramNotFound("`%s` cannot be started: %s" % (path, error)) from None
        except ValueError as error:  # a NUL in an argument
            self.said.close()
            raise errors.UsageError("the program cannot be given this: %s" % error) from None

    def messages(self) -> str:
        self.said.seek(0)
        return self.said.read().decode("utf-8", "replace")

    def close(self) -> None:
        end(self.process)
        self.said.close()


def ask(arguments: Sequence[str], accept_errors: bool = False,
        behind: Sequence[str] = ()) -> Object:
    """The document that `parallax ARGUMENTS --json` prints. Raises the exception for its exit code
    if that is an error, unless `accept_errors` and the input was rejected. `behind` follows all
    options: a command of another program."""
    running = Running([*arguments, "--json", "--quiet", *behind])
    try:
        out, _ = running.process.communicate()
        returncode, said = running.process.returncode, running.messages()
    finally:
        running.close()
    document = parse_object(out.decode("utf-8", "replace"))
    if document is None:
        raise failure(returncode, said, ())
    found = errors.diagnostics_of(document)
    is_error = document.get("status") == "error" and set(document) <= {"status", "diagnostics"}
    if not is_error and returncode in (0, 1, 4):
        return document
    if accept_errors and is_error and returncode == 3:
        return document
    raise failure(returncode, said, found)


def diagnostics_in(said: str) -> Tuple[errors.Diagnostic, ...]:
    """Those among the messages, which `--diagnostics=json` writes as a line."""
    for line in said.splitlines():
        if not line.startswith("["):
            continue
        try:
            value = parse(line)
        except ValueError:
            continue
        if isinstance(value, list):
            return tuple(errors.Diagnostic.of(one) for one in objects({"all": value}, "all"))
    match = re.search(r"^parallax: error\[(E\d+)\]: (.*)$", said, re.MULTILINE)
    return (errors.Diagnostic("error", match.group(1), match.group(2)),) if match else ()


def failure(returncode: int, said: str,
            found: Sequence[errors.Diagnostic]) -> errors.ParallaxError:
    """The exception for an exit code."""
    known = {1: errors.ParallaxError, 2: errors.UsageError, 3: errors.InputRejected,
             4: errors.Inconclusive, 130: errors.Interrupted, 143: errors.Interrupted,
             -signal.SIGINT: errors.Interrupted, -signal.SIGTERM: errors.Interrupted}
    found = tuple(found) or diagnostics_in(said)
    first = [one for one in found if one.severity == "error"]
    kind = known.get(returncode)
    if kind is not None and (first or kind is errors.Interrupted):
        more = "\n%d further errors in `diagnostics`" % (len(first) - 1) if len(first) > 1 else ""
        return kind(str(first[0]) + more if first else "the program was interrupted", found)
    if returncode < 0:
        try:
            name = signal.Signals(-returncode).name
        except ValueError:
            name = "signal %d" % -returncode
        what = "ended by %s" % name
    elif returncode == 5:
        what = "reported an internal error"
    else:
        what = "printed no answer (exit code %d)" % returncode
    tail = said[-_STDERR_KEPT:].strip()
    text = "the program %s%s" % (what, ": " + tail if tail else "")
    return errors.ProgramCrashed(text, found, returncode, tail)
