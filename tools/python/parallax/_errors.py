"""Exceptions, each with the diagnostics that the program gave, and those with their places."""

from dataclasses import dataclass
from typing import Optional, Sequence, Tuple

from ._json import Object, objects, optional_int


@dataclass(frozen=True)
class Note:
    """A further place that a diagnostic points at, or a remark without one."""

    message: str
    path: Optional[str] = None
    line: Optional[int] = None
    column: Optional[int] = None


@dataclass(frozen=True)
class Diagnostic:
    """One error or warning. Lines and columns count from 1, columns in characters; `end_column` is
    behind the last one. A diagnostic about no place has no line, one about no file no path."""

    severity: str  # "error" or "warning"
    code: str  # "E2104"; docs/reference/diagnostics.md lists them
    message: str
    path: Optional[str] = None
    line: Optional[int] = None
    column: Optional[int] = None
    end_line: Optional[int] = None
    end_column: Optional[int] = None
    notes: Tuple[Note, ...] = ()
    fix: Optional[str] = None
    help: Optional[str] = None

    @classmethod
    def of(cls, said: Object) -> "Diagnostic":
        notes = tuple(
            Note(str(note.get("message", "")), note.get("path"), optional_int(note, "line"),
                 optional_int(note, "column"))
            for note in objects(said, "notes")
        )
        return cls(
            severity=str(said.get("severity", "error")),
            code=str(said.get("code", "")),
            message=str(said.get("message", "")),
            path=said.get("path"),
            line=optional_int(said, "line"),
            column=optional_int(said, "column"),
            end_line=optional_int(said, "end_line"),
            end_column=optional_int(said, "end_column"),
            notes=notes,
            fix=said.get("fix"),
            help=said.get("help"),
        )

    @property
    def location(self) -> str:
        """`domain.e:14:9`, the path alone, or `parallax` where there is no place."""
        if self.path is None:
            return "parallax"
        if self.line is None:
            return self.path
        return "%s:%d:%d" % (self.path, self.line, self.column or 1)

    def __str__(self) -> str:
        text = "%s: %s[%s]: %s" % (self.location, self.severity, self.code, self.message)
        if self.fix:
            text += "\nfix: " + self.fix
        return text


def diagnostics_of(document: Object) -> Tuple[Diagnostic, ...]:
    """The diagnostics that came with a document."""
    return tuple(Diagnostic.of(one) for one in objects(document, "diagnostics"))


class ParallaxError(Exception):
    """The program gave no answer. `first` is the first error, with its place."""

    def __init__(self, message: str, diagnostics: Sequence[Diagnostic] = ()) -> None:
        super().__init__(message)
        self.diagnostics = tuple(diagnostics)

    @property
    def first(self) -> Optional[Diagnostic]:
        errors = [one for one in self.diagnostics if one.severity == "error"]
        return errors[0] if errors else None

    @property
    def path(self) -> Optional[str]:
        return self.first.path if self.first else None

    @property
    def line(self) -> Optional[int]:
        return self.first.line if self.first else None

    @property
    def column(self) -> Optional[int]:
        return self.first.column if self.first else None

    @property
    def code(self) -> Optional[str]:
        return self.first.code if self.first else None

    @property
    def fix(self) -> Optional[str]:
        return self.first.fix if self.first else None


class ProgramNotFound(ParallaxError):
    """There is no program `parallax`, or it cannot be started."""


class WrongVersion(ParallaxError):
    """The program is of another version than the package."""


class ProgramCrashed(ParallaxError):
    """The program ended by a signal or an internal error, or printed what is no answer. `stderr` is
    the end of what it said."""

    def __init__(self, message: str, diagnostics: Sequence[Diagnostic] = (), returncode: int = 0,
                 stderr: str = "") -> None:
        super().__init__(message, diagnostics)
        self.returncode = returncode
        self.stderr = stderr


class UsageError(ParallaxError):
    """An unknown option, options that do not go together, or a missing file (exit code 2)."""


class InputRejected(ParallaxError):
    """A model, plan or scenario has an error, which `first` locates (exit code 3)."""


class Inconclusive(ParallaxError):
    """A limit ended the work before there was anything to tell (exit code 4)."""


class Interrupted(ParallaxError):
    """Somebody ended the program by SIGINT or SIGTERM (exit codes 130, 143)."""
