// `parallax diff --gate` of rates: worse, no worse, or not known to be.

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "tests/tools/cli_json.h"
#include "tests/tools/diff/gate_fixture.h"

namespace parallax::test {
namespace {

using Json = nlohmann::json;

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

}  // namespace
}  // namespace parallax::test
