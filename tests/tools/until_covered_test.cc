// Runs that go on until everything was seen: the items looked for, the end of the run, and the
// claims about items that were not shown, against answers known beforehand; the same bytes however
// the runs are made.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>

#include "tests/tools/cli_json.h"
#include "tests/tools/executed_plan.h"

namespace parallax::test {
namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

std::set<std::string> names(const Json& items) {
  std::set<std::string> out;
  for (const auto& item : items) {
    out.insert(item.at("place").get<std::string>() + " " + item.at("what").get<std::string>());
  }
  return out;
}

const Json& cover_of(const Json& report) { return report.at("traces").at(0).at("until_covered"); }

/// Drawn executions after which each of that many items is rarer than 5 %, with 99 % in all of
/// them.
int needed(int items) {
  return static_cast<int>(std::ceil(std::log(0.01 / items) / std::log(0.95)));
}

/// The text in one line.
std::string in_one_line(const std::string& text) {
  std::string out;
  std::istringstream in(text);
  std::string word;
  while (in >> word) out += word + " ";
  return out;
}

TEST_CASE("until covered: all that the model has is shown, and the run ends with the criterion") {
  const ExecutedRuns cli;
  const auto report = json_of(cli, {"run", cli.scenario(kSticksAtTimes, kPlan, kSticksAtTimes),
                                    "--until-covered", "--out", "out"});
  const auto& cover = cover_of(report);
  CHECK(cover.at("end") == "all shown");
  CHECK(cover.at("left").empty());
  // Both ways of two conditions, a handler, a retry; parking and closing succeed, opening may fail.
  CHECK(cover.at("items") == 10);
  CHECK(cover.at("shown") == 10);
  CHECK(report.at("simulations") == 90);
  CHECK(names(cover.at("impossible")) ==
        std::set<std::string>{"two/plan.lisp:2 Park() fails",
                              "two/plan.lisp:8 CloseDrawer(top) fails"});
  const auto text = in_one_line(cli.read("out/report.txt"));
  CHECK(text.find("shown all of 10 behaviours of plan and model") != std::string::npos);
  CHECK(text.find("impossible two/plan.lisp:2 Park() fails") != std::string::npos);
  // Without the option, the report has no `until_covered`.
  const auto plain = json_of(cli, {"run", "two/own.yaml", "--out", "plain"});
  CHECK_FALSE(plain.at("traces").at(0).contains("until_covered"));
  // The run's report agrees with its folder.
  const auto coverage = json_of(cli, {"coverage", "out"});
  for (const auto* group : {"performs", "handlers", "retries"}) {
    for (const auto& item : coverage.at(group)) CHECK(item.at("hits") > 0);
  }
  CHECK(coverage.at("never_shown").empty());
}

TEST_CASE("until covered: what the world never shows ends the run once it is rare") {
  const ExecutedRuns cli;
  const auto scenario = cli.scenario(kSticksAtTimes, kPlan, "load opens.e\n");
  const std::vector<std::string> run = {"run", scenario, "--until-covered", "--out", "out"};
  const auto report = json_of(cli, run);
  const auto& cover = cover_of(report);
  CHECK(report.at("verdict") == "no-discrepancy");
  CHECK(cover.at("end") == "rarer than epsilon");
  CHECK(names(cover.at("left")) ==
        std::set<std::string>{"two/plan.lisp:5 handler of manipulation-low-level-failure",
                              "two/plan.lisp:6 OpenDrawer again",
                              "two/plan.lisp:6 OpenDrawer(top) fails",
                              "two/plan.lisp:7 Open(top): false"});
  // The bound is of ten things that were fixed beforehand, whatever became of the others.
  CHECK(cover.at("executions") == needed(10));
  CHECK(report.at("simulations") == needed(10));
  CHECK(cover.at("confidence") == 0.99);
  const double bound = cover.at("bound");
  CHECK(bound <= 0.05);
  CHECK(std::pow(1.0 - bound, needed(10)) == doctest::Approx(0.001));
  CHECK(report.at("traces").at(0).at("claim").get<std::string>().find("135 clean runs of 135") !=
        std::string::npos);
  const auto text =
      in_one_line(cli.parallax({"run", scenario, "--until-covered", "--out", "text"}).out);
  CHECK(text.find("6 of 10 behaviours of plan and model") != std::string::npos);
  CHECK(text.find("two/plan.lisp:6 OpenDrawer(top) fails") != std::string::npos);

  // The same bytes for any number of workers and for a run that was ended half-way.
  const auto journal = cli.read("out/journal.ndjson");
  auto more = run;
  more.back() = "jobs";
  more.insert(more.end(), {"--jobs", "3"});
  json_of(cli, more);
  CHECK(cli.read("jobs/journal.ndjson") == journal);
  auto cut = journal.find('\n');
  for (int i = 0; i < 100; ++i) cut = journal.find('\n', cut + 1);
  fs::create_directory(cli.folder() / "half");
  cli.write("half/journal.ndjson", journal.substr(0, cut + 1));
  auto resume = run;
  resume.back() = "half";
  resume.emplace_back("--resume");
  auto resumed = json_of(cli, resume);
  CHECK(cli.read("half/journal.ndjson") == journal);
  CHECK(cover_of(resumed) == cover);
  // A run of another kind is another run.
  CHECK(cli.parallax({"run", scenario, "--out", "half", "--resume"}).code == 3);
}

TEST_CASE("until covered: a limit ends it, and what is left is said with its bound") {
  const ExecutedRuns cli;
  const auto scenario =
      cli.scenario(kSticksAtTimes, kPlan, "load opens.e\n", "until_covered: true\n");
  const auto report = json_of(cli, {"run", scenario, "--max-runs", "100", "--out", "out"}, 4);
  const auto& cover = cover_of(report);
  CHECK(report.at("verdict") == "inconclusive");
  CHECK(report.at("simulations") == 100);
  CHECK(cover.at("end") == "max_runs");
  CHECK(cover.at("left").size() == 4);
  CHECK(std::pow(1.0 - cover.at("bound").get<double>(), 100) == doctest::Approx(0.001));
  // The claim about the starts is not affected.
  CHECK(report.at("traces").at(0).at("claim").get<std::string>().find("fewer than 5 %") !=
        std::string::npos);
  CHECK(in_one_line(cli.read("out/report.txt")).find("max_runs came before that was 5 %") !=
        std::string::npos);
}

TEST_CASE("until covered: a discrepancy does not end it, and does not spoil the rates") {
  const ExecutedRuns cli;
  // Behind a failure the model's drawer never opens; the world's does every other time.
  const std::string stuck =
      "load domain.e\nfluent Sticks()\n"
      "[drawer,time] !HoldsAt(Sticks(),time) -> "
      "Initiates(OpenDrawer(drawer),Open(drawer),time).\n";
  const auto scenario = cli.scenario(stuck, kPlan, kSticksAtTimes);
  const auto report = json_of(cli, {"run", scenario, "--until-covered", "--out", "out"}, 1);
  const auto& stream = report.at("traces").at(0);
  CHECK(report.at("verdict") == "discrepancy");
  CHECK(cover_of(report).at("end") == "all shown");
  CHECK(report.at("exploration") == "all shown");
  REQUIRE(stream.at("causes").size() == 1);
  CHECK(stream.at("causes_runs") == 90);
  const auto kept = json_of(cli, {"run", scenario, "--keep-going", "--out", "kept"}, 1);
  CHECK(kept.at("traces").at(0).at("causes") == stream.at("causes"));
}

TEST_CASE("until covered: rates are counted in as many runs as the criterion plans") {
  const ExecutedRuns cli;
  // Opening takes the arm out of its place, which the model forgets, and never fails, which it may.
  const auto scenario = cli.scenario(kSticksAtTimes, kPlan, "load unparks.e\n");
  const auto report = json_of(cli, {"run", scenario, "--until-covered", "--out", "out"}, 1);
  const auto& stream = report.at("traces").at(0);
  CHECK(cover_of(report).at("end") == "rarer than epsilon");
  CHECK(report.at("simulations") == needed(10));
  CHECK(stream.at("causes_runs") == 90);
  REQUIRE(stream.at("causes").size() == 1);
  CHECK(stream.at("causes").at(0).at("cause") == "OpenDrawer(top): not Parked()");
  CHECK(stream.at("causes").at(0).at("count") == 90);
  CHECK(stream.at("caveats").dump().find("first 90 executions with a drawn start") !=
        std::string::npos);
}

TEST_CASE("until covered: guided starts show what drawn ones hardly do; bounds are of drawn ones") {
  CliFixture cli;
  cli.write("lamps.e",
            "sort lamp\nlamp a, b, c, d, e, f, g, h\nfluent On(lamp)\nfluent Parked()\n"
            "event Park()\n[time] Initiates(Park(),Parked(),time).\n!HoldsAt(Parked(),0).\n");
  std::string guards, ends;
  for (const char lamp : std::string("abcdefgh")) {
    guards += std::string("  (when (holds (list 'on '") + lamp + "))\n";
    ends += ")";
  }
  cli.write("lamps.lisp", "(def-cram-function look ()\n" + guards +
                              "  (perform (an action (type parking-arms)))" + ends + ")\n(look)\n");
  cli.write("lamps.bind",
            "action parking-arms -> Park() ok: Parked() @t+1 else plan-failure\n"
            "query on (?l) ok: On(?l) @t\n");
  cli.write("lamps.yaml",
            "model: lamps.e\nplan: lamps.lisp\nbind: lamps.bind\nhorizon: 2\n"
            "execution: closed-loop\nsimulator: {model: lamps.e}\nuntil_covered: true\n"
            "mapping: {On(l): {flag: \"On({l})\", drawn: true}}\n");
  const auto guided = json_of(cli, {"run", "lamps.yaml", "--starts", "guided", "--out", "guided"});
  CHECK(cover_of(guided).at("end") == "all shown");
  CHECK(cover_of(guided).at("items") == 17);  // both ways of eight conditions, and parking
  CHECK(cover_of(guided).at("executions") == 90);
  CHECK(guided.at("simulations").get<int>() ==
        90 + guided.at("traces").at(0).at("chosen_starts").get<int>());
  // Drawn ones show it in one of 256: here they do not, and it is rarer than 5 %.
  const auto most = std::to_string(needed(17));
  const auto uniform =
      json_of(cli, {"run", "lamps.yaml", "--out", "uniform", "--max-runs", most}, 4);
  CHECK(cover_of(uniform).at("end") == "rarer than epsilon");
  CHECK(cover_of(uniform).at("executions") == needed(17));
  // With the usual limit of runs the state is visited, which shows it.
  const auto visited = json_of(cli, {"run", "lamps.yaml", "--out", "visited"});
  CHECK(cover_of(visited).at("end") == "all shown");
  CHECK(cover_of(visited).at("executions") == needed(17));
  // Where it is to be rarer than one in 500 more is seen.
  const auto rarer = json_of(cli, {"run", "lamps.yaml", "--epsilon", "0.002", "--out", "rarer"});
  CHECK(cover_of(rarer).at("end") == "all shown");
}

TEST_CASE("until covered: events that an axiom demands are looked for, too") {
  const ExecutedRuns cli;
  const std::string slams =
      "load opens.e\nevent Slam()\nfluent Loose()\n"
      "[time] Happens(CloseDrawer(top),time) & HoldsAt(Loose(),time) -> Happens(Slam(),time).\n"
      "[time] Happens(Slam(),time) -> Happens(CloseDrawer(top),time).\n"
      "[time] Terminates(Slam(),Parked(),time).\n";
  auto scenario =
      cli.scenario(slams, kPlan, slams, "actions: {Slam(): {controller: \"Slam()\"}}\n");
  cli.replace("two/own.yaml", "Sticks(): ignored, ", "Loose(): {flag: \"Loose()\", drawn: true}, ");
  const auto both = json_of(cli, {"run", scenario, "--until-covered", "--out", "both"});
  CHECK(cover_of(both).at("end") == "all shown");
  // A world in which it is never loose.
  cli.write("two/world.e", slams + "!HoldsAt(Loose(),0).\n");
  cli.replace("two/own.yaml", "Loose(): {flag: \"Loose()\", drawn: true}, ", "Loose(): ignored, ");
  const auto never = json_of(cli, {"run", scenario, "--until-covered", "--out", "never"});
  CHECK(cover_of(never).at("end") == "rarer than epsilon");
  CHECK(names(cover_of(never).at("left")) == std::set<std::string>{"two/model.e:2 Slam happens"});
}

TEST_CASE("until covered, open loop: every trace is simulated, whatever the first ones give") {
  const TwoModels cli;
  cli.write("two/any.e", "load opens.e\n");
  cli.write("two/shut.e", "[drawer] !HoldsAt(Open(drawer),0).\n");
  cli.write("two/own.yaml",
            "include: common.yaml\nsimulator: {model: unparks.e}\nmodel: [any.e, shut.e]\n"
            "plan: plan.lisp\nhorizon: 2\nconstraints: \"Happens(OpenDrawer(top),time-1)\"\n");
  cli.write("two/plan.lisp",
            "(def-cram-function act ()\n"
            "  (unless (holds '(parked)) (perform (an action (type parking-arms))))\n"
            "  (perform (an action (type opening) (object (an object (name top))))))\n(act)\n");
  const auto first = json_of(cli, {"run", "two/own.yaml", "--out", "first"}, 1);
  CHECK(first.at("iterations") == 1);
  const auto all = json_of(cli, {"run", "two/own.yaml", "--until-covered", "--out", "all"}, 1);
  CHECK(all.at("iterations") == 2);
  CHECK(all.at("exploration") == "all traces explored");
  const auto coverage = json_of(cli, {"coverage", "all"});
  for (const auto& trace : coverage.at("traces")) CHECK(trace.at("hits") > 0);
}

}  // namespace
}  // namespace parallax::test
