// `parallax repair` over the plan, in worlds that are models, so that the remedy is known.

#include <doctest/doctest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/tools/cli_fixture.h"
#include "tests/tools/cli_json.h"

namespace parallax::test {
namespace {

using Json = nlohmann::json;

const std::string kDeclared =
    "sort drawer\ndrawer top, low\n"
    "fluent Open(drawer)\nfluent Parked()\nfluent Arrived()\nfluent Lit()\n"
    "event OpenDrawer(drawer)\nevent CloseDrawer(drawer)\nevent Park()\nevent Reach()\n"
    "event Go()\n";
const std::string kClose = "[drawer,time] Terminates(CloseDrawer(drawer),Open(drawer),time).\n";
const std::string kPark = "[time] Initiates(Park(),Parked(),time).\n";
const std::string kReach = "[time] Terminates(Reach(),Parked(),time).\n";
const std::string kOpen = "[drawer,time] Initiates(OpenDrawer(drawer),Open(drawer),time).\n";
const std::string kGo = "[time] Initiates(Go(),Arrived(),time).\n";
const std::string kBind =
    "action opening (:object ?d) -> OpenDrawer(?d) ok: Open(?d) @t+1 else "
    "container-manipulation\n"
    "action closing (:object ?d) -> CloseDrawer(?d) ok: !Open(?d) @t+1 else plan-failure\n"
    "action parking-arms () -> Park() ok: Parked() @t+1 else plan-failure\n"
    "action reaching () -> Reach() ok: !Parked() @t+1 else plan-failure\n"
    "motion going () -> Go() ok: Arrived() @t+1 else navigation-pose-unreachable\n";

/// A plan in a world that its model does not know.
struct World {
  std::string truth, model, start, plan, goal;
};

class PlanWorld : public CliFixture {
 public:
  explicit PlanWorld(const World& world) {
    std::filesystem::create_directories(folder() / "w");
    write("w/truth.e", kDeclared + world.truth);
    write("w/model.e", kDeclared + world.model);
    write("w/start.e", world.start);
    write("w/plan.lisp",
          "(define-condition container-manipulation (plan-failure) ())\n\n" + world.plan);
    write("w/robot.bind", kBind);
    write("w/common.yaml",
          "model: [model.e, start.e]\nsimulator: {model: truth.e}\nplan: plan.lisp\n"
          "bind: robot.bind\nhorizon: 8\n");
    write("w/open.yaml", "include: common.yaml\nconstraints: \"" + world.goal + "\"\n");
    write("w/closed.yaml", "include: common.yaml\nexecution: closed-loop\n");
  }
  Json repaired(const std::string& scenario, std::vector<std::string> more = {}) const {
    json_of(*this, {"run", scenario, "--epsilon", "0.3", "--keep-going", "--out", "out"}, 1);
    std::vector<std::string> words = {"repair", "out", "--limit", "0"};
    words.insert(words.end(), more.begin(), more.end());
    return json_of(*this, words, 1);
  }
  /// The proposal is taken, by git and by --apply alike; then the plan runs clean in both ways.
  void apply(const Json& proposal) const {
    CAPTURE(proposal.dump(1));
    write("p.diff", proposal.at("patch").get<std::string>());
    ProcessOptions options;
    options.folder = folder().string();
    const auto checked = run_process({"git", "apply", "--check", "p.diff"}, options);
    CHECK_MESSAGE(checked.code == 0, checked.err);
    const auto before = read("w/plan.lisp");
    const auto model = read("w/model.e");
    CHECK(run_process({"git", "apply", "p.diff"}, options).code == 0);
    const auto patched = read("w/plan.lisp");
    write("w/plan.lisp", before);
    const auto number = std::to_string(proposal.at("rank").get<int>());
    CHECK(parallax({"repair", "out", "--limit", "0", "--apply", number}).code == 0);
    CHECK(read("w/plan.lisp") == patched);
    CHECK(patched != before);
    CHECK(read("w/model.e") == model);
  }
  std::string verdict(const std::string& scenario) const {
    const auto folder = scenario + ".out";
    const auto run = parallax({"run", scenario, "--epsilon", "0.3", "--out", folder, "--json"});
    CAPTURE(run.out);
    CAPTURE(run.err);
    return Json::parse(run.out).value("verdict", "none");
  }
};

/// The proposals about the plan whose words have all of these.
std::vector<Json> plan_proposals(const Json& report, const std::vector<std::string>& words = {}) {
  std::vector<Json> out;
  for (const auto& proposal : report.at("proposals")) {
    if (proposal.at("changes") != "plan") continue;
    const auto said = proposal.at("words").get<std::string>();
    bool all = true;
    for (const auto& word : words) all = all && said.find(word) != std::string::npos;
    if (all) out.push_back(proposal);
  }
  return out;
}

/// In the light the drawer is opened first.
const std::string kOpenThenGo =
    "(def-cram-function go-there ()\n"
    "  (when (holds '(lit))\n"
    "    (perform (an action (type opening) (object (an object (name top))))))\n"
    "  (perform (an action (type parking-arms)))\n"
    "  ;; On the way.\n"
    "  (perform (a motion (type going))))\n"
    "\n"
    "(go-there)\n";
const std::string kStart =
    "[drawer] !HoldsAt(Open(drawer),0).\n!HoldsAt(Parked(),0).\n!HoldsAt(Arrived(),0).\n";

const World kDrawer = {
    kOpen + kClose + kPark + kReach +
        "[time] !({drawer} HoldsAt(Open(drawer),time)) -> Initiates(Go(),Arrived(),time).\n",
    kOpen + kClose + kPark + kReach + kGo, kStart, kOpenThenGo,
    "Happens(Go(),time-1) & HoldsAt(Arrived(),time)"};

TEST_CASE("a perform is missing: it is inserted, and the plan arrives in open and closed loop") {
  for (const std::string scenario : {"w/open.yaml", "w/closed.yaml"}) {
    CAPTURE(scenario);
    const PlanWorld cli(kDrawer);
    const auto report = cli.repaired(scenario);
    CAPTURE(report.dump(1));
    // The model comes first: it differs from the world as it is.
    CHECK(report.at("proposals").at(0).at("changes") == "model");
    const auto found =
        plan_proposals(report, {"(type closing)", "(name top)", "is done in front of"});
    REQUIRE(!found.empty());
    CHECK(found.front().at("edits") == 1);
    CHECK(found.front().at("evidence").at(0).get<std::string>().find("Go() as in run") !=
          std::string::npos);
    cli.apply(found.front());
    CHECK(cli.verdict("w/open.yaml") == "no-discrepancy");
    CHECK(cli.verdict("w/closed.yaml") == "no-discrepancy");
    CHECK(cli.read("w/plan.lisp").find("  ;; On the way.\n") != std::string::npos);
  }
}

TEST_CASE("a perform comes too late: it is moved") {
  const World world = {kOpen + kClose + kPark + kReach +
                           "[time] HoldsAt(Parked(),time) -> Initiates(Go(),Arrived(),time).\n",
                       kOpen + kClose + kPark + kReach + kGo, kStart,
                       "(def-cram-function go-there ()\n"
                       "  (when (holds '(lit))\n"
                       "    (perform (an action (type parking-arms))))\n"
                       "  (perform (a motion (type going)))\n"
                       "  (perform (an action (type parking-arms)))\n"
                       "  (perform (an action (type opening) (object (an object (name top))))))\n"
                       "\n"
                       "(go-there)\n",
                       "HoldsAt(Arrived(),time) & HoldsAt(Open(top),time)"};
  const PlanWorld cli(world);
  const auto report = cli.repaired("w/open.yaml");
  CAPTURE(report.dump(1));
  const auto found = plan_proposals(report, {"parking-arms", "goes in front of", "going"});
  REQUIRE(!found.empty());
  cli.apply(found.front());
  CHECK(cli.verdict("w/open.yaml") == "no-discrepancy");
  CHECK(cli.verdict("w/closed.yaml") == "no-discrepancy");
}

TEST_CASE(
    "what cannot be done here is not needed here: it is guarded, by what the runs differ in") {
  const World world = {kClose + kPark + kReach + kGo +
                           "[drawer,time] !HoldsAt(Lit(),time) -> "
                           "Initiates(OpenDrawer(drawer),Open(drawer),time).\n",
                       kOpen + kClose + kPark + kReach + kGo, kStart,
                       "(def-cram-function go-there ()\n"
                       "  (when (holds '(lit))\n"
                       "    (perform (an action (type parking-arms))))\n"
                       "  (perform (an action (type parking-arms)))\n"
                       "  (perform (an action (type opening) (object (an object (name top)))))\n"
                       "  (perform (a motion (type going))))\n"
                       "\n"
                       "(go-there)\n",
                       "HoldsAt(Arrived(),time)"};
  const PlanWorld cli(world);
  const auto report = cli.repaired("w/open.yaml");
  CAPTURE(report.dump(1));
  const auto found = plan_proposals(report, {"is done only where", "(not (holds '(lit)))"});
  REQUIRE(!found.empty());
  cli.apply(found.front());
  CHECK(cli.verdict("w/open.yaml") == "no-discrepancy");
  CHECK(cli.verdict("w/closed.yaml") == "no-discrepancy");
}

const std::string kAlwaysOpen =
    "(def-cram-function go-there ()\n"
    "  (perform (an action (type opening) (object (an object (name top)))))\n"
    "  (perform (a motion (type going))))\n"
    "\n"
    "(go-there)\n";

TEST_CASE("what fails at random is tried again") {
  const std::string rest = kClose + kPark + kReach + kGo;
  const World world = {"fluent Sticks()\nnoninertial Sticks\n" + rest +
                           "[drawer,time] !HoldsAt(Sticks(),time) -> "
                           "Initiates(OpenDrawer(drawer),Open(drawer),time).\n",
                       rest + kOpen, kStart, kAlwaysOpen,
                       "HoldsAt(Arrived(),time) & HoldsAt(Open(top),time)"};
  const PlanWorld cli(world);
  const auto report = cli.repaired("w/closed.yaml");
  CAPTURE(report.dump(1));
  REQUIRE(!report.at("contradictions").empty());
  const auto found = plan_proposals(report, {"is tried again", "container-manipulation"});
  REQUIRE(!found.empty());
  CHECK(found.front().at("hides_failure") == false);
  cli.apply(found.front());
  // With a model in which opening may fail, the plan is right.
  cli.write("w/model.e",
            kDeclared + rest + "[drawer,time] Releases(OpenDrawer(drawer),Open(drawer),time).\n");
  CHECK(cli.verdict("w/closed.yaml") == "no-discrepancy");
}

TEST_CASE("what fails for good and is not needed is done without") {
  const std::string rest = kClose + kPark + kReach + kGo;
  const World world = {rest, rest + kOpen, kStart, kAlwaysOpen, "HoldsAt(Arrived(),time)"};
  const PlanWorld cli(world);
  const auto report = cli.repaired("w/closed.yaml");
  CAPTURE(report.dump(1));
  const auto found = plan_proposals(report, {"the plan goes on behind it"});
  REQUIRE(!found.empty());
  // It says that it mends nothing, and stands last.
  for (const auto& each : found) {
    CHECK(each.at("hides_failure") == true);
    CHECK(each.at("evidence").dump().find("It hides the failure") != std::string::npos);
  }
  bool hidden = false;
  for (const auto& each : plan_proposals(report)) {
    CHECK((!hidden || each.at("hides_failure") == true));
    hidden = each.at("hides_failure");
  }
  // The event went well in no run: no precondition is proposed for it.
  CHECK(plan_proposals(report).size() == found.size());
  cli.apply(found.front());
  cli.write("w/model.e", kDeclared + rest);
  CHECK(cli.verdict("w/closed.yaml") == "no-discrepancy");
  CHECK(cli.verdict("w/open.yaml") == "no-discrepancy");
}

TEST_CASE("which properties a proposal breaks or restores is said") {
  const PlanWorld cli(kDrawer);
  const std::string closed = "!HoldsAt(Arrived(),time) | !HoldsAt(Open(top),time)";
  const auto report = cli.repaired("w/open.yaml", {"--property", closed});
  CAPTURE(report.dump(1));
  // As it is the robot arrives with the drawer open. It does not in a world where it cannot.
  for (const auto& proposal : report.at("proposals")) {
    const auto& property = proposal.at("properties").at(0);
    CHECK(property.at("property") == closed);
    CHECK(property.at("before") == false);
  }
  const auto found = plan_proposals(report, {"(type closing)", "(name top)"});
  REQUIRE(!found.empty());
  CHECK(found.front().at("properties").at(0).at("after") == true);
  const auto text = cli.parallax({"repair", "out", "--property", closed});
  CHECK(text.out.find("Property: restores `" + closed + "`.") != std::string::npos);
  CHECK(cli.parallax({"repair", "out", "--property", "HoldsAt("}).code == 3);
}

TEST_CASE("numbers of proposals do not depend on how many are shown") {
  const PlanWorld cli(kDrawer);
  cli.repaired("w/open.yaml");
  const auto all = json_of(cli, {"repair", "out", "--limit", "6"}, 1).at("proposals");
  for (std::size_t limit = 1; limit <= all.size(); ++limit) {
    const auto some = json_of(cli, {"repair", "out", "--limit", std::to_string(limit)}, 1);
    REQUIRE(some.at("proposals").size() == limit);
    for (std::size_t i = 0; i < limit; ++i) {
      CHECK(some.at("proposals").at(i).at("words") == all.at(i).at("words"));
    }
  }
}

}  // namespace
}  // namespace parallax::test
