// `suite --mutate`: known mistakes that a suite does not notice, as real processes.

#include <doctest/doctest.h>

#include <csignal>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <set>
#include <string>
#include <utility>

#include "tests/tools/cli_json.h"
#include "tests/tools/suite/suite_fixture.h"

namespace parallax::test {
namespace {

using Json = nlohmann::json;

/// The outcomes by "LINE KIND", in the order of the list.
std::multimap<std::string, std::string> outcomes(const Json& score, const std::string& file) {
  std::multimap<std::string, std::string> out;
  for (const auto& mutant : score["mutants"]) {
    if (mutant["file"] != file) continue;
    out.emplace(std::to_string(mutant["line"].get<int>()) + ' ' + mutant["kind"].get<std::string>(),
                mutant["outcome"].get<std::string>());
  }
  return out;
}

using Expected = std::multimap<std::string, std::string>;

/// One case that counts traces, and one where `golden` keeps them.
void write_cases(const CliFixture& cli, bool golden) {
  cli.write("s/suite.yaml", std::string("cases:\n  - id: count\n    model: lamp.e\n") +
                                "    expect: {traces: 2}\n" +
                                (golden ? "  - id: list\n    model: lamp.e\n"
                                          "    expect: {golden: list.txt}\n"
                                        : ""));
  if (golden) REQUIRE(cli.parallax({"suite", "s", "--update-goldens"}).code == 0);
}

TEST_CASE("what a number of traces does not tell, and a list of them does") {
  const SuiteFixture cli;
  write_cases(cli, false);
  const auto counted = json_of(cli, {"suite", "s", "--mutate"}, 1);
  CHECK(counted["cases"] == 1);
  CHECK(outcomes(counted, "s/lamp.e") == Expected{{"4 axiom dropped", "unnoticed"},
                                                  {"4 sign flipped", "unnoticed"},
                                                  {"5 axiom dropped", "noticed"},
                                                  {"5 fact negated", "unnoticed"}});
  CHECK(counted["observable"] == 4);
  CHECK(counted["noticed"] == 1);
  CHECK(counted["score"] == 0.25);
  // The trace that tells: pressed, and lit afterwards.
  const auto& witness = counted["mutants"][0]["witness"];
  CHECK(witness["of"] == "original");
  CHECK(witness["case"] == "s/suite.yaml:count");
  CHECK(witness["timepoints"][0]["happens"] == Json{"Press()"});
  CHECK(witness["timepoints"][1]["holds"] == Json{"On()"});
  // Nothing is claimed of what may be undetermined.
  CHECK_FALSE(witness.contains("predicates"));
  CHECK_FALSE(witness["timepoints"][1].contains("released"));

  write_cases(cli, true);
  const auto listed = json_of(cli, {"suite", "s", "--mutate"}, 0);
  CHECK(listed["score"] == 1.0);
  std::map<std::string, int> by;
  for (const auto& mutant : listed["mutants"]) ++by[mutant["noticed_by"].get<std::string>()];
  CHECK(by == std::map<std::string, int>{{"s/suite.yaml:count", 1}, {"s/suite.yaml:list", 3}});
}

TEST_CASE("mutants with the same traces are proved equivalent, up to the horizon of the cases") {
  const SuiteFixture cli;
  write_cases(cli, true);
  // Pressing a lamp that is on changes nothing, and at horizon 1 no lamp is on before it is
  // pressed.
  cli.write("s/lamp.e",
            std::string(kLamp) + "[time] HoldsAt(On(),time) -> Initiates(Press(),On(),time).\n");
  const auto score = json_of(cli, {"suite", "s", "--mutate"}, 0);
  const auto found = outcomes(score, "s/lamp.e");
  CHECK(found.count("6 axiom dropped") == 1);
  for (const auto& [what, outcome] : found) {
    if (what.starts_with("6 ")) CHECK_MESSAGE(outcome == "equivalent", what);
  }
  // At the next timepoint a second press would switch it off.
  cli.replace("s/lamp.e", "time 0 1", "time 0 2");
  cli.replace("s/suite.yaml", "traces: 2", "traces: 4");
  REQUIRE(cli.parallax({"suite", "s", "--update-goldens"}).code == 0);
  const auto longer = outcomes(json_of(cli, {"suite", "s", "--mutate"}, 0), "s/lamp.e");
  CHECK(longer.find("6 sign flipped")->second == "noticed");
  CHECK(longer.find("6 axiom dropped")->second == "equivalent");
}

TEST_CASE("what does not compile is invalid, and no credit") {
  const SuiteFixture cli;
  cli.write("s/lamp.e",
            "range time 0 1\nsort lamp\nlamp A, B\nsort room\nroom R, S\n"
            "function In(lamp): room\nIn(A)=R.\nIn(B)=S.\n"
            "fluent On(lamp)\nevent Press(room)\n"
            "[lamp,room,time] room=In(lamp) -> Initiates(Press(room),On(lamp),time).\n"
            "[lamp] !HoldsAt(On(lamp),0).\n");
  cli.write("s/suite.yaml", "cases: [{id: all, model: lamp.e, expect: {traces: 4}}]\n");
  const auto score = json_of(cli, {"suite", "s", "--mutate"}, 1);
  const auto found = outcomes(score, "s/lamp.e");
  CHECK(found.find("7 axiom dropped")->second == "invalid");
  CHECK(score["invalid"].get<int>() >= 2);
  for (const auto& mutant : score["mutants"]) {
    if (mutant["outcome"] == "invalid") CHECK(!mutant["why"].get<std::string>().empty());
  }
}

/// Two models that load a third one from the folder above, each with a case of its own.
void write_two_models(const CliFixture& cli) {
  cli.write("s/lamp.e",
            "range time 0 1\nfluent On()\nevent Press()\nevent Hit()\n"
            "[time] Initiates(Press(),On(),time).\n[time] !Happens(Hit(),time).\n");
  fs::create_directories(cli.folder() / "s/more");
  cli.write("s/more/off.e", "load ../lamp.e\n!HoldsAt(On(),0).\n");
  cli.write("s/more/on.e", "load ../lamp.e\nHoldsAt(On(),0).\n");
  cli.write("s/suite.yaml",
            "cases:\n"
            "  - {id: off, model: more/off.e, expect: {traces: 2, golden: off.txt}}\n"
            "  - {id: on, model: more/on.e, expect: {traces: 2}}\n");
  REQUIRE(cli.parallax({"suite", "s", "--update-goldens"}).code == 0);
}

TEST_CASE("only cases that read a file are asked about its mutants, through any loads") {
  const SuiteFixture cli;
  write_two_models(cli);
  const auto score = json_of(cli, {"suite", "s", "--mutate"}, 1);
  for (const auto& mutant : score["mutants"]) {
    const auto by = mutant.value("noticed_by", "");
    if (mutant["file"] == "s/more/on.e") CHECK(by != "s/suite.yaml:off");
    if (mutant["file"] == "s/more/off.e") CHECK(by != "s/suite.yaml:on");
  }
  // The lamp that is on stays on: only the case that begins in the dark can tell.
  const auto shared = outcomes(score, "s/lamp.e");
  CHECK(shared.find("5 axiom dropped")->second == "noticed");
  CHECK(outcomes(score, "s/more/on.e").find("2 fact negated")->second == "unnoticed");
  // A case alone, of a manifest whose other cases name other files.
  const auto alone = json_of(cli, {"suite", "s", "--mutate", "--only", ":on"}, 1);
  CHECK(alone["cases"] == 1);
  CHECK(outcomes(alone, "s/more/off.e").empty());
  // A name picks files.
  const auto part = json_of(cli, {"suite", "s", "--mutate", "--mutants-of", "on.e"}, 1);
  CHECK(part["made"] == 2);
}

TEST_CASE("what is read where it lies, not from the copy, is not mutated, and that is said") {
  const SuiteFixture cli;
  fs::create_directories(cli.folder() / "t");
  cli.write("t/all.e",
            "load " + (cli.folder() / "s/lamp.e").string() + "\n[time] !Happens(Press(),time).\n");
  cli.write("t/suite.yaml", "cases: [{id: all, model: all.e, expect: {traces: 1}}]\n");
  const auto score = json_of(cli, {"suite", "t", "--mutate", "--allow-outside"}, 1);
  CHECK(score["made"] == 2);
  REQUIRE(score["passed_over"].size() == 1);
  CHECK(holds(score["passed_over"][0], "lamp.e"));
}

TEST_CASE("mutants of a plan: dropped, exchanged, given other arguments") {
  const SuiteFixture cli;  // with a copy of two_regions
  cli.write("plans.yaml",
            "cases: [{id: fetch, model: scenario.yaml, expect: {traces: 1, golden: fetch.txt}}]\n");
  REQUIRE(cli.parallax({"suite", "plans.yaml", "--update-goldens"}).code == 0);
  const auto score =
      json_of(cli, {"suite", "plans.yaml", "--mutate", "--mutants-of", "fetch.lisp"}, 0);
  std::set<std::string> kinds;
  for (const auto& mutant : score["mutants"]) {
    kinds.insert(mutant["kind"]);
    if (mutant["kind"] == "perform dropped") CHECK(mutant["outcome"] == "noticed");
    CHECK(mutant["words"].get<std::string>().find("fetch.lisp:") != std::string::npos);
  }
  CHECK(kinds.contains("perform dropped"));
  CHECK(kinds.contains("performs exchanged"));
  CHECK(score["noticed"].get<int>() >= 7);
}

TEST_CASE("the answer does not depend on the number of jobs, and no file is written") {
  const SuiteFixture cli;
  write_two_models(cli);
  const auto before = files_below(cli.folder() / "s");
  const auto one = cli.parallax({"suite", "s", "--mutate", "--json", "--jobs", "1"});
  const auto three = cli.parallax({"suite", "s", "--mutate", "--json", "--jobs", "3"});
  CHECK(one.code == 1);
  CHECK(one.out == three.out);
  const auto text = cli.parallax({"suite", "s", "--mutate"});
  CHECK(text.out == cli.parallax({"suite", "s", "--mutate", "--jobs", "2"}).out);
  CHECK(holds(text.out, "s/more/on.e:2: unnoticed, fact negated: "));
  CHECK(files_below(cli.folder() / "s") == before);
  // A part of them, spread evenly.
  const auto part = json_of(cli, {"suite", "s", "--mutate", "--at-most", "3"}, 0);
  CHECK(part["looked_at"] == 3);
  CHECK(part["made"].get<int>() > 3);
  CHECK(part["mutants"][0] == Json::parse(one.out)["mutants"][0]);
}

TEST_CASE("killed at any moment it leaves the suite as it was, and what was judged can be used") {
  const SuiteFixture cli;
  write_two_models(cli);
  fs::create_directories(cli.folder() / "tmp");
  const auto before = files_below(cli.folder() / "s");
  const auto command = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words = {"/usr/bin/env",
                                      "TMPDIR=" + (cli.folder() / "tmp").string(),
                                      std::string(PARALLAX_BINARY_DIR) + "/parallax",
                                      "suite",
                                      "s",
                                      "--mutate",
                                      "--json"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  };
  ProcessOptions options;
  options.folder = cli.folder().string();
  const auto whole = run_process(command({"--out", "whole"}), options);
  CHECK(whole.code == 1);
  CHECK(fs::is_empty(cli.folder() / "tmp"));
  std::mt19937 random(5);
  int ended = 0;
  for (int i = 0; i < 6; ++i) {
    const int with = i % 2 == 0 ? SIGKILL : SIGTERM;
    auto looks = 5 + random() % 40;
    auto killing = options;
    killing.signal_when = [&looks, with] { return looks-- == 0 ? with : 0; };
    std::vector<std::string> more = {"--out", "out"};
    if (fs::exists(cli.folder() / "out/mutants.ndjson")) more.emplace_back("--resume");
    const auto result = run_process(command(more), killing);
    ended += result.code == 128 + with ? 1 : 0;
    if (with == SIGTERM) CHECK(result.code != 128 + SIGKILL);
    CHECK(files_below(cli.folder() / "s") == before);
  }
  CHECK(ended >= 1);
  std::vector<std::string> more = {"--out", "out"};
  if (fs::exists(cli.folder() / "out/mutants.ndjson")) more.emplace_back("--resume");
  const auto last = run_process(command(more), options);
  CHECK(last.out == whole.out);
}

TEST_CASE("a suite that does not pass is not scored") {
  const SuiteFixture cli;
  cli.write("s/suite.yaml",
            "cases: [{id: a, model: lamp.e, expect: {traces: 2}},"
            " {id: b, model: lamp.e, expect: {traces: 3}}]\n");
  const auto result = cli.parallax({"suite", "s", "--mutate"});
  CHECK(result.code == 1);
  CHECK(holds(result.out, "FAIL  s/suite.yaml:b"));
  CHECK(holds(result.out, "1 of 2 cases do not pass"));
  const auto json = json_of(cli, {"suite", "s", "--mutate"}, 1);
  CHECK(json["suite_passes"] == false);
  CHECK(json["not_passed"].size() == 1);
}

TEST_CASE("options that make no sense together, and files of somebody else, are refused") {
  const SuiteFixture cli;
  write_cases(cli, true);
  const auto refused = [&](std::vector<std::string> more, const std::string& why) {
    more.insert(more.begin(), {"suite", "s"});
    const auto result = cli.parallax(std::move(more));
    CAPTURE(result.err);
    CHECK(result.code == 2);
    CHECK_MESSAGE(holds(result.err, why), why);
  };
  refused({"--mutate", "--junit", "a.xml"}, "--junit");
  refused({"--mutate", "--shard", "1/2"}, "--shard");
  refused({"--mutate", "--update-goldens"}, "--update-goldens");
  refused({"--mutate", "--retry", "2"}, "--retry");
  refused({"--mutate", "--history", "h.ndjson"}, "--history");
  refused({"--mutate", "--ledger", "l.yaml"}, "--ledger");
  refused({"--mutate", "--rerun-failed"}, "--rerun-failed");
  refused({"--mutate", "--verify-cache", "5%"}, "--verify-cache");
  refused({"--at-most", "3"}, "--mutate");
  refused({"--at-least", "90%"}, "--mutate");
  refused({"--mutate", "--at-least", "101%"}, "no share");
  refused({"--mutate", "--mutants-of", "nowhere.e"}, "nowhere.e");
  refused({"--mutate", "--resume", "--out", "fresh"}, "no mutants were judged");
  REQUIRE(cli.parallax({"suite", "s", "--mutate", "--out", "o"}).code == 0);
  REQUIRE(cli.parallax({"suite", "s", "--mutate", "--out", "o", "--resume"}).code == 0);
  cli.replace("s/lamp.e", "[time] Init", "[time]  Init");
  refused({"--mutate", "--resume", "--out", "o"}, "--resume: that were mutants of other files");
  cli.write("o/mutants.ndjson", "mine\n");
  refused({"--mutate", "--out", "o"}, "was not written by --mutate");
  CHECK(cli.read("o/mutants.ndjson") == "mine\n");
}

TEST_CASE("--at-least says what is enough") {
  const SuiteFixture cli;
  write_cases(cli, false);
  CHECK(cli.parallax({"suite", "s", "--mutate", "--at-least", "25%"}).code == 0);
  CHECK(cli.parallax({"suite", "s", "--mutate", "--at-least", "26%"}).code == 1);
}

}  // namespace
}  // namespace parallax::test
