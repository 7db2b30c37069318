"""The program as a process: it is found, ended in every case, and its failures are told apart."""

import gc
import os
import signal
import subprocess
import sys
import threading
import time
import unittest

from common import InFolder, children, is_gone

import parallax as px
from parallax import _process

TRACE = '{"trace":1,"timepoints":[{"time":0,"happens":[],"holds":["F()"],"released":[]}],"predicates":[]}'
SUMMARY = '{"summary":true,"traces":1,"complete":true,"exploration":"complete"}'


class Programs(InFolder):
    def setUp(self) -> None:
        super().setUp()
        self.addCleanup(px.use_program, None)

    def use(self, body: str, version: str = "parallax 0.2.0 (test)") -> px.Model:
        px.use_program(self.program(body, version))
        return px.Model("domain.e")

    # Streams.

    def test_a_trace_arrives_while_the_program_still_works(self) -> None:
        stream = self.use("echo '%s'; exec sleep 600" % TRACE).traces()
        self.assertEqual(children(), [], "nothing runs before the first trace is wanted")
        self.assertTrue(next(stream).holds("F()", 0))
        self.assertEqual(len(children()), 1)
        stream.close()
        self.assertEqual(children(), [])
        with self.assertRaises(StopIteration):
            next(stream)

    def test_a_forgotten_stream_leaves_no_process(self) -> None:
        stream = self.use("echo '%s'; exec sleep 600" % TRACE).traces()
        next(stream)
        self.assertEqual(len(children()), 1)
        del stream
        gc.collect()
        self.assertEqual(children(), [])

    def test_the_end_of_a_with_leaves_no_process(self) -> None:
        with self.use("echo '%s'; exec sleep 600" % TRACE).traces() as stream:
            for trace in stream:
                self.assertEqual(trace.number, 1)
                break
        self.assertEqual(children(), [])

    def test_an_interrupt_leaves_no_process(self) -> None:
        for ask in (lambda model: next(model.traces()), lambda model: model.count()):
            model = self.use("echo $$ > pid; exec sleep 600")
            threading.Thread(target=self.interrupt_later, daemon=True).start()
            with self.assertRaises(KeyboardInterrupt):
                ask(model)
            self.assertEqual(children(), [])
            os.remove("pid")

    def interrupt_later(self) -> None:
        while not os.path.exists("pid") or not os.path.getsize("pid"):
            time.sleep(0.01)
        time.sleep(0.05)  # so that it is waited for
        os.kill(os.getpid(), signal.SIGINT)

    def test_the_end_of_python_leaves_no_process(self) -> None:
        path = self.program("echo $$ > pid; echo '%s'; exec sleep 600" % TRACE)
        script = ("import parallax as px\npx.use_program(%r)\nstream = px.Model('domain.e').traces()\n"
                  "next(stream)\nkeep = [stream]\n" % path)
        subprocess.run([sys.executable, "-c", script], check=True)
        with open("pid") as file:
            self.assertTrue(is_gone(int(file.read())))

    def test_a_program_that_does_not_hear_is_killed(self) -> None:
        usual, _process._TERM_WAIT_S = _process._TERM_WAIT_S, 0.2
        self.addCleanup(setattr, _process, "_TERM_WAIT_S", usual)
        stream = self.use("trap '' TERM; echo '%s'; while :; do sleep 0.05; done" % TRACE).traces()
        next(stream)
        stream.close()
        self.assertEqual(children(), [])

    def test_a_list_that_was_cut_off_is_no_list(self) -> None:
        stream = self.use("echo '%s'" % TRACE).traces()
        next(stream)
        with self.assertRaises(px.ProgramCrashed) as caught:
            next(stream)
        self.assertIn("no answer", str(caught.exception))
        self.assertIsNone(stream.summary)

    def test_a_line_that_is_no_trace_ends_the_stream(self) -> None:
        for line in ("noise", "[1]", '{"a": 1}', "[" * 100000):
            stream = self.use("printf '%%s\\n' '%s'; while :; do echo more; done" % line).traces()
            with self.assertRaises(px.ProgramCrashed):
                next(stream)
            self.assertEqual(children(), [])

    def test_the_summary_and_warnings_come_at_the_end(self) -> None:
        warning = '[{"path":"a.e","line":3,"column":2,"severity":"warning","code":"W2101","message":"odd"}]'
        stream = self.use("echo '%s' >&2; echo '%s'; echo '%s'" % (warning, TRACE, SUMMARY)).traces()
        self.assertEqual([trace.number for trace in stream], [1])
        assert stream.summary is not None
        self.assertTrue(stream.summary.complete)
        self.assertEqual(stream.diagnostics[0].location, "a.e:3:2")

    def test_a_program_that_says_much_is_not_waited_for(self) -> None:
        stream = self.use("head -c 3000000 /dev/zero | tr '\\0' x >&2; echo '%s'; echo '%s'"
                          % (TRACE, SUMMARY)).traces()
        self.assertEqual(len(list(stream)), 1)

    # Failures, one exception each.

    def test_no_program(self) -> None:
        px.use_program("no-such-program")
        with self.assertRaises(px.ProgramNotFound) as caught:
            px.Model("domain.e").count()
        self.assertIn("PARALLAX_PROGRAM", str(caught.exception))

    def test_a_program_that_cannot_be_started(self) -> None:
        path = self.folder / "fake-parallax"
        path.write_bytes(b"\x7fELF nothing")
        path.chmod(0o755)
        px.use_program(path)
        with self.assertRaises(px.ProgramNotFound):
            px.Model("domain.e").count()

    def test_another_version_and_another_program(self) -> None:
        with self.assertRaises(px.WrongVersion) as caught:
            self.use("exit 0", "parallax 0.1.0").count()
        self.assertIn("version 0.1", str(caught.exception))
        with self.assertRaises(px.WrongVersion) as caught:
            self.use("exit 0", "other 9").count()
        self.assertIn("no parallax", str(caught.exception))

    def test_a_crash(self) -> None:
        with self.assertRaises(px.ProgramCrashed) as caught:
            self.use("echo gone >&2; kill -SEGV $$").count()
        self.assertEqual(caught.exception.returncode, -signal.SIGSEGV)
        self.assertIn("SIGSEGV", str(caught.exception))
        self.assertIn("gone", caught.exception.stderr)
        with self.assertRaises(px.ProgramCrashed):
            self.use('echo \'{"status":"ok","traces":1}\'; exit 5').count()
        with self.assertRaises(px.ProgramCrashed):
            self.use("echo nonsense").count()

    def test_an_interrupted_program(self) -> None:
        with self.assertRaises(px.Interrupted):
            self.use('echo \'{"status":"error","diagnostics":[]}\'; exit 143').count()
        with self.assertRaises(px.Interrupted):
            self.use("kill -TERM $$").count()

    def test_a_limit(self) -> None:
        said = '{"status":"error","diagnostics":[{"severity":"error","code":"E3005","message":"over"}]}'
        with self.assertRaises(px.Inconclusive) as caught:
            self.use("echo '%s'; exit 4" % said).count()
        self.assertEqual(caught.exception.code, "E3005")
        self.assertIsNone(caught.exception.line)

    def test_numbers_of_any_length(self) -> None:
        for digits in ("7" * 12345, "-" + "1" + "0" * 5000, "3"):
            said = '{"status":"ok","traces":%s,"complete":true,"exploration":"complete"}' % digits
            count = self.use("echo '%s'" % said).count().traces
            value = 0
            for at in digits.lstrip("-"):
                value = value * 10 + int(at)
            self.assertEqual(count, -value if digits[0] == "-" else value)

    def test_names_that_look_like_options_or_hold_nul(self) -> None:
        self.use('printf \'{"status":"ok","traces":0,"complete":true,"exploration":"%s"}\' "$2"')
        self.assertEqual(px.Model("--limit").count().exploration, "./--limit")
        with self.assertRaises(px.UsageError):
            px.Model("a\0b").count()
        with self.assertRaises(px.UsageError):
            px.Model()


if __name__ == "__main__":
    unittest.main()
