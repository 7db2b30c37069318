// The plan itself is executed, in worlds that are models: answers known beforehand.

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "tests/tools/cli_json.h"
#include "tests/tools/executed_plan.h"

namespace parallax::test {
namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

/// Opens the drawer; if that fails, once more.
const std::string kRetry = R"((def-cram-function open-it ()
  (with-retry-counters ((tries 1))
    (with-failure-handling ((manipulation-low-level-failure (e) (do-retry tries (retry))))
      (perform (an action (type opening) (object (an object (name top))))))))
(open-it)
)";

TEST_CASE("two models that agree: the executed plan is clean, with the same bytes for any jobs") {
  const TwoModels cli;
  const std::vector<std::string> run = {"run",         "two/agree.yaml", "--execution",
                                        "closed-loop", "--out",          "out"};
  const auto report = json_of(cli, run);
  CHECK(report.at("execution") == "closed-loop");
  CHECK(report.at("verdict") == "no-discrepancy");
  const auto& stream = report.at("traces").at(0);
  CHECK(stream.at("initial_states") == 1);
  CHECK(stream.at("certified").at("epsilon") <= 0.05);
  CHECK(stream.at("claim").get<std::string>().find("fewer than 5 % of executions of the plan") !=
        std::string::npos);
  REQUIRE(stream.at("paths").size() == 1);
  const auto& path = stream.at("paths").at(0);
  CHECK(path.at("events") == Json({"OpenDrawer(top)", "CloseDrawer(top)", "Park()"}));
  CHECK(path.at("outcomes") == Json({"ok", "ok", "ok"}));
  CHECK(path.at("end") == "done");
  CHECK(path.at("simulations") == stream.at("simulations"));
  const auto journal = cli.read("out/journal.ndjson");
  const auto account = cli.read("out/report.txt");
  CHECK(std::count(journal.begin(), journal.end(), '\n') == 91);
  fs::rename(cli.folder() / "out", cli.folder() / "first");
  auto more = run;
  more.insert(more.end(), {"--jobs", "3"});
  json_of(cli, more);
  CHECK(cli.read("out/journal.ndjson") == journal);
  CHECK(cli.read("out/report.txt") == account);
  CHECK(cli.read("out/report.json") == cli.read("first/report.json"));
  CHECK(cli.parallax({"replay", "first", "--sample", "1.7"}).code == 0);

  // A run that was ended half-way gives the same.
  fs::create_directory(cli.folder() / "half");
  cli.write("half/journal.ndjson", journal.substr(0, journal.find('\n', journal.size() / 2) + 1));
  auto resume = run;
  resume.back() = "half";
  resume.emplace_back("--resume");
  CHECK(json_of(cli, resume).at("verdict") == "no-discrepancy");
  CHECK(cli.read("half/journal.ndjson") == journal);
  // Not in another way of execution.
  CHECK(cli.parallax({"run", "two/agree.yaml", "--out", "half", "--resume"}).code == 3);
}

TEST_CASE("a forgotten effect is found in the first execution, with event, place and fluent") {
  const TwoModels cli;
  const auto report =
      json_of(cli, {"run", "two/unparks.yaml", "--execution", "closed-loop", "--out", "out"}, 1);
  CHECK(report.at("simulations") == 1);
  const auto& found = report.at("discrepancies").at(0);
  const Json forgotten = {
      {"fluent", "Parked()"}, {"timepoint", 1}, {"predicted", true}, {"observed", false}};
  CHECK(found.at("first") == Json::array({forgotten}));
  CHECK(found.at("kind") == "transient");
  CHECK(found.at("repeated") == "bit-equal");
  CHECK(found.at("cause").at("text") == "OpenDrawer(top): not Parked()");
  CHECK(found.at("differs") ==
        Json({{"event", 0}, {"impossible", false}, {"outcome", false}, {"together", false}}));
  CHECK(cli.read("out/report.txt")
            .find("has no such state after event 0, OpenDrawer(top) (two/open_and_close.lisp:4)") !=
        std::string::npos);
  CHECK(cli.parallax({"replay", "out"}).code == 0);
  // Last states only: there it is parked again.
  CHECK(
      json_of(cli, {"run", "two/unparks.yaml", "--execution", "closed-loop", "--compare", "final"})
          .at("verdict") == "no-discrepancy");
}

TEST_CASE("with --keep-going every cause is found once, and counted") {
  const TwoModels cli;
  // The drawer sticks every other time, and jams every other time that it is open.
  const auto scenario =
      executed(cli, "load opens.e\n", cli.read("two/open_and_close.lisp"), "load opens.e\n");
  cli.write(
      "two/world.e",
      "sort drawer\ndrawer top\nfluent Open(drawer)\nfluent Parked()\nevent OpenDrawer(drawer)\n"
      "event CloseDrawer(drawer)\nevent Park()\nevent Reach()\nfluent Sticks()\n"
      "fluent Jams()\nnoninertial Sticks, Jams\n"
      "[drawer,time] !HoldsAt(Sticks(),time) ->\n"
      "  Initiates(OpenDrawer(drawer),Open(drawer),time).\n"
      "[drawer,time] !HoldsAt(Jams(),time) ->\n"
      "  Terminates(CloseDrawer(drawer),Open(drawer),time).\n"
      "[time] Initiates(Park(),Parked(),time).\n");
  const std::vector<std::string> run = {"run", scenario, "--keep-going", "--out", "out"};
  const auto report = json_of(cli, run, 1);
  const auto& stream = report.at("traces").at(0);
  CHECK(stream.at("simulations") == 90);
  REQUIRE(stream.at("causes").size() == 2);
  REQUIRE(report.at("discrepancies").size() == 2);
  std::int64_t differing = 0;
  for (const auto& cause : stream.at("causes")) {
    const auto count = cause.at("count").get<std::int64_t>();
    differing += count;
    const bool opens = cause.at("cause") == "OpenDrawer(top): fails";
    CHECK((opens || cause.at("cause") == "CloseDrawer(top): fails"));
    // Binomial(90, 1/2) and (90, 1/4): beyond with probability below 1e-6 each.
    CHECK(count >= (opens ? 22 : 4));
    CHECK(count <= (opens ? 68 : 44));
    CHECK(cause.at("rate").get<double>() == doctest::Approx(static_cast<double>(count) / 90.0));
    CHECK(cause.at("lower") < cause.at("rate"));
    CHECK(cause.at("upper") > cause.at("rate"));
    // The cause's first simulation is the one that is reported in full.
    const auto& found = report.at("discrepancies");
    CHECK(std::any_of(found.begin(), found.end(), [&](const Json& one) {
      return one.at("cause").at("text") == cause.at("cause") &&
             one.at("sample") == cause.at("example") && one.at("repeated") == "bit-equal";
    }));
  }
  CHECK(stream.at("clean") == 90 - differing);
  CHECK(cli.read("out/report.txt").find("% interval") != std::string::npos);
  const auto journal = cli.read("out/journal.ndjson");
  const auto account = cli.read("out/report.json");
  fs::rename(cli.folder() / "out", cli.folder() / "first");
  auto more = run;
  more.insert(more.end(), {"--jobs", "3"});
  json_of(cli, more, 1);
  CHECK(cli.read("out/journal.ndjson") == journal);
  CHECK(cli.read("out/report.json") == account);
  for (const auto& found : report.at("discrepancies")) {
    CHECK(cli.parallax({"replay", "first", "--sample",
                        "1." + std::to_string(found.at("sample").get<int>())})
              .code == 0);
  }
  // Ended half-way and continued.
  cli.write("out/journal.ndjson", journal.substr(0, journal.find('\n', journal.size() / 2) + 1));
  more.emplace_back("--resume");
  json_of(cli, more, 1);
  CHECK(cli.read("out/journal.ndjson") == journal);
  CHECK(cli.read("out/report.json") == account);
}

TEST_CASE("an event that nobody performed and nothing demands excuses no difference") {
  const TwoModels cli;
  const std::string bump = "event Bump()\n";
  cli.write("two/opens_u.e",
            "load opens.e\n" + bump + "[time] Terminates(Bump(),Parked(),time).\n");
  cli.write("two/unparks_u.e", "load unparks.e\n" + bump);
  cli.write("two/bump.yaml",
            "include: common.yaml\nmodel: [opens_u.e, start.e]\n"
            "simulator: {model: unparks_u.e}\n");
  const auto report =
      json_of(cli, {"run", "two/bump.yaml", "--execution", "closed-loop", "--out", "out"}, 1);
  CHECK(report.at("simulations") == 1);
  CHECK(report.at("discrepancies").at(0).at("cause").at("text") == "OpenDrawer(top): not Parked()");
  // An event that an axiom demands happens together with the performed one.
  const std::string slam =
      "event Slam()\n[time] Happens(Park(),time) -> Happens(Slam(),time).\n"
      "[drawer,time] Terminates(Slam(),Open(drawer),time).\n";
  cli.write("two/opens_u.e", "load opens.e\n" + slam);
  cli.write("two/bump.yaml",
            "include: common.yaml\nmodel: [opens_u.e, start.e]\n"
            "simulator: {model: opens_u.e}\n");
  json_of(cli, {"run", "two/bump.yaml", "--execution", "closed-loop", "--out", "demanded"});
}

TEST_CASE("check says what a run in closed loop would, and asks for no constraints") {
  const TwoModels cli;
  const std::string scenario =
      "model: [opens.e, start.e]\nplan: open_and_close.lisp\nbind: robot.bind\nhorizon: 3\n"
      "execution: closed-loop\nsimulator: {model: opens.e}\n";
  cli.write("two/own.yaml", scenario);
  CHECK(cli.parallax({"check", "two/own.yaml", "--no-lint"}).code == 0);
  CHECK(cli.parallax({"run", "two/own.yaml", "--out", "out"}).code == 0);
  // Errors that both commands report for a scenario that cannot be run.
  const std::pair<std::string, std::string> wrong[] = {
      {"criterion: paper\n", "error[E7125]"},
      {"mapping: {Open(d): ignored}\n", "error[E7124]"},
      {"start_weights: {when: \"HoldsAt(Parked(),0) | !HoldsAt(Parked(),0)\", weight: 0}\n",
       "error[E5109]"},
  };
  for (const auto& [more, code] : wrong) {
    cli.write("two/own.yaml", scenario + more);
    const auto checked = cli.parallax({"check", "two/own.yaml", "--no-lint"});
    const auto run = cli.parallax({"run", "two/own.yaml"});
    CAPTURE(more);
    CAPTURE(checked.err);
    CHECK(checked.code != 0);
    CHECK(checked.err.find(code) != std::string::npos);
    CHECK(run.err.find(code) != std::string::npos);
  }
}

TEST_CASE("a plan that performs nothing is told of") {
  const TwoModels cli;
  const auto scenario = executed(cli, "load opens.e\n", "(def-cram-function idle () nil)\n(idle)\n",
                                 "load opens.e\n");
  const auto report = json_of(cli, {"run", scenario});
  const auto& caveats = report.at("traces").at(0).at("caveats");
  CHECK(std::count(caveats.begin(), caveats.end(),
                   "the plan performs nothing: initial states alone were compared") == 1);
  cli.write("log.jsonl", "{\"t\": 0, \"state\": {\"Parked()\": true}}\n");
  const auto monitored = cli.parallax({"monitor", scenario, "log.jsonl"});
  CHECK(monitored.code == 0);
  CHECK(monitored.err.find("the plan performs nothing") == 0);
}

TEST_CASE("a retry that succeeds only in the world") {
  const TwoModels cli;
  const auto scenario =
      executed(cli, kSticks, kRetry, kSticksAtTimes, "mapping: {Sticks(): ignored}\n");
  const auto report = json_of(cli, {"run", scenario, "--out", "out"}, 1);
  const auto& found = report.at("discrepancies").at(0);
  // The drawer that stuck once sticks for ever in the model: a second try that goes well is no path
  // of it, one that fails again is.
  CHECK(found.at("differs") ==
        Json({{"event", 1}, {"impossible", false}, {"outcome", true}, {"together", false}}));
  CHECK(found.at("cause").at("text") == "OpenDrawer(top): succeeds");
  CHECK(found.at("path").at(0).at("outcome") == "failed");
  CHECK(found.at("path").at(0).at("condition") == "manipulation-goal-not-reached");
  CHECK(found.at("path").at(1).at("outcome") == "ok");
  const Json opened = {
      {"fluent", "Open(top)"}, {"timepoint", 2}, {"predicted", false}, {"observed", true}};
  CHECK(found.at("first") == Json::array({opened}));
  for (const auto& path : report.at("traces").at(0).at("paths")) {
    const auto& outcomes = path.at("outcomes");
    const bool is_found = outcomes == Json({"manipulation-goal-not-reached", "ok"});
    CHECK((is_found || outcomes == Json({"ok"}) || path.at("end") == "failed"));
  }
  CHECK(cli.parallax({"replay", "out"}).code == 0);
}

TEST_CASE("a handler that never runs leaves the runs clean") {
  const TwoModels cli;
  const auto scenario =
      executed(cli, kSticks, kRetry, "load opens.e\n", "mapping: {Sticks(): ignored}\n");
  const auto report = json_of(cli, {"run", scenario});
  CHECK(report.at("verdict") == "no-discrepancy");
  const auto& paths = report.at("traces").at(0).at("paths");
  REQUIRE(paths.size() == 1);
  CHECK(paths.at(0).at("outcomes") == Json({"ok"}));
}

const std::string kCups = R"(sort thing
sort kind
thing cup1, cup2
kind mug
predicate Kind(thing,kind)
fluent Near(thing)
fluent Held(thing)
event Detect(kind)
event Take(thing)
[thing,kind] Kind(thing,kind).
[thing,time] HoldsAt(Near(thing),time) -> Initiates(Take(thing),Held(thing),time).
[thing] HoldsAt(Near(thing),0).
[thing] !HoldsAt(Held(thing),0).
)";

const std::string kTakeOne = R"((def-cram-function take-one ()
  (let ((?cup (perform (an action (type detecting) (object (an object (type mug)))))))
    (perform (an action (type taking) (object ?cup)))))
(take-one)
)";

const std::string kCupBinding =
    "action detecting (:object type ?y) -> Detect(?y) ok: {thing} Kind(thing,?y) & Near(thing) @t\n"
    "  returns thing else perception-object-not-found\n"
    "action taking (:object ?o) -> Take(?o) ok: Held(?o) @t+1 else gripper-goal-not-reached\n";

TEST_CASE("a detection may return another object than the model's first") {
  const TwoModels cli;
  cli.write("two/cups.e", kCups);
  cli.write("two/take.lisp", kTakeOne);
  cli.write("two/cups.bind", kCupBinding);
  cli.write("two/cups.yaml",
            "model: cups.e\nplan: take.lisp\nbind: cups.bind\nhorizon: 2\n"
            "simulator: {model: cups.e}\nexecution: closed-loop\n");
  const auto report = json_of(cli, {"run", "two/cups.yaml"});
  CHECK(report.at("verdict") == "no-discrepancy");
  std::set<Json> events;
  for (const auto& path : report.at("traces").at(0).at("paths")) events.insert(path.at("events"));
  CHECK(events == std::set<Json>{Json({"Detect(mug)=cup1", "Take(cup1)"}),
                                 Json({"Detect(mug)=cup2", "Take(cup2)"})});
  // Where the world lets it be seen, though the model says that it is hidden.
  cli.write("two/hidden.e", kCups +
                                "fluent Hidden(thing)\nHoldsAt(Hidden(cup2),0).\n"
                                "!HoldsAt(Hidden(cup1),0).\n");
  cli.write("two/cups.bind",
            "action detecting (:object type ?y) -> Detect(?y)\n"
            "  ok: {thing} Kind(thing,?y) & Near(thing) & !Hidden(thing) @t\n"
            "  returns thing else perception-object-not-found\n"
            "action taking (:object ?o) -> Take(?o) ok: Held(?o) @t+1 else plan-failure\n");
  cli.write("two/hidden.yaml",
            "include: cups.yaml\nmodel: hidden.e\nmapping: {Hidden(thing): ignored}\n");
  const auto unseen = cli.parallax({"run", "two/hidden.yaml"});
  CHECK(unseen.code == 3);
  CHECK(unseen.err.find("error[E7124]") != std::string::npos);
  CHECK(unseen.err.find("`Hidden(cup1)` is not observed") != std::string::npos);
}

TEST_CASE("each reason of a failure raises its condition; one that is bound to none is an error") {
  const TwoModels cli;
  const std::string forbids =
      "load opens.e\n[time] Happens(Park(),time) -> !HoldsAt(Parked(),time).\n";
  const std::string plan = R"((def-cram-function park-it ()
  (with-failure-handling
      ((navigation-low-level-failure (e)
         (perform (an action (type reaching)))
         (perform (an action (type parking-arms)))
         (return)))
    (perform (an action (type parking-arms)))))
(park-it)
)";
  const auto scenario = executed(cli, "load opens.e\n", plan, forbids);
  const std::string bound = "else manipulation-goal-not-reached\naction reaching";
  cli.replace("two/robot.bind", bound,
              "else manipulation-goal-not-reached\n  on not-posible navigation-pose-unreachable\n"
              "action reaching");
  const auto unbound = cli.parallax({"run", scenario});
  CHECK(unbound.code == 3);
  CHECK(unbound.err.find("two/robot.bind:7:1-20: error[E7120]: `Park()` failed for the reason "
                         "`not-possible`, to which this entry binds no condition") !=
        std::string::npos);
  CHECK(unbound.err.find("the nearest reason that is bound: `not-posible`") != std::string::npos);
  CHECK(unbound.err.find("two/plan.lisp:7") != std::string::npos);
  // The world carries it out and the formula of success does not hold: the word for it is `failed`.
  const auto unparks =
      executed(cli, "load opens.e\n", plan,
               "sort drawer\ndrawer top\nfluent Open(drawer)\nfluent Parked()\n"
               "event OpenDrawer(drawer)\nevent CloseDrawer(drawer)\nevent Park()\n"
               "event Reach()\n[time] Terminates(Park(),Parked(),time).\n");
  const auto unparked = cli.parallax({"run", unparks});
  CHECK(unparked.code == 3);
  CHECK(unparked.err.find("failed for the reason `failed`") != std::string::npos);
  executed(cli, "load opens.e\n", plan, forbids);

  cli.replace("two/robot.bind", "not-posible", "not-possible");
  const auto report = json_of(cli, {"run", scenario}, 1);
  const auto& path = report.at("discrepancies").at(0).at("path");
  REQUIRE(path.size() == 3);
  CHECK(path.at(0).at("condition") == "navigation-pose-unreachable");
  CHECK(path.at(1).at("event") == "Reach()");
  CHECK(path.at(2).at("outcome") == "ok");
  CHECK(report.at("discrepancies").at(0).at("differs").at("event") == 0);
  CHECK(report.at("discrepancies").at(0).at("cause").at("text") == "Park(): not-possible");
  // Where the model knows the failure as well, the handler's way is one of its own.
  cli.write("two/model.e", forbids);
  CHECK(
      json_of(cli, {"run", scenario}, 1).at("discrepancies").at(0).at("differs").at("impossible") ==
      true);
}

TEST_CASE("an endless plan is bounded by performs and by simulated time, and no success") {
  const TwoModels cli;
  const std::string plan = R"((def-cram-function for-ever ()
  (loop do (perform (an action (type opening) (object (an object (name top)))))
           (perform (an action (type closing) (object (an object (name top)))))))
(for-ever)
)";
  const auto scenario =
      executed(cli, "load opens.e\n", plan, "load opens.e\n", "limits: {max_performs: 7}\n");
  const auto report = json_of(cli, {"run", scenario}, 4);
  CHECK(report.at("verdict") == "inconclusive");
  const auto& stream = report.at("traces").at(0);
  CHECK(stream.at("unfinished") == 1);
  CHECK(stream.at("simulations") == 1);
  CHECK(stream.at("paths").at(0).at("events").size() == 7);
  CHECK(stream.at("paths").at(0).at("end") == "perform-limit");
  CHECK(stream.at("claim") == "nothing is claimed: an execution did not end");
  CHECK(stream.at("caveats").at(0) ==
        "the plan had not ended after 7 performs (limits: max_performs)");
  // A timepoint of such a world counts as a second.
  cli.replace("two/own.yaml", "max_performs: 7", "max_simulated_s: 4");
  const auto timed = json_of(cli, {"run", scenario}, 4);
  CHECK(timed.at("traces").at(0).at("paths").at(0).at("events").size() == 4);
  CHECK(timed.at("traces").at(0).at("paths").at(0).at("end") == "time-limit");
}

TEST_CASE("executions begin in every initial state, and guards ask what is observed") {
  const TwoModels cli;
  const std::string plan = R"((def-cram-function park-if-needed ()
  (unless (holds '(parked)) (perform (an action (type parking-arms))))
  (perform (an action (type opening) (object (an object (name top))))))
(park-if-needed)
)";
  const auto scenario = executed(cli, "load opens.e\n", plan, "load opens.e\n",
                                 "mapping: {Parked(): {flag: \"Parked()\", drawn: true}}\n");
  cli.write("two/start.e", "[drawer] !HoldsAt(Open(drawer),0).\n");
  const auto report = json_of(cli, {"run", scenario});
  const auto& stream = report.at("traces").at(0);
  CHECK(stream.at("initial_states") == 2);
  REQUIRE(stream.at("paths").size() == 2);
  std::set<std::size_t> lengths;
  for (const auto& path : stream.at("paths")) {
    lengths.insert(path.at("events").size());
    // Binomial(n, 1/2) with n of 90 or so: below 20 with probability under 1e-7.
    CHECK(path.at("simulations") > 20);
  }
  CHECK(lengths == std::set<std::size_t>{1, 2});
  // A question that no observation answers is refused before anything is simulated.
  cli.replace("two/own.yaml", "{flag: \"Parked()\", drawn: true}", "ignored");
  const auto unseen = cli.parallax({"run", scenario});
  CHECK(unseen.code == 3);
  CHECK(unseen.err.find("error[E7124]") != std::string::npos);
  CHECK(unseen.err.find("two/plan.lisp:2") != std::string::npos);
}

TEST_CASE("what closed loop has no use for is refused") {
  const TwoModels cli;
  const auto refused = [&](std::vector<std::string> options, int code, const std::string& text) {
    std::vector<std::string> words = {"run", "two/agree.yaml", "--execution", "closed-loop"};
    words.insert(words.end(), options.begin(), options.end());
    const auto result = cli.parallax(words);
    CAPTURE(result.err);
    CHECK(result.code == code);
    CHECK(result.err.find(text) != std::string::npos);
  };
  refused({"--criterion", "paper"}, 2, "E7125");
  refused({"--split-initial"}, 2, "executions begin in every initial state; leave it out");
  refused({"--match", "trace"}, 2, "--match=trace");
  refused({"--hits", "all"}, 2, "lasts until the plan ends; leave it out, or simulate traces");
  cli.write("two/strict.yaml", "include: agree.yaml\nmatch: trace\nexecution: closed-loop\n");
  const auto strict = cli.parallax({"run", "two/strict.yaml"});
  CHECK(strict.code == 2);
  CHECK(strict.err.find("match: trace") != std::string::npos);
  cli.write("two/bare.yaml",
            "model: [opens.e, start.e]\nhorizon: 3\nsimulator: {model: opens.e}\n"
            "constraints: \"Happens(Park(),time-1)\"\nexecution: closed-loop\n");
  const auto bare = cli.parallax({"run", "two/bare.yaml"});
  CHECK(bare.code == 3);
  CHECK(bare.err.find("two/bare.yaml:5:12-22: error[E7123]") != std::string::npos);
  // A perform that the world cannot carry out.
  cli.write("two/lacks.e",
            "fluent Parked()\nevent Park()\n[time] Initiates(Park(),Parked(),time).\n");
  cli.write("two/lacks.yaml",
            "include: agree.yaml\nsimulator: {model: lacks.e}\nmapping: {Open(drawer): ignored}\n");
  const auto lacks = cli.parallax({"run", "two/lacks.yaml", "--execution", "closed-loop"});
  CHECK(lacks.code == 3);
  CHECK(lacks.err.find("E5135") != std::string::npos);
  CHECK_FALSE(fs::exists(cli.folder() / "out"));
}

}  // namespace
}  // namespace parallax::test
