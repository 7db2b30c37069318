// `physics: rerun`: a gate that runs a scenario as it was and as it is, where its physics changed.

#include <doctest/doctest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/tools/history/git_repository.h"

namespace parallax::test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// scenarios/two_regions in the folders `a` and `b`.
class TwoWorlds : public GitFixture {
 public:
  TwoWorlds() {
    for (const std::string tree : {"a", "b"}) {
      fs::create_directories(folder() / tree);
      for (const auto* name : {"scenario.yaml", "common.yaml", "world.yaml", "domain.e", "start.e",
                               "fetch.lisp", "robot.bind"}) {
        fs::copy(folder() / name, folder() / tree / name);
      }
    }
  }
  void rules(const std::string& text) const { write("rules.yaml", text); }
  ProcessResult gate(std::vector<std::string> words) const {
    words.insert(words.begin(), {"diff", "--gate", "rules.yaml"});
    return parallax(std::move(words));
  }
  void put(const std::string& name, const std::string& text) const {
    fs::create_directories((folder() / name).parent_path());
    write(name, text);
  }
  bool lies(const std::string& name) const { return fs::exists(folder() / name); }
};

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

constexpr const char* kMass = "world.bodies.box.mass_kg 0.3 -> ";
constexpr const char* kOld = "a/scenario.yaml";
constexpr const char* kOldWorld = "a/world.yaml";
constexpr const char* kNew = "b/scenario.yaml";

/// The one rule of a gate's JSON.
Json only_rule(const ProcessResult& answer) {
  CAPTURE(answer.err);
  const auto document = Json::parse(answer.out);
  REQUIRE(document["gate"]["rules"].size() == 1);
  return document["gate"]["rules"][0];
}

TEST_CASE("evidence keeps the rule or breaks it, and says what was run") {
  const TwoWorlds worlds;
  worlds.rules("models: {physics: {rerun: {runs: 25, seed: 7, margin: 0.2}}}\n");
  CHECK(has(worlds.gate({kOld, kNew}).out, "kept           models.physics: none changed"));

  worlds.replace("b/world.yaml", "mass_kg: 0.3", "mass_kg: 0.31");
  const std::string words =
      std::string(kMass) +
      "0.31; 0 of 25 before, 0 of 25 now; of 25 pairs, 25 with equal starts, 0 fail anew and 0 no "
      "longer: worse by less than 20 %; 25 runs of each trace, old and new, with seed 7";
  const auto kept = worlds.gate({kOld, kNew, "--markdown", "kept.md"});
  CHECK_MESSAGE(kept.code == 0, kept.out);
  CHECK_MESSAGE(has(kept.out, "kept           models.physics: " + words), kept.out);
  CHECK(has(worlds.read("kept.md"), "0 of 25 before, 0 of 25 now"));
  CHECK(has(worlds.read("kept.md"), "with seed 7"));

  worlds.replace("b/world.yaml", "mass_kg: 0.31", "mass_kg: 30");
  const auto broken = worlds.gate({kOld, kNew, "--markdown", "broken.md", "--jobs", "2"});
  CHECK_MESSAGE(broken.code == 1, broken.out);
  CHECK(has(broken.out, "broken         models.physics: " + std::string(kMass) + "30; 0 of 25"));
  CHECK_MESSAGE(has(broken.out, ": 0 before, 25 now"), broken.out);  // the cause
  CHECK(has(worlds.read("broken.md"), "0 of 25 before, 25 of 25 now"));
  const auto rule = only_rule(worlds.gate({kOld, kNew, "--json"}));
  CHECK(rule["outcome"] == "broken");
  const auto& rerun = rule["rerun"];
  CHECK(rerun["seed"] == 7);
  CHECK(rerun["runs"] == 25);
  CHECK(rerun["problem"].is_null());
  REQUIRE(rerun["traces"].size() == 1);
  const auto& trace = rerun["traces"][0];
  CHECK(trace["old"] == Json{{"runs", 25}, {"lost", 0}, {"discrepancies", 0}});
  CHECK(trace["new"] == Json{{"runs", 25}, {"lost", 0}, {"discrepancies", 25}});
  CHECK(trace["pairs"] == Json{{"equal_starts", 25}, {"gained", 25}, {"mended", 0}});
  // The gate says the same as the command that it names.
  const auto rates =
      Json::parse(worlds.parallax({"rates", kNew, "--runs", "25", "--seed", "7", "--json"}).out);
  CHECK(rates["traces"][0]["any"]["count"] == 25);
}

TEST_CASE("a budget that is not enough leaves the rule undecided, and says so") {
  const TwoWorlds worlds;
  worlds.replace("b/world.yaml", "mass_kg: 0.3", "mass_kg: 0.31");
  worlds.rules("models: {physics: {rerun: {runs: 3}}}\n");
  const auto few = worlds.gate({kOld, kNew});
  CHECK(few.code == 1);
  CHECK_MESSAGE(has(few.out, "not decidable  models.physics: "), few.out);
  CHECK(has(few.out, "more runs would tell"));
  worlds.rules("models: {physics: {rerun: {runs: 100000, seconds: 0.001}}}\n");
  const auto late = worlds.gate({kOld, kNew, "--json"});
  CHECK(late.code == 1);
  const auto rule = only_rule(late);
  CHECK(rule["outcome"] == "not decidable");
  CHECK(has(rule["rerun"]["problem"], "the budget of 0.001 s was over with "));
  worlds.rules("undecided: passes\nmodels: {physics: {rerun: {runs: 100000, seconds: 0.001}}}\n");
  CHECK(worlds.gate({kOld, kNew}).code == 0);
}

TEST_CASE("two revisions of git are run from their own texts, and a folder's scenarios each") {
  const TwoWorlds worlds;
  worlds.rules("models: {physics: {rerun: {runs: 25, margin: 0.2}}, claim: forbidden}\n");
  fs::copy(worlds.folder() / "b", worlds.folder() / "a/other", fs::copy_options::recursive);
  worlds.commit("start");
  worlds.replace("a/world.yaml", "mass_kg: 0.3", "mass_kg: 30");
  worlds.replace("a/other/world.yaml", "mass_kg: 0.3", "mass_kg: 0.31");
  worlds.commit("take another box");
  const auto answer = worlds.gate({"HEAD^", "HEAD", "a"});
  CHECK_MESSAGE(answer.code == 1, answer.out);
  CHECK_MESSAGE(has(answer.out, "broken         scenario.yaml: models.physics"), answer.out);
  CHECK_MESSAGE(has(answer.out, "kept           other/scenario.yaml: models.physics"), answer.out);
  // Both rules share the error.
  CHECK_MESSAGE(has(answer.out, "McNemar's exact test, adjusted p"), answer.out);
  CHECK_FALSE(has(answer.out, "/tmp/"));
  CHECK(worlds.git({"status", "--porcelain"}).find(" M a/") == std::string::npos);
}

TEST_CASE("a command that a scenario names is started only where it is permitted") {
  const TwoWorlds worlds;
  worlds.rules("models: {physics: rerun}\n");
  for (const std::string tree : {"a", "b"}) {
    worlds.put(tree + "/scenario.yaml",
               worlds.read(tree + "/scenario.yaml") + "simulator: {command: [sh, sim.sh]}\n");
    worlds.put(tree + "/sim.sh", "echo " + tree + " >> started\nexit 1\n");
  }
  const auto answer = worlds.gate({"a", "b"});
  CHECK(answer.code == 1);
  CHECK_MESSAGE(has(answer.out, "the old side cannot be run: the scenario names the command"),
                answer.out);
  CHECK(has(answer.out, "--allow-commands"));
  CHECK_FALSE(worlds.lies("started"));
  const auto permitted = worlds.gate({"a", "b", "--allow-commands"});
  CHECK(permitted.code == 1);
  CHECK_MESSAGE(has(permitted.err, "starting `sh "), permitted.err);
  // The old side's program, which ends at once.
  CHECK(worlds.read("started").starts_with("a\n"));
  CHECK_MESSAGE(has(permitted.out, "not decidable  scenario.yaml: models.physics"), permitted.out);
}

TEST_CASE("run folders are run again from the texts that they kept") {
  const TwoWorlds worlds;
  worlds.rules("runs: {physics: {rerun: {runs: 25, margin: 0.2}}}\n");
  const auto run = [&](const std::string& out) {
    CHECK(worlds.parallax({"run", kOld, "--out", out, "--max-runs", "5"}).code != 2);
  };
  run("out/old");
  worlds.replace(kOldWorld, "mass_kg: 0.3", "mass_kg: 30");
  run("out/new");
  fs::remove_all(worlds.folder() / "a");
  const auto broken = worlds.gate({"out/old", "out/new"});
  CHECK_MESSAGE(broken.code == 1, broken.out);
  CHECK_MESSAGE(has(broken.out, "broken         runs.physics: " + std::string(kMass) + "30; 0 of"),
                broken.out);
  CHECK_FALSE(has(broken.out, "/tmp/"));
  CHECK(has(worlds.gate({"out/old", "out/old"}).out, "kept           runs.physics: none changed"));
  fs::remove(worlds.folder() / "out/old/inputs.json");
  const auto lost = worlds.gate({"out/old", "out/new"});
  CHECK_MESSAGE(has(lost.out, "not decidable  runs.physics: out/old kept no texts"), lost.out);
}

TEST_CASE("results of rates in two folders are compared in pairs") {
  const TwoWorlds worlds;
  worlds.rules("rates: {worse: {margin: 0.2}}\n");
  const auto rates = [&](const std::string& scenario, const std::string& file) {
    const auto result =
        worlds.parallax({"rates", scenario, "--runs", "25", "--outcomes", "--json"});
    CHECK(result.code == 0);
    worlds.put(file, result.out);
  };
  rates(kOld, "old/rates.json");
  worlds.put("old/other.json", "{}\n");
  worlds.replace("b/world.yaml", "mass_kg: 0.3", "mass_kg: 30");
  rates(kNew, "new/rates.json");
  const auto worse = worlds.gate({"old", "new"});
  CHECK_MESSAGE(worse.code == 1, worse.out);
  CHECK_MESSAGE(has(worse.out, "broken         rates.json: rates.worse"), worse.out);
  CHECK(has(worse.out, "of 25 pairs, 25 with equal starts, 25 fail anew"));
  CHECK(worlds.gate({"old", "old"}).code == 0);
  CHECK(has(worlds.gate({"a", "b"}).out, "neither folder has a result of `rates --json`"));
}

TEST_CASE("rules about runs are refused where they stand wrong, with the place they belong to") {
  const TwoWorlds worlds;
  const auto refused = [&](const std::string& rules, const std::string& why) {
    worlds.rules(rules);
    const auto answer = worlds.gate({kOld, kNew});
    CAPTURE(rules);
    CHECK(answer.code == 3);
    CHECK_MESSAGE(has(answer.err, why), answer.err);
  };
  refused("models: {physics: {rerun: {run: 3}}}\n", "runs");
  refused("models: {physics: {forbidden: 3}}\n", "rerun");
  refused("models: {physics: often}\n", "rerun");
  refused("models: {world: rerun}\n", "forbidden");
  refused("models: {physics: {rerun: {seconds: 0}}}\n", "above 0");
  refused("models: {lost_traces: forbidden}\nrates: {physics: forbidden}\n",
          "Move it below `models`.");
  refused("models: {lost_traces: forbidden}\nplans: {forms: forbidden, settings: forbidden}\n",
          "Move it below `models`.");
}

}  // namespace
}  // namespace parallax::test
