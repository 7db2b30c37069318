// The discrepancies of the kitchen come from its physics: their causes are taken out of the
// scenario files and put back, with plan, model and mapping as they are.

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "tests/tools/cli_json.h"
#include "tests/tools/kitchen_copy.h"

namespace parallax::test {
namespace {

constexpr int kRuns = 3;

/// Starts that show the discrepancy every time, and the trace that does.
struct Setup {
  std::string scenario, starts, trace, cause;
};

const Setup kSlip = {"plan1.yaml", "sampling: {variables: {milk1.mass: [1.03, 1.05]}}\n", "1",
                     "Go(bTable): not Holding(left,milk1)"};
const Setup kBlocked = {"plan2.yaml",
                        "sampling: {variables: {robot.x: [0.77, 0.79], robot.y: [0.11, 0.13]}}\n",
                        "2", "Go(bTable): navigation-pose-unreachable"};
const Setup kFarCorner = {
    "plan3.yaml",
    "regions: {sets: {drawers: {cells: {dTop: {start: {x: [0.20, 0.22], y: [0.10, 0.115]}}}}}}\n",
    "1", "PickUp(left,spoon1): manipulation-pose-unreachable"};
const Setup kOffTheGaze = {
    "plan3.yaml",
    "regions: {sets: {drawers: {cells: {dTop: {start: {x: [-0.12, -0.10], y: [0.10, 0.115]}}}}}}\n",
    "1", "Detect(spoon): object-not-found"};

/// Number of kRuns simulations that go wrong in the way of `setup`. Checks that others do not.
int count(const Setup& setup, const std::string& change = {}) {
  const KitchenCopy cli;
  cli.write("kitchen/variant.yaml", "include: " + setup.scenario + "\n" + setup.starts + change);
  const auto rates = json_of(cli, {"rates", "kitchen/variant.yaml", "--trace", setup.trace,
                                   "--runs", std::to_string(kRuns)});
  const auto& trace = rates.at("traces").at(0);
  int found = 0;
  for (const auto& cause : trace.at("causes")) {
    if (cause.at("cause") == setup.cause) found = cause.at("count");
  }
  CAPTURE(trace.dump());
  CHECK(trace.at("any").at("count") == found);
  return found;
}

TEST_CASE("a full carton slips; more force, more friction or an even floor keep it") {
  CHECK(count(kSlip) == kRuns);
  CHECK(count(kSlip, "world: {bodies: {milk1: {grasp: {effort_n: 40}}}}") == 0);
  CHECK(count(kSlip, "world: {friction: {carton-pad: 0.6}}") == 0);
  CHECK(count(kSlip, "world: {robot: {base: {relief_amplitude_m: 0}}}") == 0);
  // Put back: the values of the scenario, written out.
  CHECK(count(kSlip,
              "world: {bodies: {milk1: {grasp: {effort_n: 25}}}, friction: {carton-pad: 0.215}, "
              "robot: {base: {relief_amplitude_m: 0.0015}}}") == kRuns);
}

TEST_CASE("an open drawer blocks the way; a lower robot passes, and who closes it first") {
  CHECK(count(kBlocked) == kRuns);
  const auto body_of_height = [](const char* height, const char* middle) {
    return std::string("world: {bodies: {base: {shapes: [{size_m: [0.66, 0.66, ") + height +
           "], at_m: [0, 0, " + middle +
           "]}, {size_m: [0.44, 0.50, 0.55], at_m: [-0.05, 0, 0.875]}]}}}";
  };
  CHECK(count(kBlocked, body_of_height("0.30", "0.18")) == 0);
  CHECK(count(kBlocked, body_of_height("0.57", "0.315")) == kRuns);

  Setup closed = kBlocked;
  closed.scenario = "plan2_modified.yaml";
  CHECK(count(closed) == 0);
}

TEST_CASE("a spoon in the far corner is not reached; with finer regions it is not there") {
  CHECK(count(kFarCorner) == kRuns);
  Setup finer = kFarCorner;
  finer.starts =
      "regions: {sets: {drawers: {cells: {dTop: {start: {x: [-0.10, 0.00], y: [-0.05, "
      "0.03]}}}}}}\n";
  CHECK(count(finer) == 0);
}

TEST_CASE("beside the line of sight a spoon is missed by a narrow camera only") {
  CHECK(count(kOffTheGaze, "world: {robot: {camera: {half_angle_rad: 0.06}}}") == kRuns);
  CHECK(count(kOffTheGaze) == 0);
}

}  // namespace
}  // namespace parallax::test
