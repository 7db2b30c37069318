// Explanations by `parallax explain RUN_DIR` of 24 discrepancies, word by word:
// tests/tools/blame/*.txt. PARALLAX_UPDATE_GOLDENS=1 writes them anew; read the difference as
// carefully as code.

#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>

#include "tests/tools/cli_fixture.h"

namespace parallax::test {
namespace {

namespace fs = std::filesystem;

const fs::path kScenarios = fs::path(PARALLAX_SOURCE_DIR) / "scenarios";
const fs::path kGoldens = fs::path(PARALLAX_SOURCE_DIR) / "tests" / "tools" / "blame";

/// Copies of the scenarios, to be changed.
class Scenarios : public CliFixture {
 public:
  Scenarios() {
    for (const std::string name : {"two_models", "kitchen", "warehouse"}) {
      fs::copy(kScenarios / name, folder() / name);
    }
  }
  /// Two models: the one that is believed, and the world.
  std::string two(const std::string& model, const std::string& world,
                  const std::string& more = "") const {
    write("two_models/model.e", model);
    write("two_models/world.e", world);
    write("two_models/own.yaml",
          "include: common.yaml\nmodel: [model.e, start.e]\nsimulator: {model: world.e}\n" + more);
    return "two_models/own.yaml";
  }
  /// The kitchen's model as it is for the world, and with a mistake for the model.
  std::string mistaken_kitchen(const std::string& from, const std::string& to) const {
    write("kitchen/true_common.e", read("kitchen/common.e"));
    write("kitchen/true.e", read("kitchen/domain.e"));
    replace("kitchen/true.e", "load common.e", "load true_common.e");
    const bool in_domain = read("kitchen/domain.e").find(from) != std::string::npos;
    replace(in_domain ? "kitchen/domain.e" : "kitchen/common.e", from, to);
    const auto common = read("kitchen/household.yaml");
    write("kitchen/household.yaml", common.substr(0, common.find("\nmapping:") + 1));
    write("kitchen/own.yaml", "include: plan1.yaml\nsimulator: {model: true.e}\nexpect:\n");
    return "kitchen/own.yaml";
  }
  /// A plan of the kitchen in physics, from starts that show the discrepancy.
  std::string kitchen(const std::string& plan, const std::string& more) const {
    write("kitchen/own.yaml", "include: " + plan + "\n" + more);
    return "kitchen/own.yaml";
  }
};

/// Runs the scenario and compares the explanation of its first discrepancy.
void explains(const Scenarios& cli, const std::string& name, const std::string& scenario,
              std::vector<std::string> run_options = {},
              const std::vector<std::string>& explain_options = {"--runs", "0"}) {
  CAPTURE(name);
  std::vector<std::string> run = {"run", scenario, "--out", "out"};
  run.insert(run.end(), run_options.begin(), run_options.end());
  const auto ran = cli.parallax(run);
  CAPTURE(ran.err);
  REQUIRE(ran.code == 1);
  std::vector<std::string> explain = {"explain", "out"};
  explain.insert(explain.end(), explain_options.begin(), explain_options.end());
  const auto result = cli.parallax(explain);
  CAPTURE(result.err);
  const auto path = kGoldens / (name + ".txt");
  if (std::getenv("PARALLAX_UPDATE_GOLDENS") != nullptr) {
    std::ofstream(path) << result.out;
    return;
  }
  std::stringstream golden;
  golden << std::ifstream(path).rdbuf();
  CHECK(result.out == golden.str());
}

const std::string kOpens = "load opens.e\n";
const std::string kNoEffects =
    "sort drawer\ndrawer top\nfluent Open(drawer)\nfluent Parked()\nevent OpenDrawer(drawer)\n"
    "event CloseDrawer(drawer)\nevent Park()\nevent Reach()\n";
const std::string kOpening = "[drawer,time] Initiates(OpenDrawer(drawer),Open(drawer),time).\n";
const std::string kClosing = "[drawer,time] Terminates(CloseDrawer(drawer),Open(drawer),time).\n";
const std::string kClosed = "execution: closed-loop\n";

TEST_CASE("what a model forgets") {
  explains(Scenarios(), "effect_forgotten", "two_models/unparks.yaml");
  explains(Scenarios(), "effect_forgotten_in_closed_loop", "two_models/unparks.yaml",
           {"--execution", "closed-loop"});
  {
    const Scenarios cli;
    explains(cli, "closing_forgotten", cli.two(kNoEffects + kOpening, kOpens, kClosed));
  }
  {
    const Scenarios cli;
    explains(cli, "condition_forgotten",
             cli.two(kOpens + "fluent Locked()\n",
                     kOpens + "fluent Locked()\nHoldsAt(Locked(),0).\n"
                              "[drawer,time] Happens(OpenDrawer(drawer),time) -> "
                              "!HoldsAt(Locked(),time).\n",
                     "mapping: {Locked(): ignored}\n"));
  }
  explains(Scenarios(), "outcome_not_open", "two_models/sticks.yaml");
  explains(Scenarios(), "outcome_not_open_in_closed_loop", "two_models/sticks.yaml",
           {"--execution", "closed-loop"});
}

TEST_CASE("what a model says wrongly") {
  {
    const Scenarios cli;
    explains(cli, "sign_flipped",
             cli.two(kOpens + "[drawer,time] Initiates(CloseDrawer(drawer),Parked(),time).\n" +
                         "[drawer,time] Terminates(OpenDrawer(drawer),Parked(),time).\n",
                     kOpens));
  }
  {
    const Scenarios cli;
    explains(cli, "effect_on_the_wrong_fluent",
             cli.two(kNoEffects + kClosing +
                         "[drawer,time] Terminates(OpenDrawer(drawer),Parked(),time).\n"
                         "[time] Initiates(Park(),Parked(),time).\n",
                     kOpens, kClosed));
  }
  {
    const Scenarios cli;
    explains(cli, "condition_too_many",
             cli.two(kNoEffects + kClosing +
                         "[drawer,time] !HoldsAt(Parked(),time) -> "
                         "Initiates(OpenDrawer(drawer),Open(drawer),time).\n",
                     kOpens, kClosed));
  }
  {
    const Scenarios cli;
    explains(cli, "states_excluded",
             cli.two("load domain.e\n"
                     "[drawer,time] Releases(OpenDrawer(drawer),Open(drawer),time).\n"
                     "[drawer,time] Releases(OpenDrawer(drawer),Parked(),time).\n"
                     "[drawer,time] HoldsAt(Open(drawer),time) -> !HoldsAt(Parked(),time).\n",
                     kOpens));
  }
}

TEST_CASE("what an executed plan meets") {
  {
    const Scenarios cli;
    explains(cli, "event_that_cannot_happen",
             cli.two(kOpens + "[time] Happens(Park(),time) -> !HoldsAt(Parked(),time).\n", kOpens,
                     kClosed));
  }
  {
    const Scenarios cli;
    explains(cli, "action_refused_that_changes_nothing",
             cli.two(kOpens, kOpens + "[time] Happens(Park(),time) -> !HoldsAt(Parked(),time).\n",
                     kClosed));
  }
  {
    const Scenarios cli;
    cli.write("two_models/retry.lisp", R"((def-cram-function open-it ()
  (with-retry-counters ((tries 1))
    (with-failure-handling ((manipulation-low-level-failure (e) (do-retry tries (retry))))
      (perform (an action (type opening) (object (an object (name top))))))))
(open-it)
)");
    const std::string sticks =
        "load domain.e\nfluent Sticks()\n[drawer,time] !HoldsAt(Sticks(),time) -> "
        "Initiates(OpenDrawer(drawer),Open(drawer),time).\n";
    explains(cli, "second_try_that_cannot_succeed",
             cli.two(sticks, sticks + "noninertial Sticks\n",
                     kClosed + "plan: retry.lisp\nmapping: {Sticks(): ignored}\n"));
  }
}

TEST_CASE("mistakes in the kitchen's model, where the model is the world") {
  const auto mistaken = [](const std::string& name, const std::string& from,
                           const std::string& to) {
    const Scenarios cli;
    explains(cli, name, cli.mistaken_kitchen(from, to));
  };
  mistaken("kitchen_axiom_dropped",
           "[arm,item,time] Terminates(PickUp(arm,item),Parked(arm),time).", "");
  mistaken("kitchen_effect_on_the_wrong_fluent",
           "    Terminates(PickUp(arm,item),BelievedAt(item,place),time).",
           "    Terminates(PickUp(arm,item),Perceived(item),time).");
  mistaken("kitchen_condition_added",
           "HoldsAt(ItemAt(item,place),time) ->\n    Initiates(Detect(itype),BelievedAt",
           "HoldsAt(ItemAt(item,place),time) & HoldsAt(TorsoAt(torsoHigh),time) ->\n"
           "    Initiates(Detect(itype),BelievedAt");
  mistaken("kitchen_gaze_kept", "    Terminates(Go(base),LookingAt(place),time).",
           "    Terminates(Go(base),Perceived(milk1),time).");
}

TEST_CASE("the kitchen's own, in physics") {
  {
    const Scenarios cli;
    explains(cli, "kitchen_carton_slips",
             cli.kitchen("plan1.yaml", "sampling: {variables: {milk1.mass: [1.03, 1.05]}}\n"));
  }
  {
    const Scenarios cli;
    explains(cli, "kitchen_drawer_in_the_way",
             cli.kitchen("plan2.yaml",
                         "sampling: {variables: {robot.x: [0.77, 0.79], robot.y: [0.11, 0.13]}}\n"),
             {"--epsilon", "0.5", "--confidence", "0.5"});
  }
  {
    const Scenarios cli;
    explains(cli, "kitchen_spoon_out_of_reach",
             cli.kitchen("plan3.yaml",
                         "regions: {sets: {drawers: {cells: {dTop: {start: {x: [0.20, 0.22], y: "
                         "[0.10, 0.115]}}}}}}\n"));
  }
  {
    const Scenarios cli;
    explains(cli, "kitchen_spoon_not_seen",
             cli.kitchen("plan3.yaml",
                         "regions: {sets: {drawers: {cells: {dTop: {start: {x: [-0.12, -0.10], y: "
                         "[0.10, 0.115]}}}}}}\n"
                         "world: {robot: {camera: {half_angle_rad: 0.06}}}\n"));
  }
}

TEST_CASE("the warehouse's and that of two regions, in physics") {
  explains(Scenarios(), "warehouse_oily_pads", "warehouse/oily_pads.yaml");
  explains(Scenarios(), "two_regions_at_the_edge", "edge.yaml");
  explains(Scenarios(), "two_regions_condition_forgotten", "wrong_model.yaml");
}

}  // namespace
}  // namespace parallax::test
