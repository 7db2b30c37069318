"""Traces as the program finds them."""

import weakref
from types import TracebackType
from typing import Callable, Iterator, Optional, Sequence, Tuple, Type

from ._errors import Diagnostic, ProgramCrashed
from ._json import parse_object
from ._process import Running, diagnostics_in, end, failure
from ._traces import Summary, Trace


class TraceStream(Iterator[Trace]):
    """An iterator over traces, each of which is there as soon as the program has written it. The
    program starts with the first `next` and waits while nobody reads on. It is ended by `close`, by
    the end of a `with`, when the stream is forgotten, and when Python ends. After the last trace
    `summary` says whether these were all."""

    def __init__(self, arguments: Sequence[str], keep: object = None) -> None:
        self._arguments = [*arguments, "--format=jsonl", "--quiet", "--diagnostics=json"]
        self._keep = keep  # what has to live as long, such as files of a text
        self._running: Optional[Running] = None
        self._finalizer: Optional[Callable[[], object]] = None
        self._is_over = False
        self.summary: Optional[Summary] = None
        self.diagnostics: Tuple[Diagnostic, ...] = ()

    def __iter__(self) -> "TraceStream":
        return self

    def __next__(self) -> Trace:
        if self._is_over:
            raise StopIteration
        try:
            return self._next()
        except BaseException:
            self.close()
            raise

    def _next(self) -> Trace:
        if self._running is None:
            self._running = Running(self._arguments)
            # Also at the end of Python, which forgets objects without a word.
            self._finalizer = weakref.finalize(self, self._running.close)
        stdout = self._running.process.stdout
        assert stdout is not None
        line = stdout.readline()
        if line:
            said = parse_object(line.decode("utf-8", "replace"))
            if said is not None and "timepoints" in said:
                return Trace.of(said)
            if said is None or said.get("summary") is not True:
                end(self._running.process)  # which might go on for ever
                raise ProgramCrashed("the program wrote what is no trace: %r" % line[:200])
            self.summary = Summary.of(said)
        self._finish(self._running)
        raise StopIteration

    def _finish(self, running: Running) -> None:
        """The list is over: was it the end, or did something go wrong?"""
        returncode, said = running.process.wait(), running.messages()
        self.diagnostics = diagnostics_in(said)
        if self.summary is None or returncode not in (0, 1, 4):
            raise failure(returncode, said, self.diagnostics)

    def close(self) -> None:
        """Ends the program. A closed stream has no further traces."""
        self._is_over = True
        if self._finalizer is not None:
            self._finalizer()

    def __enter__(self) -> "TraceStream":
        return self

    def __exit__(self, kind: Optional[Type[BaseException]], error: Optional[BaseException],
                 traceback: Optional[TracebackType]) -> None:
        self.close()
