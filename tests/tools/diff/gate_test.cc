// `parallax diff --gate`: pairs of revisions whose answers are known, and invalid rules.

#include <doctest/doctest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/tools/cli_json.h"
#include "tests/tools/diff/gate_fixture.h"

namespace parallax::test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

TEST_CASE("1: the same model in other words keeps every rule") {
  const Gate gate;
  const auto found = gate.models(kAll, kTurkey,
                                 "range time 0 1\n"
                                 "event Shoot()\n"
                                 "fluent Loaded()\nfluent Alive()\n"
                                 "HoldsAt(Alive(),0). ; as before\n"
                                 "[time] HoldsAt(Loaded(),time) ->\n"
                                 "  Terminates(Shoot(),Alive(),time).\n");
  CHECK(found["passed"] == true);
  for (const auto* rule : {"lost_traces", "gained_traces", "declarations", "axioms"}) {
    CHECK(found[std::string("models.") + rule] == "kept");
  }
}

TEST_CASE("2: a condition that is dropped loses a trace and gains one") {
  const Gate gate;
  std::string changed = kTurkey;
  changed.replace(changed.find("HoldsAt(Loaded(),time) -> "), 26, "");
  const auto found = gate.models(kAll, kTurkey, changed);
  CHECK(found["passed"] == false);
  // Unloaded and shot at: alive before, dead now.
  CHECK(found["models.lost_traces"] == "broken");
  CHECK(found["models.lost_traces words"] == "1 lost up to timepoint 1");
  CHECK(found["models.gained_traces words"] == "1 gained up to timepoint 1");
  CHECK(holds(found["models.lost_traces witness"], "> Shoot()"));
  CHECK(holds(found["models.lost_traces witness"], "it contradicts"));
  CHECK(found["models.axioms"] == "broken");
  CHECK(found["models.declarations"] == "kept");
}

TEST_CASE("3 and 4: an axiom more only loses, one less only gains") {
  const Gate gate;
  const std::string more = std::string(kTurkey) + "HoldsAt(Loaded(),0).\n";
  const auto lost = gate.models(kAll, kTurkey, more);
  CHECK(lost["models.lost_traces"] == "broken");
  CHECK(lost["models.lost_traces words"] == "2 lost up to timepoint 1");
  CHECK(lost["models.gained_traces"] == "kept");
  const auto gained = gate.models(kAll, more, kTurkey);
  CHECK(gained["models.lost_traces"] == "kept");
  CHECK(gained["models.gained_traces words"] == "2 gained up to timepoint 1");
  // An allowed change breaks no rule.
  const auto allowed =
      gate.models("models: {lost_traces: forbidden, gained_traces: allowed}\n", more, kTurkey);
  CHECK(allowed["passed"] == true);
  CHECK_FALSE(allowed.contains("models.gained_traces"));
}

TEST_CASE("5: traces of names that only one model has are not decided") {
  const Gate gate;
  const std::string more = std::string("fluent Tired()\n") + kTurkey;
  const auto found = gate.models(kAll, kTurkey, more);
  CHECK(found["models.lost_traces"] == "kept");
  CHECK(found["models.gained_traces"] == "not decidable");
  CHECK(holds(found["models.gained_traces words"], "only new.e has Tired()"));
  CHECK(found["passed"] == false);
  const std::string rules = "models: {gained_traces: forbidden}\nundecided: ";
  CHECK(gate.models(rules + "passes\n", kTurkey, more)["passed"] == true);
  CHECK(gate.models(rules + "fails\n", kTurkey, more)["passed"] == false);
  // The same of a horizon that one has not.
  std::string longer = kTurkey;
  longer.replace(longer.find("0 1"), 3, "0 2");
  CHECK(gate.models(rules + "fails\n", kTurkey, longer)["models.gained_traces"] == "not decidable");
  CHECK(gate.models("models: {lost_traces: forbidden}\n", kTurkey, longer)["passed"] == true);
}

TEST_CASE("6: a property that held must hold, whatever else changes") {
  const Gate gate;
  const std::string rules =
      "models:\n  properties:\n    - 'HoldsAt(Loaded(),time) | HoldsAt(Alive(),time)'\n";
  // The bullet is gone after the shot.
  const std::string empties = std::string(kTurkey) + "[time] Terminates(Shoot(),Loaded(),time).\n";
  const auto lost = gate.models(rules, kTurkey, empties);
  CHECK(lost["models.properties"] == "broken");
  CHECK(holds(lost["models.properties witness"], "> Shoot()"));
  CHECK(gate.models(rules, kTurkey, kTurkey)["models.properties"] == "kept");
  CHECK(gate.models(rules, empties, kTurkey)["models.properties"] == "kept");
  const auto never = gate.models(rules, empties, empties);
  CHECK(never["models.properties"] == "kept");
  CHECK(holds(never["models.properties words"], "did not hold before either"));
  // A model without traces has every property, which is no merit.
  const auto none = gate.models(rules, kTurkey, std::string(kTurkey) + "!HoldsAt(Alive(),0).\n");
  CHECK(none["models.properties"] == "not decidable");
  CHECK(holds(none["models.properties words"], "no trace at all"));
}

TEST_CASE("7: a discrepancy that a run has gained is shown, in a picture, too") {
  const Gate gate;
  const auto run = [&](const std::string& scenario, const std::string& out) {
    gate.replace(scenario, "include: common.yaml",
                 "include: common.yaml\ncriterion: {confidence: 0.9, epsilon: 0.4}");
    const auto code = gate.parallax({"run", scenario, "--out", out}).code;
    CHECK(code == (out == "old" ? 0 : 1));
  };
  run("scenario.yaml", "old");
  run("wrong_model.yaml", "new");
  const std::string rules =
      "runs: {gained_discrepancies: forbidden, worse_verdict: forbidden, settings: allowed}\n";
  const auto found = gate.hold(rules, "old", "new", {"--markdown", "out/gate.md"});
  CHECK(found["runs.gained_discrepancies"] == "broken");
  CHECK(found["runs.worse_verdict"] == "broken");
  CHECK(holds(found["runs.gained_discrepancies witness"], "parallax replay new --sample"));
  const auto markdown = gate.read("out/gate.md");
  CHECK(holds(markdown, "### Gate failed: 2 of 2 rules are broken"));
  const auto at = markdown.find("](<gate.pictures/");
  REQUIRE(at != std::string::npos);
  const auto name = markdown.substr(at + 3, markdown.find('>', at) - at - 3);
  CHECK(holds(gate.read("out/" + name), "<svg"));
  // The other way round a discrepancy was lost, which is no harm. The Markdown is made anew.
  const auto back = gate.hold(rules, "new", "old", {"--markdown", "out/gate.md"});
  CHECK(back["runs.worse_verdict"] == "kept");
  CHECK(holds(gate.read("out/gate.md"), "old"));
  // And a run against itself keeps everything.
  const auto same = gate.hold(
      "runs: {gained_discrepancies: forbidden, worse_verdict: forbidden, lost_traces: forbidden, "
      "settings: forbidden}\n",
      "new", "new");
  CHECK(same["passed"] == true);
}

TEST_CASE(
    "8: a run that did not look as far as the older one does not show that nothing is gained") {
  const Gate gate;
  REQUIRE(gate.parallax({"run", "two/agree.yaml", "--out", "old"}).code == 0);
  REQUIRE(gate.parallax({"run", "two/agree.yaml", "--out", "few", "--max-runs", "5"}).code == 4);
  const std::string rules = "runs: {gained_discrepancies: forbidden, worse_verdict: forbidden}\n";
  const auto found = gate.hold(rules, "old", "few");
  CHECK(found["runs.gained_discrepancies"] == "not decidable");
  CHECK(found["runs.worse_verdict"] == "not decidable");
  CHECK(found["passed"] == false);
  CHECK(gate.hold(rules, "few", "old")["passed"] == true);
}

TEST_CASE("10: lists of traces, of which it matters whether they are whole, and plans") {
  const Gate gate;
  gate.write("old.e", kTurkey);
  gate.write("new.e", std::string(kTurkey) + "HoldsAt(Loaded(),0).\n");
  const auto list = [&](const std::string& model, const std::string& limit,
                        const std::string& file) {
    gate.write(file, gate.parallax({"traces", model, "--limit", limit, "--format", "jsonl"}).out);
  };
  list("old.e", "0", "old.jsonl");
  list("new.e", "0", "new.jsonl");
  list("new.e", "1", "part.jsonl");
  const std::string rules = "traces: {lost: forbidden, gained: forbidden}\n";
  const auto lost = gate.hold(rules, "old.jsonl", "new.jsonl");
  CHECK(lost["traces.lost"] == "broken");
  CHECK(lost["traces.lost words"] == "2 lost");
  CHECK(lost["traces.gained"] == "kept");
  const auto part = gate.hold(rules, "old.jsonl", "part.jsonl");
  CHECK(part["traces.lost"] == "not decidable");
  CHECK(part["traces.gained"] == "not decidable");

  gate.write("new.lisp", gate.read("fetch.lisp"));
  const std::string plans = "plans: {forms: forbidden, order: forbidden}\n";
  CHECK(gate.hold(plans, "fetch.lisp", "new.lisp")["passed"] == true);
  gate.replace("new.lisp", "(def-cram-function fetch", "(def-cram-function bring");
  CHECK(gate.hold(plans, "fetch.lisp", "new.lisp")["plans.forms"] == "broken");
}

TEST_CASE("rules that are none are refused where they stand") {
  const Gate gate;
  gate.refused("models: {lost_trace: forbidden}\n", "lost_traces");
  gate.refused("model: {lost_traces: forbidden}\n", "models");
  gate.refused("models: {lost_traces: never}\n", "`never` is not a known value of `lost_traces`");
  gate.refused("models: {lost_traces: allowed}\n", "`models` expects nothing");
  gate.refused("models: {properties: []}\n", "empty");
  gate.refused("models: {lost_traces: forbidden}\nundecided: maybe\n", "maybe");
  gate.refused("{}\n", "expects nothing");
  gate.refused("undecided: passes\n", "expects nothing");
  gate.refused("runs: {settings: forbidden}\n", "the rules say nothing of models");
  gate.refused("rates: {worse: {margin: 0}}\n", "margin");
  gate.refused("rates: {worse: {marge: 0.1}}\n", "margin");
  gate.refused("models: &a {lost_traces: forbidden}\n", "anchors");
  // An invalid property is reported with its own text.
  gate.write("rules.yaml", "models: {properties: ['HoldsAt(Alive(']}\n");
  const auto formula = gate.parallax({"diff", "--gate", "rules.yaml", "old.e", "old.e"});
  CHECK(formula.code == 3);
  CHECK_MESSAGE(holds(formula.err, "HoldsAt(Alive("), formula.err);
}

TEST_CASE("a gate and diff see what a scenario says beside its model") {
  const Gate gate;
  const auto scenario = [&](const char* name, const char* more) {
    const auto path = gate.world("load opens.e\n", more);
    fs::copy_file(gate.folder() / path, gate.folder() / name, fs::copy_options::overwrite_existing);
    return std::string(name);
  };
  const auto before = scenario("two/old.yaml", "");
  const auto same = scenario("two/same.yaml", "limits: {max_traces: 0}\n");
  const auto weaker = scenario("two/weaker.yaml", "criterion: {epsilon: 0.1}\n");
  const std::string rules = "models: {claim: forbidden, physics: forbidden}\n";
  CHECK(gate.hold(rules, before, before)["passed"] == true);
  const auto held = gate.hold(rules, before, weaker);
  CHECK(held["models.claim"] == "broken");
  CHECK(held["models.physics"] == "kept");
  CHECK(held["models.claim words"] == "criterion.epsilon 0.05 (default) -> 0.1");
  CHECK(gate.hold("models: {criterion: not-weaker}\n", weaker, before)["passed"] == true);
  gate.refused("models: {criterion: not-wider}\n", "not-weaker");
  gate.refused("models: {wold: forbidden}\n", "world");
  // Rules that stand one level too high.
  for (const std::string key : {"settings", "world", "lost_traces", "properties"}) {
    gate.refused(key + ": forbidden\n", "Move it below `models`");
  }
  const auto told = gate.parallax({"diff", before, weaker, "--no-traces"});
  CHECK(told.code == 1);
  CHECK(told.out ==
        "claim: 1 changed\n  ~ two/weaker.yaml:3  criterion.epsilon 0.05 (default) -> 0.1\n");
  const auto document = Json::parse(gate.parallax({"diff", before, weaker, "--json"}).out);
  CHECK(document["equal"] == false);
  CHECK(document["settings"][0]["path"] == "criterion.epsilon");
  CHECK(document["settings"][0]["changes"] == Json{"claim"});
  CHECK(gate.parallax({"diff", before, weaker, "--no-traces", "--stat"}).out ==
        "claim: 1 changed\n");
  CHECK(gate.parallax({"diff", before, same}).code == 0);
}

TEST_CASE("what cannot be compared or written is refused before it is") {
  const Gate gate;
  gate.write("rules.yaml", kAll);
  gate.write("old.e", kTurkey);
  gate.write("notes.md", "# mine\n");
  const auto code = [&](const std::vector<std::string>& arguments) {
    return gate.parallax(arguments).code;
  };
  CHECK(code({"diff", "--gate", "rules.yaml", "old.e", "old.e", "--markdown", "notes.md"}) == 2);
  CHECK(gate.read("notes.md") == "# mine\n");
  CHECK(code({"diff", "--gate", "rules.yaml", "old.e", "old.e", "--markdown", "old.e"}) == 2);
  CHECK(code({"diff", "--gate", "rules.yaml", "old.e", "fetch.lisp"}) == 2);
  CHECK(code({"diff", "--gate", "rules.yaml", "old.e", "old.e", "--stat"}) == 2);
  CHECK(code({"diff", "--gate", "absent.yaml", "old.e", "old.e"}) == 2);
  gate.write("rates.yaml", "rates: {worse: forbidden}\n");
  for (
      const auto* bad :
      {"", "[]", "{}", R"({"status":"ok","complete":true,"compare":"final","traces":3})",
       R"({"status":"ok","complete":true,"compare":"final","traces":[{"events":"A","runs":1,"lost":0,"any":{"count":2},"causes":[{"cause":"x","count":2}]}]})",
       R"({"status":"ok","complete":true,"compare":"final","traces":[{"events":"A","runs":-1,"lost":0,"any":{"count":0},"causes":[]}]})"}) {
    gate.write("bad.json", bad);
    const auto result = gate.parallax({"diff", "--gate", "rates.yaml", "bad.json", "bad.json"});
    CAPTURE(bad);
    CHECK(result.code == 3);
    CHECK(holds(result.err, "E7119"));
  }
}

}  // namespace
}  // namespace parallax::test
