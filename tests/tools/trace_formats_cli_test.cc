// `parallax traces --format ...`: the formats from outside, and how they mark a list that was
// stopped.

#include <doctest/doctest.h>
#include <signal.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/support/csv_reader.h"
#include "tests/support/itf_reader.h"
#include "tests/tools/cli_fixture.h"

namespace parallax::test {
namespace {

using Json = nlohmann::json;

constexpr const char* kLamps =
    "range time 0 2\nsort lamp\nlamp A,B\nfluent On(lamp)\nevent Press(lamp)\n"
    "[lamp,time] Initiates(Press(lamp),On(lamp),time).\n[lamp] !HoldsAt(On(lamp),0).\n";

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

TEST_CASE("every format says complete when the list is, and stopped when a limit ended it") {
  const CliFixture cli;
  cli.write("m.e", kLamps);
  const auto run = [&](const std::string& format, const std::string& limit) {
    const auto result = cli.parallax({"traces", "m.e", "--format", format, "--limit", limit});
    CHECK(result.code == 0);
    CHECK(result.err == "");
    return lines_of(result.out);
  };
  CHECK(run("text", "0").back() == "16 traces, complete (no proof)");
  CHECK(run("text", "3").back() == "3 traces, stopped");
  CHECK(run("text", "16").back() == "16 traces, complete (no proof)");
  CHECK(run("csv", "0").back() == "# complete (no proof): 16 traces,,,,,\r");
  CHECK(run("csv", "3").back() == "# stopped: 3 traces,,,,,\r");
  CHECK(run("decreasoner", "0").back() == "16 models (no proof)");
  CHECK(run("decreasoner", "3").back() == "3 models, stopped");
  for (const auto* format : {"jsonl", "itf"}) {
    const auto whole = Json::parse(run(format, "0").back());
    CHECK(whole["complete"] == true);
    CHECK(whole["exploration"] == "complete");
    CHECK(whole["proof"] == "none");
    CHECK(whole["traces"] == 16);
    const auto part = Json::parse(run(format, "3").back());
    CHECK(part["complete"] == false);
    CHECK(part["exploration"] == "stopped");
    CHECK(part["traces"] == 3);
    CHECK(part["model"] == whole["model"]);
  }
}

/// More traces than any test waits for; blocking clauses list them slowly.
constexpr const char* kEndless =
    "range time 0 9\nsort k\nk A,B,C\nfluent F(k)\nevent E(k)\n"
    "[k,time] Initiates(E(k),F(k),time).\n";

void check_stopped(const ProcessResult& result) {
  CHECK(result.err.find("stopped before the end") != std::string::npos);
  CHECK(result.out.find("\"complete\":true") == std::string::npos);
  // On a machine so busy that the list had not begun there is nothing to mark.
  if (result.out.empty()) return;
  CHECK(lines_of(result.out).back().find("stopped") != std::string::npos);
}

TEST_CASE("an interrupt in the middle of a list leaves whole traces and the mark") {
  for (const auto* format : {"text", "jsonl", "itf", "csv", "decreasoner"}) {
    CAPTURE(format);
    const CliFixture cli;
    cli.write("m.e", kEndless);
    int looks = 0;
    ProcessOptions options;
    options.signal_when = [&] { return ++looks == 200 ? SIGINT : 0; };
    const auto result = cli.parallax(
        {"traces", "m.e", "--limit", "0", "--strategy", "blocking", "--format", format}, options);
    CHECK(result.code == 130);
    check_stopped(result);
  }
}

TEST_CASE("a time limit in the middle of a list: exit code 4 and the mark") {
  const CliFixture cli;
  cli.write("m.e", kEndless);
  for (const auto* format : {"text", "jsonl", "itf", "csv", "decreasoner"}) {
    CAPTURE(format);
    const auto result = cli.parallax({"traces", "m.e", "--limit", "0", "--strategy", "blocking",
                                      "--format", format, "--time-limit", "0.8"});
    CHECK(result.code == 4);
    check_stopped(result);
  }
}

TEST_CASE("one trace of ITF is a file, which says how the list ended and where events come from") {
  const CliFixture cli;
  cli.write("m.e", std::string(kLamps) +
                       "Happens(Press(B),1).\n!Happens(Press(A),0).\n"
                       "!Happens(Press(A),1).\n!Happens(Press(B),0).\n");
  const auto result = cli.parallax({"traces", "m.e", "--format", "itf", "--limit", "1"});
  CHECK(result.code == 0);
  const ItfFile file(result.out);
  CHECK(file.meta["complete"] == true);
  CHECK(file.meta["source"] == "m.e");
  CHECK(file.meta["format"] == "ITF");
  REQUIRE(file.states.size() == 3);
  CHECK(file.states[0].at("mbt::actionTaken") == "init");
  CHECK(file.states[1].at("mbt::actionTaken") == "");
  CHECK(file.states[2].at("mbt::actionTaken") == "Press(B)");
  const auto event = file.state_meta[2]["events"][0];
  CHECK(event == Json{{"event", "Press"}, {"arguments", {"B"}}, {"file", "m.e"}, {"line", 5}});
  const auto again = cli.parallax({"traces", "m.e", "--format", "itf", "--limit", "1"});
  CHECK(again.out == result.out);
}

TEST_CASE("events of a plan name the line of the plan") {
  const CliFixture cli;
  const auto result = cli.parallax({"traces", "scenario.yaml", "--format", "itf", "--limit", "1"});
  CHECK(result.code == 0);
  const ItfFile file(result.out);
  const std::string source = file.state_meta.at(1)["events"][0]["file"];
  CHECK(source.ends_with(".lisp"));
}

TEST_CASE("a folder of ITF files has an index that is right at every moment") {
  const CliFixture cli;
  cli.write("m.e", kLamps);
  const std::vector<std::string> command = {"traces",  "m.e", "--format", "itf",
                                            "--limit", "5",   "--output", "out/itf"};
  const auto result = cli.parallax(command);
  CHECK(result.code == 0);
  CHECK(result.out == "5 traces, stopped, in out/itf\n");
  const auto index = Json::parse(cli.read("out/itf/index.json"));
  CHECK(index["traces"] == 5);
  CHECK(index["complete"] == false);
  CHECK(ItfFile(cli.read("out/itf/trace_000005.itf.json")).meta["trace"] == 5);
  CHECK(files_below(cli.folder() / "out/itf").size() == 6);
  const auto again = cli.parallax(command);
  CHECK(again.code == 2);
  CHECK(again.err.find("not empty") != std::string::npos);
  const auto nowhere = cli.parallax({"traces", "m.e", "--format", "itf", "--output", "m.e/x"});
  CHECK(nowhere.code == 2);
  CHECK(nowhere.err.find("E0005") != std::string::npos);
  CHECK(nowhere.out.find("complete") == std::string::npos);
  CHECK(cli.parallax({"traces", "m.e", "--output", "x"}).code == 2);
}

TEST_CASE("a CSV file has a row for each trace and timepoint") {
  const CliFixture cli;
  cli.write("m.e", kLamps);
  const auto records = read_csv(cli.parallax({"traces", "m.e", "--format", "csv"}).out);
  CHECK(records.size() == 1 + 10 * 3 + 1);
  CHECK(records[0] ==
        std::vector<std::string>{"trace", "time", "On(A)", "On(B)", "Press(A)", "Press(B)"});
  CHECK(records[1] == std::vector<std::string>{"1", "0", "0", "0", "0", "0"});
  CHECK(records[3] == std::vector<std::string>{"1", "2", "0", "0", "", ""});
}

TEST_CASE("the old printed form obeys the options of the model, and needs its texts") {
  const CliFixture cli;
  cli.write("m.e", std::string("option showpred off\n") + kLamps + "Happens(Press(A),0).\n" +
                       "completion Happens\n");
  const auto result =
      cli.parallax({"traces", "m.e", "--format", "decreasoner", "--compat", "decreasoner"});
  CHECK(result.out ==
        "---\nmodel 1:\n0\nHappens(Press(A), 0).\n1\n+On(A).\n2\n---\n1 model (no proof)\n");
  cli.write("none.e", "range time 0 1\nfluent F()\nHoldsAt(F(),0).\n!HoldsAt(F(),0).\n");
  CHECK(cli.parallax({"traces", "none.e", "--format", "decreasoner"}).out ==
        "no models found (no proof)\n");
  CHECK(cli.parallax({"compile", "m.e", "-o", "m.dec.cnf"}).code == 0);
  CHECK(cli.parallax({"traces", "m.dec.cnf", "--format", "decreasoner"}).code == 2);
  CHECK(cli.parallax({"traces", "m.dec.cnf", "--format", "csv"}).code == 0);
}

/// At least one lamp is old; which one, no trace tells.
const std::string kOldLamps = std::string(kLamps) + "predicate Old(lamp)\nOld(A) | Old(B).\n";

/// Lists of predicates, those that are true and those that are open, of each trace.
std::vector<std::pair<Json, Json>> predicates(const CliFixture& cli,
                                              std::vector<std::string> words) {
  words.insert(words.begin(), {"traces", "m.e"});
  words.insert(words.end(), {"--format", "jsonl"});
  const auto result = cli.parallax(words);
  CHECK_MESSAGE(result.code == 0, result.err);
  std::vector<std::pair<Json, Json>> out;
  for (const auto& line : lines_of(result.out)) {
    const auto trace = Json::parse(line);
    if (!trace.contains("summary")) {
      out.emplace_back(trace["predicates"], trace.value("undetermined", Json()));
    }
  }
  return out;
}

TEST_CASE("predicates that a trace leaves open are undetermined, whichever strategy finds it") {
  const CliFixture cli;
  cli.write("m.e", kOldLamps);
  for (const auto* format : {"text", "jsonl", "itf", "csv", "decreasoner"}) {
    const auto list = [&](const std::string& strategy) {
      return without_timing(cli.parallax({"traces", "m.e", "--limit", "0", "--distinct",
                                          "observable", "--format", format, "--strategy", strategy})
                                .out);
    };
    const auto first = list("tree");
    CHECK(lines_of(first).size() >= 16);
    for (const auto* strategy : {"auto", "search", "components", "guarded", "blocking"}) {
      CAPTURE(std::string(format) + ' ' + strategy);
      CHECK(list(strategy) == first);
    }
  }
  const Json both = {"Old(A)", "Old(B)"};
  for (const auto& [known, open] : predicates(cli, {"--limit", "3"})) {
    CHECK(known == Json::array());
    CHECK(open == both);
  }
  const auto all = predicates(cli, {"--distinct", "all", "--limit", "0"});
  CHECK(all.size() == 3 * 16);
  for (const auto& [known, open] : all) CHECK(open == Json());
}

TEST_CASE("what ends a trace, and what is least of all, may settle an open predicate") {
  const CliFixture cli;
  cli.write("m.e", kOldLamps);
  const Json none, both = {"Old(A)", "Old(B)"}, first = {"Old(A)"}, second = {"Old(B)"};
  for (const std::string hits : {"first", "all"}) {
    for (const auto& [known, open] :
         predicates(cli, {"--until", "HoldsAt(On(A),time)", "--limit", "0", "--hits", hits})) {
      CHECK(known == Json::array());
      CHECK(open == both);
    }
    for (const auto& [known, open] : predicates(
             cli, {"--until", "HoldsAt(On(A),time) & Old(A)", "--limit", "0", "--hits", hits})) {
      CHECK(known == first);
      CHECK(open == second);
    }
  }
  for (const std::string limit : {"1", "0"}) {
    const auto best = predicates(cli, {"--minimize", "sum 1: Old(A)", "--limit", limit});
    CHECK(best.size() >= 1);
    for (const auto& [known, open] : best) {
      CHECK(known == second);
      CHECK(open == none);
    }
    for (const auto& [known, open] :
         predicates(cli, {"--minimize", "count Old(lamp)", "--limit", limit})) {
      CHECK(known == Json::array());
      CHECK(open == both);
    }
  }
}

TEST_CASE("a violation's trace says of a predicate what the violation settles") {
  const CliFixture cli;
  cli.write("m.e", kOldLamps);
  const auto violation = [&](const std::string& property) {
    const auto result = cli.parallax({"verify", "m.e", "--property", property, "--json"});
    CHECK(result.code == 1);
    return Json::parse(result.out).at("trace");
  };
  const auto dark = violation("!HoldsAt(On(A),time)");
  CHECK(dark.at("predicates") == Json::array());
  CHECK(dark.at("undetermined") == Json({"Old(A)", "Old(B)"}));
  const auto old = violation("!(HoldsAt(On(A),time) & Old(A))");
  CHECK(old.at("predicates") == Json({"Old(A)"}));
  CHECK(old.at("undetermined") == Json({"Old(B)"}));
}

TEST_CASE("an undetermined atom is claimed by no replay, in either format") {
  const CliFixture cli;
  cli.write("m.e", kOldLamps + "fluent Warm()\n[lamp,time] Releases(Press(lamp),Warm(),time).\n");
  for (const auto* format : {"jsonl", "itf"}) {
    const auto list =
        cli.parallax({"traces", "m.e", "--limit", "5", "--format", format, "--strategy", "search"});
    cli.write("list", list.out);
    const auto replayed =
        Json::parse(cli.parallax({"traces", "m.e", "--replay", "list", "--json"}).out);
    CHECK(replayed["agree"] == 5);
    for (const auto& trace : replayed["list"]) CHECK(trace["hidden"] >= 2);
  }
}

}  // namespace
}  // namespace parallax::test
