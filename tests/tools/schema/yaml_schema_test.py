"""Schemas of YAML files against the program: it reads what they allow, and refuses the keys that they do not name.

The program says which keys a map has when one of them is unknown. So an unknown key is put into every kind of map that the
repository's scenarios have, and what the program lists is compared with the schema.
"""

import copy
import json
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from typing import Any, Dict, Iterator, List, Set, Tuple

try:
    import jsonschema
    import yaml
except ImportError:
    print("SKIPPED: there is no python3-jsonschema or python3-yaml")
    sys.exit(0)

SOURCE = Path(os.environ["PARALLAX_SOURCE"]).resolve()
PROGRAM = os.environ["PARALLAX_PROGRAM"]
UNKNOWN = "qqqqqqqqqqqq"  # like no key, so that all are listed

# A status of a ledger is refused as a whole, without a list of keys.
NOT_LISTED = {("accepted", "repaired"), ("because",), ("in",)}

LEDGER = """discrepancies:
  - id: one
    scenario: edge.yaml
    event: Place(r1)
    status: {accepted: {because: it is so}}
  - {id: two, scenario: edge.yaml, event: Go(r1), status: open, fluents: [F()], says: gone}
"""
GATE = """models: {settings: forbidden, horizon: not-shorter, physics: {rerun: {runs: 40, seconds: 60}}, properties: ["F"]}
plans: {forms: allowed}
traces: {lost: forbidden}
runs: {worse_verdict: forbidden, physics: rerun}
rates: {gained_causes: forbidden, worse: {confidence: 0.9, margin: 0.1}}
undecided: fails
"""


def run(arguments: List[str]) -> "subprocess.CompletedProcess[str]":
    return subprocess.run([PROGRAM, *arguments], capture_output=True, text=True)


def kind_of(document: Any) -> str:
    for key, name in (("cases", "suite.yaml"), ("discrepancies", "ledger.yaml"), ("quarantine", "quarantine.yaml")):
        if key in document:
            return name
    is_part = {"bodies", "joints", "robot", "solver"} & set(document)
    return "world.yaml" if is_part else "scenario.yaml"


class Schema:
    def __init__(self, name: str) -> None:
        self.document = json.loads(run(["schema", name]).stdout)
        jsonschema.Draft202012Validator.check_schema(self.document)
        self.validator = jsonschema.Draft202012Validator(self.document)

    def errors(self, value: Any) -> List[str]:
        return ["%s: %s" % ("/".join(map(str, one.absolute_path)), one.message)
                for one in self.validator.iter_errors(value)]

    def fits(self, schema: Dict[str, Any], value: Any) -> bool:
        whole = dict(schema, **{"$defs": self.document.get("$defs", {})})
        return bool(jsonschema.Draft202012Validator(whole).is_valid(value))

    def alternatives(self, schema: Dict[str, Any]) -> List[Dict[str, Any]]:
        if "$ref" in schema:
            return self.alternatives(self.document["$defs"][schema["$ref"].split("/")[-1]])
        return [part for one in schema.get("anyOf", []) for part in self.alternatives(one)] or [schema]

    def maps(self, schema: Dict[str, Any], value: Any,
             path: Tuple[Any, ...] = ()) -> Iterator[Tuple[Tuple[Any, ...], Set[str], Set[str]]]:
        """Each map with fixed keys below the value: its place, its keys, those of all its alternatives."""
        options = [one for one in self.alternatives(schema) if self.fits(one, value)]
        if not options:
            return
        if isinstance(value, list):
            for at, item in enumerate(value):
                yield from self.maps(options[0].get("items", {}), item, path + (at,))
        if not isinstance(value, dict):
            return
        known = options[0].get("properties", {})
        others = options[0].get("additionalProperties")
        if others is False:
            every = {key for one in self.alternatives(schema) for key in one.get("properties", {})}
            yield path, set(known), every
        for key, member in value.items():
            part = known.get(key, others)
            if isinstance(part, dict):
                yield from self.maps(part, member, path + (key,))


def listed_keys(said: str) -> Set[str]:
    document = json.loads(said)
    for one in document.get("diagnostics", []):
        if one["code"] == "E5102" and UNKNOWN in one["message"]:
            for note in one["notes"]:
                match = re.match(r"known keys: (.*)$", note["message"])
                if match:
                    return set(match.group(1).split(", "))
    return set()


class Yaml(unittest.TestCase):
    def test_the_files_of_the_repository_are_valid(self) -> None:
        schemas: Dict[str, Schema] = {}
        count = 0
        for path in sorted((SOURCE / "scenarios").rglob("*.yaml")):
            document = yaml.safe_load(path.read_text())
            name = kind_of(document)
            schema = schemas.setdefault(name, Schema(name))
            with self.subTest(path=str(path)):
                self.assertEqual(schema.errors(document), [])
            count += 1
        self.assertGreater(count, 50)
        for name, text in (("ledger.yaml", LEDGER), ("gate.yaml", GATE)):
            self.assertEqual(Schema(name).errors(yaml.safe_load(text)), [])

    def test_every_published_schema_is_one(self) -> None:
        for one in json.loads(run(["schema", "--list", "--json"]).stdout)["schemas"]:
            Schema(one["name"])

    def test_what_is_wrong_is_refused(self) -> None:
        schema = Schema("scenario.yaml")
        for wrong in ({"horizon": -1}, {"horizn": 3}, {"criterion": "clean"}, {"criterion": {"epsilon": 1.0}},
                      {"limits": {"max_runs": 1.5}}, {"execution": "half-open"}, {"model": 3}, {"search": {"runs": "x"}},
                      {"mapping": {"F()": {"inside": "r", "flag": "x"}}}, {"world": {"bodies": {"a": {"mass": 1}}}}):
            with self.subTest(wrong=wrong):
                self.assertNotEqual(schema.errors(wrong), [])

    def probe(self, command: List[str], folder: Path, name: str, schema: Schema, document: Any) -> None:
        """Puts an unknown key into each kind of map that was not compared before."""
        for path, keys, every in schema.maps(schema.document, document):
            kind = tuple(sorted(keys))
            if kind in self.seen:
                continue
            changed = copy.deepcopy(document)
            at = changed
            for step in path:
                at = at[step]
            at[UNKNOWN] = 1
            target = folder / ("probe_" + name)
            target.write_text(yaml.safe_dump(changed, sort_keys=False, allow_unicode=True))
            said = run([*command, str(target), "--json"])
            listed = listed_keys(said.stdout)
            target.unlink()
            if not listed:  # a part of a world, of which it looks at nothing more
                self.missed[kind] = "%s %s" % (target, "/".join(map(str, path)))
                continue
            self.seen.add(kind)
            with self.subTest(map="%s %s" % (name, "/".join(map(str, path)))):
                # These are taken out before the map is read; `runs` is a key of one kind of criterion.
                self.assertLessEqual(keys - {"mesh", "include", "runs"}, listed)
                # The other forms of the same map.
                self.assertLessEqual(listed, every | {"include"})

    def test_the_program_knows_the_same_keys(self) -> None:
        self.seen: Set[Tuple[str, ...]] = set()
        self.missed: Dict[Tuple[str, ...], str] = {}
        with tempfile.TemporaryDirectory() as made:
            folder = Path(made) / "scenarios"
            subprocess.run(["cp", "-r", str(SOURCE / "scenarios"), str(folder)], check=True)
            schema = Schema("scenario.yaml")
            for path in sorted(folder.rglob("*.yaml")):
                document = yaml.safe_load(path.read_text())
                if kind_of(document) == "scenario.yaml":
                    self.probe(["check"], path.parent, path.name, schema, document)
                elif kind_of(document) == "world.yaml":
                    # Without arms the program takes a robot for one on rails.
                    if "arms" not in document.get("robot", {"arms": {}}):
                        del document["robot"]
                    self.probe(["check"], path.parent, path.name, schema, {"world": document})
            suite = yaml.safe_load((folder / "classics/suite.yaml").read_text())
            self.probe(["suite", "--collect-only"], folder / "classics", "suite.yaml", Schema("suite.yaml"), suite)
            self.probe(["ledger", "list", "--ledger"], folder, "ledger.yaml", Schema("ledger.yaml"),
                       yaml.safe_load(LEDGER))
            model = str(folder / "classics/coin_toss.e")
            self.probe(["diff", model, model, "--gate"], folder, "gate.yaml", Schema("gate.yaml"),
                       yaml.safe_load(GATE))
        missed = {kind: place for kind, place in self.missed.items() if kind not in self.seen | NOT_LISTED}
        self.assertEqual(missed, {})
        print("%d kinds of maps were compared" % len(self.seen))
        self.assertGreater(len(self.seen), 40)


if __name__ == "__main__":
    unittest.main()
