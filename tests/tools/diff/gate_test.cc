// `parallax diff --gate`: pairs of revisions whose answers are known, and invalid rules.

#include <doctest/doctest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/tools/cli_json.h"
#include "tests/tools/two_models.h"

namespace parallax::test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// A turkey that is alive and may be shot at, once; loaded or not. Four starts and two choices, in
/// A turkey that is alive and may be shot at, once, with a gun that is loaded or not: four traces.
constexpr const char* kTurkey =
    "range time 0 1\n"
    "fluent Alive()\n"
    "fluent Loaded()\n"
    "event Shoot()\n"
    "[time] HoldsAt(Loaded(),time) -> Terminates(Shoot(),Alive(),time).\n"
    "HoldsAt(Alive(),0).\n";

constexpr const char* kAll =
    "models: {lost_traces: forbidden, gained_traces: forbidden, declarations: forbidden, "
    "axioms: forbidden}\n";

class Gate : public TwoModels {
 public:
  /// Outcomes of the rules, by name; the gate's exit code must follow from them.
  Json hold(const std::string& rules, const std::string& before, const std::string& after,
            const std::vector<std::string>& more = {}) const {
    write("rules.yaml", rules);
    std::vector<std::string> arguments = {"diff", "--gate", "rules.yaml", before, after, "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto result = parallax(arguments);
    CAPTURE(result.err);
    CAPTURE(result.out);
    const auto document = Json::parse(result.out);
    REQUIRE(document["status"] == "ok");
    const bool passed = document["gate"]["passed"];
    CHECK(result.code == (passed ? 0 : 1));
    Json out = {{"passed", passed}};
    for (const auto& rule : document["gate"]["rules"]) {
      out[rule["rule"].get<std::string>()] = rule["outcome"];
      out[rule["rule"].get<std::string>() + " witness"] = rule["witness"];
      out[rule["rule"].get<std::string>() + " words"] = rule["words"];
    }
    return out;
  }
  Json models(const std::string& rules, const std::string& before, const std::string& after) const {
    write("old.e", before);
    write("new.e", after);
    return hold(rules, "old.e", "new.e");
  }
  void refused(const std::string& rules, const std::string& why) const {
    write("rules.yaml", rules);
    write("old.e", kTurkey);
    const auto result = parallax({"diff", "--gate", "rules.yaml", "old.e", "old.e"});
    CAPTURE(rules);
    CHECK(result.code == 3);
    CHECK_MESSAGE(holds(result.err, why), result.err);
    CHECK(holds(result.err, "rules.yaml:"));
  }
};

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

/// `parallax rates` of a scenario in a file.
void keep_rates(const Gate& gate, const std::string& scenario, int runs, const std::string& file) {
  const auto result = gate.parallax({"rates", scenario, "--runs", std::to_string(runs), "--json"});
  REQUIRE(result.code == 0);
  gate.write(file, result.out);
}

TEST_CASE("9: rates are worse, no worse, or not known to be") {
  const Gate gate;
  keep_rates(gate, "two/agree.yaml", 100, "clean.json");
  keep_rates(gate, "two/sticks.yaml", 100, "sticks.json");
  keep_rates(gate, "two/sticks.yaml", 12, "few.json");
  keep_rates(gate, "two/agree.yaml", 12, "few_clean.json");
  const std::string rules = "rates: {worse: forbidden, gained_causes: forbidden}\n";
  const auto worse = gate.hold(rules, "clean.json", "sticks.json");
  CHECK(worse["rates.worse"] == "broken");
  CHECK(worse["rates.gained_causes"] == "broken");
  CHECK(holds(worse["rates.gained_causes witness"], "OpenDrawer(top): not Open(top)"));
  CHECK(gate.hold(rules, "sticks.json", "clean.json")["passed"] == true);
  CHECK(gate.hold(rules, "clean.json", "clean.json")["passed"] == true);
  // Twelve clean runs do not show that fewer than 5 % more go wrong.
  const auto few = gate.hold(rules, "few_clean.json", "few_clean.json");
  CHECK(few["rates.worse"] == "not decidable");
  CHECK(few["rates.gained_causes"] == "kept");
  CHECK(gate.hold("rates: {worse: {confidence: 0.95, margin: 0.4}}\n", "few_clean.json",
                  "few_clean.json")["passed"] == true);
  // Runs that ended when they had shown enough have wider bounds: 5.2 % for a hundred clean ones.
  auto ended = Json::parse(gate.read("clean.json"));
  ended["intervals"] = "anytime";
  ended["complete"] = false;
  gate.write("ended.json", ended.dump());
  CHECK(gate.hold(rules, "ended.json", "clean.json")["rates.worse"] == "kept");
  CHECK(gate.hold(rules, "clean.json", "ended.json")["rates.worse"] == "not decidable");
  const auto narrow =
      gate.parallax({"rates", "two/sticks.yaml", "--until-width", "0.25", "--json"});
  REQUIRE(narrow.code == 0);
  gate.write("narrow.json", narrow.out);
  const auto parted = gate.hold(rules, "clean.json", "narrow.json");
  CHECK(parted["rates.worse"] == "broken");
  CHECK(parted["rates.gained_causes"] == "broken");
  CHECK(holds(parted["rates.worse witness"], "bounds that hold whenever one looks part"));
  CHECK(gate.hold(rules, "narrow.json", "clean.json")["passed"] == true);
  CHECK(gate.hold(rules, "narrow.json", "sticks.json")["rates.worse"] == "not decidable");
  // Without a gate they are compared as everything is.
  CHECK(gate.parallax({"diff", "clean.json", "clean.json"}).code == 0);
  const auto plain = gate.parallax({"diff", "clean.json", "sticks.json"});
  CHECK(plain.code == 1);
  CHECK(holds(plain.out, "OpenDrawer(top): not Open(top)"));
}

TEST_CASE("a run that was lost is the worst for either answer") {
  const Gate gate;
  const auto rates = [&](const std::string& file, int runs, int count, int lost) {
    const Json causes =
        count == 0 ? Json::array() : Json{{{"cause", "Go(): no"}, {"count", count}}};
    gate.write(file, Json{{"status", "ok"},
                          {"complete", true},
                          {"compare", "every-step"},
                          {"traces",
                           {{{"events", "Go()"},
                             {"runs", runs},
                             {"lost", lost},
                             {"any", {{"count", count}}},
                             {"causes", causes}}}}}
                         .dump());
  };
  const std::string rules = "rates: {worse: {margin: 0.1}}\n";
  rates("old.json", 100, 0, 0);
  rates("new.json", 100, 0, 0);
  CHECK(gate.hold(rules, "old.json", "new.json")["rates.worse"] == "kept");
  rates("new.json", 80, 0, 20);  // may all have failed
  CHECK(gate.hold(rules, "old.json", "new.json")["rates.worse"] == "not decidable");
  rates("new.json", 80, 20, 0);
  CHECK(gate.hold(rules, "old.json", "new.json")["rates.worse"] == "broken");
  rates("old.json", 80, 0, 20);  // may have been as bad
  CHECK(gate.hold(rules, "old.json", "new.json")["rates.worse"] == "not decidable");
}

TEST_CASE("runs of equal starts are compared in pairs") {
  const Gate gate;
  const auto rates = [&](const std::string& file, std::vector<std::string> words) {
    words.insert(words.begin(), "rates");
    words.insert(words.end(), {"--outcomes", "--json"});
    const auto result = gate.parallax(words);
    CAPTURE(result.err);
    REQUIRE(result.code == 0);
    gate.write(file, result.out);
  };
  // Sticks in a part of all starts: the same ones with the same seed, so that nothing is worse.
  rates("old.json", {"two/sticks.yaml", "--runs", "100"});
  rates("same.json", {"two/sticks.yaml", "--runs", "100"});
  rates("other.json", {"two/sticks.yaml", "--runs", "100", "--seed", "2"});
  const std::string rules = "rates: {worse: {margin: 0.05}}\n";
  const auto same = gate.hold(rules, "old.json", "same.json");
  CHECK(same["rates.worse"] == "kept");
  CHECK(holds(same["rates.worse words"],
              "of 100 pairs, 100 with equal starts, 0 fail anew and 0 no longer"));
  const auto other = gate.hold(rules, "old.json", "other.json");
  CHECK(other["rates.worse"] == "not decidable");
  CHECK_FALSE(holds(other["rates.worse witness"], "pairs"));

  // Six that fail anew: 30 of 100 against 36 of 100 say nothing, six pairs of six do.
  const auto made = [&](const std::string& file, int failures, int moved, int lost) {
    Json samples = Json::array();
    for (int i = 0; i < 100; ++i) {
      const char* outcome = i < failures ? "discrepancy" : i < failures + lost ? "lost" : "clean";
      samples.push_back(
          {{"outcome", outcome}, {"start", std::to_string(i + (i < moved ? 500 : 0))}});
    }
    gate.write(file, Json{{"status", "ok"},
                          {"complete", true},
                          {"compare", "every-step"},
                          {"seed", 1},
                          {"traces",
                           {{{"events", "Go()"},
                             {"runs", 100 - lost},
                             {"lost", lost},
                             {"any", {{"count", failures}}},
                             {"causes", {{{"cause", "no"}, {"count", failures}}}},
                             {"samples", samples}}}}}
                         .dump());
  };
  made("thirty.json", 30, 0, 0);
  made("six_more.json", 36, 1, 0);
  const auto worse = gate.hold(rules, "thirty.json", "six_more.json");
  CHECK(worse["rates.worse"] == "broken");
  CHECK(holds(worse["rates.worse witness"], "McNemar's exact test, p = 0.016"));
  CHECK(holds(worse["rates.worse witness"], "99 with equal starts, 6 fail anew and 0 no longer"));
  made("other_starts.json", 36, 100, 0);
  CHECK(gate.hold(rules, "thirty.json", "other_starts.json")["rates.worse"] == "not decidable");
  // The lost runs may all have been failures.
  made("thirty.json", 30, 0, 4);
  CHECK(gate.hold(rules, "thirty.json", "six_more.json")["rates.worse"] == "not decidable");
  // Runs that contradict the counts are no rates.
  auto broken = Json::parse(gate.read("six_more.json"));
  broken["traces"][0]["samples"][0]["outcome"] = "clean";
  gate.write("broken.json", broken.dump());
  CHECK(gate.parallax({"diff", "broken.json", "six_more.json"}).code == 3);
}

TEST_CASE("rates under different laws of starts are not compared") {
  const Gate gate;
  const auto rates = [&](const std::string& file, const Json& words) {
    Json trace = {{"events", "Go()"}, {"runs", 100}, {"lost", 0}};
    trace["any"] = {{"count", 0}};
    trace["causes"] = Json::array();
    if (!words.empty()) trace["law"] = {{"words", words}};
    gate.write(file, Json{{"status", "ok"},
                          {"complete", true},
                          {"compare", "every-step"},
                          {"traces", Json::array({trace})}}
                         .dump());
  };
  const std::string rules = "rates: {worse: {margin: 0.1}}\n";
  const auto bell = Json::array({"box.x normal with mean 1 and sd 1", "given box.x < 2"});
  rates("plain.json", Json::array());
  rates("bell.json", bell);
  CHECK(gate.hold(rules, "bell.json", "bell.json")["rates.worse"] == "kept");
  CHECK(gate.hold(rules, "plain.json", "bell.json")["rates.worse"] == "not decidable");
  CHECK(gate.hold(rules, "bell.json", "plain.json")["rates.worse"] == "not decidable");
  const auto plain = gate.parallax({"diff", "plain.json", "bell.json"});
  CHECK(holds(plain.out, "starts: box.x normal with mean 1 and sd 1; given box.x < 2"));
}

TEST_CASE("rates from initial states that were drawn otherwise are not compared") {
  const Gate gate;
  const auto rates = [&](const std::string& file, const Json& initial) {
    Json trace = {{"events", "Go()"}, {"runs", 100}, {"lost", 0}};
    trace["any"] = {{"count", 0}};
    trace["causes"] = Json::array();
    if (!initial.is_null()) trace["initial_states"] = initial;
    gate.write(file, Json{{"status", "ok"},
                          {"complete", true},
                          {"compare", "every-step"},
                          {"traces", Json::array({trace})}}
                         .dump());
  };
  const auto drawn = [](const char* law, const Json& all) {
    return Json{{"all", all}, {"tried", 1}, {"law", law}};
  };
  rates("old.json", nullptr);  // as versions wrote it that sampled the first state only
  rates("one.json", drawn("uniform", 1));
  rates("six.json", drawn("uniform", 6));
  rates("seven.json", drawn("uniform", 7));
  rates("many.json", drawn("uniform", nullptr));
  rates("weights.json", drawn("weights", 6));
  rates("first.json", drawn("first", 6));
  const std::string rules = "rates: {worse: {margin: 0.1}}\n";
  const auto outcome = [&](const std::string& before, const std::string& after) {
    return gate.hold(rules, before, after)["rates.worse"].get<std::string>();
  };
  const std::vector<std::string> files = {"one.json",  "six.json",     "seven.json",
                                          "many.json", "weights.json", "first.json"};
  for (const auto& before : files) {
    for (const auto& after : files) {
      CAPTURE(before);
      CAPTURE(after);
      CHECK(outcome(before, after) == (before == after ? "kept" : "not decidable"));
    }
  }
  // Nobody knows of how many states the old file has the first one.
  for (const auto* other : {"old.json", "one.json", "first.json"}) {
    CHECK(outcome("old.json", other) == "kept");
    CHECK(outcome(other, "old.json") == "kept");
  }
  for (const auto* other : {"six.json", "many.json", "weights.json"}) {
    CHECK(outcome("old.json", other) == "not decidable");
    CHECK(outcome(other, "old.json") == "not decidable");
  }
  const auto words = gate.hold(rules, "old.json", "six.json")["rates.worse words"];
  CHECK(holds(words.get<std::string>(),
              "initial states of the trace Go() were drawn otherwise (only the first, now uniform "
              "of 6)"));
  const auto listed = gate.parallax({"diff", "six.json", "seven.json"});
  CHECK(holds(listed.out, "initial states: uniform of 7"));
  for (const auto& wrong :
       {drawn("fair", 6), drawn("uniform", 0), drawn("uniform", "6"), Json::array()}) {
    rates("wrong.json", wrong);
    CHECK(gate.parallax({"diff", "wrong.json", "one.json"}).code == 3);
  }
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
  CHECK(code({"diff", "old.e", "old.e", "--markdown", "new.md"}) == 2);
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
