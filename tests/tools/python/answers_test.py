"""Answers of the real program, as dataclasses, frames and pictures."""

import os
import subprocess
import unittest
import xml.etree.ElementTree as ElementTree
from html.parser import HTMLParser
from typing import List

from common import LAMP, SOURCE, InFolder, children

import parallax as px

VOID = {"br", "meta", "img", "hr"}


class Nesting(HTMLParser):
    """Every element is closed in its order."""

    def __init__(self) -> None:
        super().__init__()
        self.open: List[str] = []
        self.faults: List[str] = []

    def handle_starttag(self, tag: str, attrs: object) -> None:
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag: str, attrs: object) -> None:
        pass

    def handle_endtag(self, tag: str) -> None:
        if not self.open or self.open.pop() != tag:
            self.faults.append(tag)


class Answers(InFolder):
    def html(self, value: object) -> str:
        text: str = value._repr_html_()  # type: ignore[attr-defined]
        nesting = Nesting()
        nesting.feed(text)
        self.assertEqual((nesting.open, nesting.faults), ([], []))
        at = text.find("<svg")
        while at >= 0:
            end = text.index("</svg>", at) + len("</svg>")
            ElementTree.fromstring(text[at:end])
            at = text.find("<svg", end)
        return text

    def test_the_program_and_the_package_are_of_one_version(self) -> None:
        said = subprocess.run([px.program(), "--version"], capture_output=True, text=True).stdout
        self.assertEqual(said.split()[1], px.__version__)

    def test_traces_counts_and_frames(self) -> None:
        model = px.Model("domain.e", "start.e", horizon=2)
        count = model.count()
        self.assertTrue(count.complete)
        stream = model.traces()
        traces = list(stream)
        self.assertEqual(len(traces), int(count))
        assert stream.summary is not None
        self.assertEqual(stream.summary.traces, int(count))
        self.assertEqual([one.number for one in traces], list(range(1, len(traces) + 1)))
        self.assertEqual([one.events for one in model.traces(limit=2, start=5)],
                         [one.events for one in traces[4:6]])
        trace = next(px.Scenario("edge.yaml").traces())
        self.assertEqual(trace.events, ["Go(r2)", "PickUp()", "Go(r1)", "Place(r1)"])
        self.assertTrue(trace.holds("BoxIn(r1)", 4))
        self.assertFalse(trace.holds("BoxIn(r1)", 0))
        with self.assertRaises(IndexError):
            trace.holds("BoxIn(r1)", 5)
        self.assertEqual(trace.ended, "done")
        text = self.html(trace)
        for word in ("BoxIn(r1)", "Place(r1)", "<svg", "plan ended: done"):
            self.assertIn(word, text)

    def test_frames(self) -> None:
        trace = next(px.Scenario("edge.yaml").traces())
        try:
            import pandas
        except ImportError:
            print("SKIPPED in part: there is no pandas")
            with self.assertRaises(ImportError) as caught:
                trace.frame()
            self.assertIn("python3-pandas", str(caught.exception))
            return
        frame = trace.frame()
        self.assertIsInstance(frame, pandas.DataFrame)
        self.assertEqual(list(frame["BoxIn(r1)"]), [False] * 4 + [True])
        self.assertEqual(frame["happens"][0], "Go(r2)")

    def test_a_text_is_a_model(self) -> None:
        model = px.Model.from_text(LAMP, horizon=1)
        self.assertEqual(int(model.count()), 4)
        folder = os.path.dirname(model.files[0])
        stream = model.traces()
        next(stream)
        del model
        self.assertTrue(os.path.isdir(folder), "the stream keeps the file")
        stream.close()
        del stream
        self.assertFalse(os.path.isdir(folder))
        with self.assertRaises(px.UsageError):
            px.Model.from_text(LAMP, name="../lamp.e")

    def test_errors_have_a_place(self) -> None:
        (self.folder / "wrong.e").write_text(LAMP.replace("HoldsAt(On", "HoldsAt(Onn"))
        model = px.Model("wrong.e")
        for ask in (lambda: model.count(), lambda: list(model.traces()),
                    lambda: model.verify("HoldsAt(On(A),time)"), lambda: model.explain()):
            with self.assertRaises(px.InputRejected) as caught:
                ask()
            error = caught.exception
            self.assertEqual((error.path, error.line), ("wrong.e", 6))
            assert error.column is not None
            line = (self.folder / "wrong.e").read_text().splitlines()[5]
            self.assertEqual(line[error.column - 1:error.column + 2], "Onn")
            self.assertTrue(str(error).startswith("wrong.e:6:"))
            assert error.fix is not None and error.first is not None
            self.assertIn("`On`", error.fix)
            self.assertTrue(error.first.message)
        check = model.check()
        self.assertFalse(check)
        self.assertEqual([one.line for one in check.errors], [6])
        self.assertIn("wrong.e:6", self.html(check))
        self.assertTrue(px.Scenario("edge.yaml").check())
        self.assertEqual(children(), [])
        with self.assertRaises(px.UsageError):
            px.Model("missing.e").check()
        with self.assertRaises(px.UsageError):
            list(px.Model("domain.e", options=["--no-such"]).traces())

    def test_properties(self) -> None:
        scenario = px.Scenario("edge.yaml")
        holds = scenario.verify("{region} HoldsAt(RobotIn(region),time)")
        self.assertIs(holds.holds, True)
        self.assertEqual(holds.proof, "checked")
        self.assertIn("holds up to horizon", self.html(holds))
        violated = scenario.verify("always HoldsAt(RobotIn(r1),time)")
        self.assertIs(violated.holds, False)
        assert violated.trace is not None and violated.timepoint is not None
        self.assertFalse(violated.trace.holds("RobotIn(r1)", violated.timepoint))
        self.assertIn("RobotIn(r2)", self.html(violated))

    def test_explanations(self) -> None:
        none = px.Model.from_text(LAMP + "HoldsAt(On(A),0).\n")
        found = none.explain()
        self.assertFalse(found.satisfiable)
        self.assertIn(9, [axiom.line for axiom in found.conflicts[0].axioms])
        self.assertIn("HoldsAt(On(A),0)", self.html(found))
        self.assertTrue(px.Model.from_text(LAMP).explain().satisfiable)
        why = px.Model.from_text(LAMP).why("!HoldsAt(On(A),1)", trace=1)
        self.assertTrue(why.steps)

    def test_runs(self) -> None:
        scenario = px.Scenario("edge.yaml")
        run = scenario.run()
        self.assertEqual((run.verdict, run.iterations, run.seed), ("discrepancy", 1, 1))
        self.assertEqual(len(run.samples), run.simulations)
        found = run.discrepancies[0]
        self.assertEqual(found.id, run.samples[0].id)
        self.assertEqual(found.start, run.samples[0].start)
        self.assertEqual({one.fluent for one in found.fluents}, {"BoxIn(r1)", "BoxIn(r2)"})
        self.assertTrue(found.replay.startswith("parallax replay "))
        text = self.html(run)
        for word in ("discrepancy", "BoxIn(r1)", "predicted", "1 simulation of 1 trace"):
            self.assertIn(word, text)
        why = run.explain(runs=0)
        self.assertIn("Place(region)", why.conflicts[0].axioms[0].text)
        self.html(why)
        page = run.report(self.folder / "page.html")
        self.assertGreater(os.path.getsize(page), 10000)
        folder = run.folder
        del run, why
        self.assertFalse(os.path.isdir(folder), "a run folder without a name goes with its run")
        kept = px.run("edge.yaml", out="kept", seed=2)
        self.assertTrue(os.path.isfile("kept/report.json"))
        other = px.run("edge.yaml", out="other", seed=2)
        self.assertEqual([one.raw for one in kept.samples], [one.raw for one in other.samples])
        self.assertTrue(os.path.isfile(px.report(kept, "other", page="both.html")))

    def test_rates(self) -> None:
        rates = px.rates("edge.yaml", runs=8)
        one = rates.traces[0]
        self.assertEqual(one.runs, 8)
        self.assertEqual(len(rates.samples), 8)
        self.assertEqual(one.any.count, sum(row.outcome == "discrepancy" for row in rates.samples))
        self.assertLess(one.any.lower, one.any.rate)
        self.assertLess(one.any.rate, one.any.upper)
        text = self.html(rates)
        for word in ("of 8", "box.x [m]", "<svg"):
            self.assertIn(word, text)

    def test_names_are_never_markup(self) -> None:
        evil = "<script>alert('x')</script>&\"(\u202e)"
        trace = px.Trace.of({"trace": 1, "ended": evil, "predicates": [evil], "timepoints": [
            {"time": 0, "happens": [evil], "holds": [evil], "released": []}]})
        self.assertNotIn("<script", self.html(trace))
        check = px.Check.of({"diagnostics": [{"path": evil, "line": 1, "message": evil, "fix": evil}]})
        self.assertNotIn("<script", self.html(check))
        sample = px.Sample(1, 1, 1, evil, {evil: 1.0}, True, cause=evil)
        other = px.Sample(1, 2, 1, "clean", {evil: 2.0}, True)
        rates = px.Rates(evil, 1, None, False, (), (sample, other))
        self.assertNotIn("<script", self.html(rates))

    def test_large_traces_are_drawn_in_part(self) -> None:
        points = [{"time": at, "happens": ["Go(%d)" % at],
                   "holds": ["F(%d)" % one for one in range(200)]} for at in range(1000)]
        text = self.html(px.Trace.of({"trace": 7, "timepoints": points}))
        self.assertIn("140 further fluents, timepoints from 120 on", text)
        self.assertLess(len(text), 2_000_000)

    def test_the_start_variable_that_decides_is_drawn_first(self) -> None:
        rows = tuple(
            px.Sample(1, at, at, "discrepancy" if at > 15 else "clean",
                      {"a.x": float(at * 7 % 20), "b.x": float(at), "c.x": 1.0}, True)
            for at in range(1, 21))
        text = self.html(px.Rates("s", 1, 0.95, True, (), rows))
        self.assertLess(text.index("b.x [m]"), text.index("a.x [m]"))
        self.assertNotIn("c.x", text)
        for outcome in ("15 clean", "5 discrepancy"):
            self.assertIn(outcome, text)


class Simulators(InFolder):
    def test_a_class_is_a_simulator(self) -> None:
        script = str(SOURCE / "tools/python/examples/kinematic_2d.py")
        check = px.adapter_check(script)
        self.assertEqual(check.faults, ())
        self.assertTrue(check)
        self.assertEqual(check.simulator, "kinematic-2d")
        self.assertEqual(check.claims["replay"], "bitwise")

    def test_the_class_of_the_guide_is_a_simulator(self) -> None:
        guide = (SOURCE / "docs/guide/python.md").read_text()
        (self.folder / "pushed_box.py").write_text(guide.split("```python\n")[1].split("```")[0])
        check = px.adapter_check("pushed_box.py")
        self.assertEqual(check.faults, ())
        self.assertEqual(check.claims["replay"], "bitwise")

    def test_a_class_answers_as_the_functions_do(self) -> None:
        examples = SOURCE / "tools/adapters/python/examples"
        samples = []
        for script in (examples / "kinematic_2d.py", SOURCE / "tools/python/examples/kinematic_2d.py"):
            for name in ("kinematic_2d.e", "kinematic_2d.bind", "kinematic_2d.lisp"):
                (self.folder / name).write_text((examples / name).read_text())
            text = (examples / "kinematic_2d.yaml").read_text()
            self.assertIn("kinematic_2d.py", text)
            (self.folder / "scenario.yaml").write_text(text.replace("kinematic_2d.py", str(script)))
            run = px.Scenario("scenario.yaml").run(keep_going=True, max_runs=6, allow_commands=True)
            samples.append([one.raw for one in run.samples])
        self.assertEqual(samples[0], samples[1])
        self.assertTrue(samples[0])

    def test_faults_are_told(self) -> None:
        (self.folder / "sim.py").write_text(
            "from parallax import *\n"
            "@simulator('bad', determinism='bitwise')\n"
            "class World:\n"
            "    x = param('a.x', unit='m', default=1.0)\n"
            "    def reset(self): self.x += 0.5\n"
            "    @action('go')\n"
            "    def go(self): self.sim.advance(1.0)\n"
            "serve(World)\n")
        check = px.adapter_check("sim.py")
        self.assertFalse(check)
        self.assertTrue(any(one.startswith("reset: ") for one in check.faults), check.faults)

    def test_a_class_that_is_no_simulator(self) -> None:
        with self.assertRaises(TypeError):
            px.serve(object)
        with self.assertRaises(TypeError):
            px.simulator("empty")(type("Empty", (), {}))


if __name__ == "__main__":
    unittest.main()
