// `parallax coverage`: the items that recorded runs covered, compared with counts known beforehand
// and with those of the run's own report.

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "tests/tools/cli_json.h"
#include "tests/tools/coverage_shares.h"
#include "tests/tools/two_models.h"

namespace parallax::test {
namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

/// A plan with a handler, a retry and a condition, over a model whose drawer may stick. The world's
/// drawer does not, so that two of the three traces differ from it.
class CoveredRun : public TwoModels {
 public:
  CoveredRun() {
    write("two/cover.e",
          "load domain.e\n"
          "fluent Sticks()\n"
          "fluent Bent()\n"
          "noninertial Sticks\n"
          "[drawer,time] !HoldsAt(Sticks(),time) -> "
          "Initiates(OpenDrawer(drawer),Open(drawer),time).\n"
          "[drawer,time] HoldsAt(Open(drawer),time) -> Initiates(OpenDrawer(drawer),Bent(),time).\n"
          "[drawer,time] Happens(CloseDrawer(drawer),time) -> HoldsAt(Parked(),time).\n"
          "!HoldsAt(Bent(),0).\n");
    write("two/cover.lisp",
          "(def-cram-function tidy ()\n"
          "  (with-retry-counters ((again 1))\n"
          "    (with-failure-handling\n"
          "        ((manipulation-goal-not-reached (e)\n"
          "           (declare (ignore e))\n"
          "           (do-retry again (retry))\n"
          "           (return nil)))\n"
          "      (perform (an action (type opening) (object (an object (name top)))))))\n"
          "  (when (holds (list 'open 'top))\n"
          "    (perform (an action (type closing) (object (an object (name top))))))\n"
          "  (perform (an action (type parking-arms))))\n"
          "(tidy)\n");
    write("two/robot.bind", read("two/robot.bind") + "query open (?d) ok: Open(?d) @t\n");
    write("two/cover.yaml",
          "include: common.yaml\nmodel: [cover.e, start.e]\nplan: cover.lisp\nhorizon: 4\n"
          "simulator: {model: opens.e}\n");
  }
};

/// Simulations and traces, by "file:line id".
using Counts = std::map<std::string, std::pair<int, int>>;
Counts counts_of(const Json& group) {
  Counts out;
  for (const auto& item : group) {
    out[item.at("file").get<std::string>() + ":" + std::to_string(item.at("line").get<int>()) +
        " " + item.at("id").get<std::string>()] = {item.at("hits").get<int>(),
                                                   item.at("traces").get<int>()};
  }
  return out;
}

/// A tracefile, by the test's own reader: a record for each file, with the totals that it states.
struct LcovFile {
  std::map<int, int> lines;
  std::map<std::string, int> functions;
  std::map<std::tuple<int, int, int>, std::string> branches;
};
std::map<std::string, LcovFile> read_lcov(const std::string& text) {
  std::map<std::string, LcovFile> files;
  std::istringstream in(text);
  std::string line, name;
  std::map<std::string, int> counted;
  while (std::getline(in, line)) {
    auto& file = files[name];
    if (line == "end_of_record") {
      const auto hit = [](const auto& all) {
        return std::count_if(all.begin(), all.end(),
                             [](const auto& one) { return one.second > 0; });
      };
      CHECK(counted["LF"] == static_cast<int>(file.lines.size()));
      CHECK(counted["LH"] == hit(file.lines));
      CHECK(counted["FNF"] == static_cast<int>(file.functions.size()));
      CHECK(counted["FNH"] == hit(file.functions));
      CHECK(counted["BRF"] == static_cast<int>(file.branches.size()));
      CHECK(counted["BRH"] ==
            std::count_if(file.branches.begin(), file.branches.end(), [](const auto& branch) {
              return branch.second != "-" && branch.second != "0";
            }));
      name.clear();
      continue;
    }
    const auto colon = line.find(':');
    REQUIRE(colon != std::string::npos);
    const auto key = line.substr(0, colon), value = line.substr(colon + 1);
    std::vector<std::string> parts;
    std::istringstream fields(value);
    for (std::string part; std::getline(fields, part, ',');) parts.push_back(part);
    if (key == "SF") {
      name = value;
      CHECK_FALSE(files.contains(name));
      counted.clear();
    } else if (key == "DA") {
      REQUIRE(parts.size() == 2);
      CHECK(file.lines.emplace(std::stoi(parts[0]), std::stoi(parts[1])).second);
    } else if (key == "FN") {
      REQUIRE(parts.size() == 2);
      CHECK(file.lines.empty());
      CHECK(file.functions.emplace(parts[1], -1).second);
    } else if (key == "FNDA") {
      REQUIRE(parts.size() == 2);
      CHECK(file.functions.at(parts[1]) == -1);
      file.functions[parts[1]] = std::stoi(parts[0]);
    } else if (key == "BRDA") {
      REQUIRE(parts.size() == 4);
      CHECK(file.branches
                .emplace(std::tuple(std::stoi(parts[0]), std::stoi(parts[1]), std::stoi(parts[2])),
                         parts[3])
                .second);
    } else if (key != "TN") {
      CHECK((key == "LF" || key == "LH" || key == "FNF" || key == "FNH" || key == "BRF" ||
             key == "BRH"));
      counted[key] = std::stoi(value);
    }
  }
  files.erase("");
  return files;
}

TEST_CASE("the text of a long axiom is cut between two characters") {
  const CoveredRun cli;
  std::string text = "[drawer,time] HoldsAt(Open(drawer),time) -> ; ";
  text += std::string((99 - text.size()) % 2, '+');
  while (text.size() < 200) text += "\u00e9";  // one of them has the bytes 99 and 100
  cli.write("two/cover.e",
            cli.read("two/cover.e") + text + "\n  Initiates(OpenDrawer(drawer),Bent(),time).\n");
  CHECK(cli.parallax({"run", "two/cover.yaml", "--out", "out"}).code == 1);
  const auto coverage = json_of(cli, {"coverage", "out"});
  std::set<std::string> texts;
  for (const auto& item : coverage.at("axioms")) texts.insert(item.value("text", ""));
  CHECK(texts.contains(text.substr(0, 99) + "..."));
}

TEST_CASE("a run's report says how much of plan and model its simulations went through") {
  const CoveredRun cli;
  // It ends at the first trace, in which the drawer sticks twice.
  const auto report = json_of(cli, {"run", "two/cover.yaml", "--out", "out"}, 1);
  const auto coverage = json_of(cli, {"coverage", "out"});
  CHECK(report.at("coverage") == shares_of(coverage));
  CHECK(report.at("coverage").at("performs") == Json({{"covered", 2}, {"all", 3}}));
  CHECK(report.at("coverage").at("branches") == Json({{"covered", 3}, {"all", 8}}));
  CHECK(Json::parse(cli.read("out/report.json")).at("coverage") == report.at("coverage"));
  CHECK(cli.read("out/report.txt").find("  covered      2 of 3 performs, 3 of 8 branches, ") !=
        std::string::npos);
  const auto again = json_of(cli, {"run", "two/cover.yaml", "--out", "out", "--resume"}, 1);
  CHECK(again.at("coverage") == report.at("coverage"));
}

TEST_CASE("coverage of all traces: each item with the simulations and traces that go through it") {
  const CoveredRun cli;
  // Open, open, park (sticks twice); open, close, park; open, open, close, park.
  const auto report = json_of(cli, {"run", "two/cover.yaml", "--keep-going", "--out", "out"}, 1);
  const auto sims = [&](std::size_t trace) {
    return report.at("traces").at(trace).at("simulations").get<int>();
  };
  REQUIRE(report.at("traces").size() == 3);
  const int a = sims(0), b = sims(1), c = sims(2), all = a + b + c;
  REQUIRE(a > 0);
  REQUIRE(b > 0);
  REQUIRE(c > 0);
  const auto coverage = json_of(cli, {"coverage", "out", "--lcov", "out.info"});
  CHECK(coverage.at("status") == "ok");
  CHECK(coverage.at("simulations") == all);
  CHECK(coverage.at("all_traces") == true);
  CHECK(report.at("coverage") == shares_of(coverage));
  const std::string plan = "two/cover.lisp:", model = "two/cover.e:", domain = "two/domain.e:";
  CHECK(counts_of(coverage.at("performs")) == Counts{{plan + "8 OpenDrawer", {all, 3}},
                                                     {plan + "10 CloseDrawer", {b + c, 2}},
                                                     {plan + "11 Park", {all, 3}}});
  CHECK(counts_of(coverage.at("branches")) == Counts{{plan + "8 OpenDrawer succeeds", {b + c, 2}},
                                                     {plan + "8 OpenDrawer fails", {a + c, 2}},
                                                     {plan + "9 Open(top): true", {b + c, 2}},
                                                     {plan + "9 Open(top): false", {a, 1}},
                                                     {plan + "10 CloseDrawer succeeds", {b + c, 2}},
                                                     {plan + "10 CloseDrawer fails", {0, 0}},
                                                     {plan + "11 Park succeeds", {all, 3}},
                                                     {plan + "11 Park fails", {0, 0}}});
  CHECK(counts_of(coverage.at("handlers")) ==
        Counts{{plan + "4 manipulation-goal-not-reached", {a + c, 2}}});
  CHECK(counts_of(coverage.at("retries")) == Counts{{plan + "8 OpenDrawer again", {a + c, 2}}});
  CHECK(counts_of(coverage.at("events")) == Counts{{domain + "9 OpenDrawer", {all, 3}},
                                                   {domain + "10 CloseDrawer", {b + c, 2}},
                                                   {domain + "11 Park", {all, 3}},
                                                   {domain + "12 Reach", {0, 0}}});
  // The drawer is opened in every trace, but never while it is open.
  CHECK(counts_of(coverage.at("axioms")) == Counts{{domain + "14 terminates", {b + c, 2}},
                                                   {domain + "15 initiates", {all, 3}},
                                                   {domain + "16 terminates", {0, 0}},
                                                   {model + "5 initiates", {b + c, 2}},
                                                   {model + "6 initiates", {0, 0}},
                                                   {model + "7 precondition", {b + c, 2}}});
  CHECK(coverage.at("traces").size() == 3);

  // The tracefile says the same.
  auto files = read_lcov(cli.read("out.info"));
  CHECK(files.size() == 3);
  const auto& lisp = files.at("two/cover.lisp");
  CHECK(lisp.lines == std::map<int, int>{{4, a + c}, {8, all}, {9, b + c}, {10, b + c}, {11, all}});
  CHECK(lisp.functions == std::map<std::string, int>{{"manipulation-goal-not-reached", a + c}});
  CHECK(lisp.branches.size() == 8);
  CHECK(files.at("two/domain.e").functions.at("Reach") == 0);
  CHECK(files.at("two/cover.e").lines == std::map<int, int>{{5, b + c}, {6, 0}, {7, b + c}});
  const auto genhtml = run_process({"/usr/bin/env", "which", "genhtml"}, {});
  if (genhtml.code != 0) {
    MESSAGE("skipped: genhtml is not installed");
  } else {
    const auto page = run_process({"/usr/bin/env", "genhtml", "out.info", "-o", "page"},
                                  {cli.folder().string(), {}});
    CHECK_MESSAGE(page.code == 0, page.err);
  }
}

TEST_CASE("coverage: what was not simulated is told from what no trace does") {
  const CoveredRun cli;
  REQUIRE(cli.parallax({"run", "two/cover.yaml", "--out", "out"}).code == 1);
  const auto coverage = json_of(cli, {"coverage", "out"});
  CHECK(coverage.at("simulations") == 1);
  CHECK(counts_of(coverage.at("performs")).at("two/cover.lisp:10 CloseDrawer") == std::pair(0, 2));
  int hit = 0;
  for (const auto& trace : coverage.at("traces")) hit += trace.at("hits").get<int>() > 0 ? 1 : 0;
  CHECK(hit == 1);
  const auto text = cli.parallax({"coverage", "out"});
  CHECK(text.code == 0);
  CHECK(text.out.find("performs  2 of 3 simulated, 3 in traces; not simulated:\n"
                      "    two/cover.lisp:10  CloseDrawer  (in 2 of the model's traces)\n") !=
        std::string::npos);
  CHECK(text.out.find("(in no trace that was looked at)") != std::string::npos);
  CHECK(text.out.find("traces    1 of 3 simulated; not simulated:\n"
                      "    OpenDrawer(top);CloseDrawer(top);Park();\n") != std::string::npos);
  // Fewer traces are looked at, but all that were simulated.
  const auto one = json_of(cli, {"coverage", "out", "--limit", "1"});
  CHECK(one.at("all_traces") == false);
  CHECK(one.at("traces").size() == 1);

  // Several runs of one scenario add up; its traces count once.
  REQUIRE(cli.parallax({"run", "two/cover.yaml", "--out", "more", "--seed", "2"}).code == 1);
  const auto both = json_of(cli, {"coverage", "out", "more"});
  CHECK(both.at("runs") == 2);
  CHECK(both.at("simulations") == 2);
  CHECK(counts_of(both.at("performs")).at("two/cover.lisp:8 OpenDrawer") == std::pair(2, 3));
  // The same run twice, or a copy of it, is no more than once.
  fs::copy(cli.folder() / "out", cli.folder() / "copy");
  const auto twice = cli.parallax({"coverage", "out", "out", "copy"});
  CHECK(twice.code == 0);
  CHECK(twice.out.find("3 runs, 1 simulation\n") != std::string::npos);
  CHECK(twice.err.find("copy: 1 of its simulations count once") != std::string::npos);
  // The tracefile on the standard output, and nothing else.
  REQUIRE(cli.parallax({"coverage", "out", "--lcov", "out.info"}).code == 0);
  const auto standard = cli.parallax({"coverage", "out", "--lcov", "-"});
  CHECK(standard.code == 0);
  CHECK(standard.out == cli.read("out.info"));
  CHECK_FALSE(fs::exists(cli.folder() / "-"));
  CHECK(cli.parallax({"coverage", "out", "--lcov", "-", "--json"}).code == 2);
}

TEST_CASE("coverage: folders are held against their scenario as replay does it") {
  const CoveredRun cli;
  CHECK(cli.parallax({"coverage", "nowhere"}).code == 2);
  REQUIRE(cli.parallax({"run", "two/cover.yaml", "--out", "out"}).code == 1);
  // Never over a file that was read.
  const auto refused = cli.parallax({"coverage", "out", "--lcov", "two/cover.lisp"});
  CHECK(refused.code == 2);
  CHECK(refused.err.find("E0011") != std::string::npos);
  const auto journal = cli.read("out/journal.ndjson");
  cli.replace("out/journal.ndjson", "\"key\":\"OpenDrawer(top);", "\"key\":\"CloseDrawer(top);");
  const auto foreign = cli.parallax({"coverage", "out"});
  CHECK(foreign.code == 3);
  CHECK(foreign.err.find("E7103") != std::string::npos);
  cli.write("out/journal.ndjson", journal);
  cli.replace("out/journal.ndjson", "\"keep_going\":false",
              "\"execution\":\"closed-loop\",\"keep_going\":false");
  const auto closed = cli.parallax({"coverage", "out"});
  CHECK(closed.code == 3);
  CHECK(closed.err.find("error[E7103]") != std::string::npos);
  CHECK(closed.err.find("`path` is missing") != std::string::npos);
  cli.write("out/journal.ndjson", journal);
  CHECK(cli.parallax({"coverage", "out"}).code == 0);
  cli.write("two/opens.e", cli.read("two/opens.e") + "; changed\n");
  CHECK(cli.parallax({"coverage", "out"}).code == 0);  // of the texts that the run kept
  std::filesystem::remove(cli.folder() / "out/inputs.json");
  const auto changed = json_of(cli, {"coverage", "out"}, 3);
  CHECK(changed.at("diagnostics").at(0).at("code") == "E7113");
}

TEST_CASE("axioms count that apply from another initial state of a trace") {
  const CliFixture cli;
  cli.write("shut.e",
            "fluent Shut()\nfluent There()\nfluent Creaked()\nevent Go()\n"
            "!HoldsAt(There(),0).\n!HoldsAt(Creaked(),0).\n"
            "[time] Initiates(Go(),There(),time).\n"
            "[time] HoldsAt(Shut(),time) -> Initiates(Go(),Creaked(),time).\n");
  cli.write("go.lisp", "(perform (an action (type going)))\n");
  cli.write("go.bind", "action going -> Go() ok: There() @t+1 else plan-failure\n");
  cli.write("go.yaml",
            "model: shut.e\nsimulator: {model: shut.e}\nplan: go.lisp\nbind: go.bind\nhorizon: 1\n"
            "constraints: \"HoldsAt(There(),time)\"\n"
            "criterion: {kind: clean-runs, epsilon: 0.2}\n");
  const auto report = json_of(cli, {"run", "go.yaml", "--out", "out"});
  const auto coverage = json_of(cli, {"coverage", "out"});
  const int runs = coverage.at("simulations");
  const auto& axioms = coverage.at("axioms");
  REQUIRE(axioms.size() == 2);
  CHECK(axioms.at(0).at("hits") == runs);
  // Both initial states were simulated about as often.
  const int creaked = axioms.at(1).at("hits");
  CHECK(creaked > runs / 3);
  CHECK(creaked < runs);
  CHECK(report.at("coverage") == shares_of(coverage));

  // From the first state alone nothing creaks.
  cli.write("first.yaml", "include: go.yaml\ninitial: first\n");
  json_of(cli, {"run", "first.yaml", "--out", "first"});
  CHECK(json_of(cli, {"coverage", "first"}).at("axioms").at(1).at("hits") == 0);
}

}  // namespace
}  // namespace parallax::test
