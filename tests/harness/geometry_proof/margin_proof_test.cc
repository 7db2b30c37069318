// Tests of controllers that are a distance or an angle, compared with the controllers themselves.

#include <doctest/doctest.h>

#include "harness/geometry_proof/certificate.h"
#include "harness/sampling/sampler.h"
#include "tests/harness/kitchen/kitchen_world.h"

namespace parallax::harness {
namespace {

struct Tally {
  std::int64_t safe = 0, refused = 0, open = 0;
};

/// Proves the test of the last of `calls` from `region`, and asks second evaluation and controller
/// about starts of its boxes: most of them at corners.
Tally hold_against_controller(const WorldSpec& spec, const StartCuboid& region,
                              const std::vector<ProofAction>& calls, const std::string& function,
                              double most_open) {
  const WorldLayout layout = lay_out(spec);
  ProofAssumptions little;
  little.drift_m = little.drift_rad = 5e-4;
  auto actions = provable_actions(spec, layout, region, calls, little);
  CAPTURE(actions.back().left_to_simulation);
  REQUIRE(actions.back().tests.size() == 1);
  actions.erase(actions.begin(), actions.end() - 1);
  SubdivisionLimits limits;
  limits.boxes = 600;
  const auto certified = certify(actions, limits);
  const TestCertificate& test = certified.front().tests.front();
  CHECK(test.test.function == function);
  CHECK(test.open < most_open);
  const SecondEvaluation& second = actions.front().tests.front()->second();
  OdeSimulator simulator(spec);
  Tally tally;
  std::vector<std::string> drawn;
  State fixed;
  for (const auto& [name, interval] : region.dimensions) {
    if (interval.lower < interval.upper) drawn.push_back(name);
    fixed[name] = interval.lower;
  }
  std::uint64_t draw = 0;
  for (const DecidedBox& box : test.boxes) {
    ++draw;
    if (box.verdict == BoxVerdict::kOpen) continue;
    const CounterRng rng({draw, 5, {}, 0, 0});
    std::vector<double> start;
    State state = fixed;
    for (std::size_t i = 0; i < box.bounds.size(); ++i) {
      double share = rng.uniform(i);
      if (draw % 3 != 0) share = std::round(share);
      start.push_back(box.bounds[i].lower + share * (box.bounds[i].upper - box.bounds[i].lower));
      state[drawn[i]] = start.back();
    }
    const bool is_refuted = box.verdict == BoxVerdict::kRefuted;
    CHECK(second.refuses_at(start) == is_refuted);
    const auto other = is_refuted ? BoxVerdict::kSafe : BoxVerdict::kRefuted;
    CHECK_FALSE(second.confirms(box.bounds, other, 64));
    if (simulator.reset(state, 1).status != SimStatus::kOk) continue;
    bool got_there = true;
    for (std::size_t i = 0; i + 1 < calls.size() && got_there; ++i) {
      got_there = ok(simulator.act(calls[i].controller, calls[i].arguments, 60.0));
    }
    if (!got_there) continue;
    // A refusal at once needs no simulated time; otherwise the action must still be at work when
    // the time limit is zero.
    const ProofAction& action = calls.back();
    const Outcome outcome =
        simulator.act(action.controller, action.arguments, test.test.is_at_once ? 0.0 : 60.0);
    const bool refused = outcome.status == SimStatus::kFailed &&
                         (outcome.sim_time_s == 0.0) == test.test.is_at_once &&
                         outcome.reason.starts_with(test.test.refusal);
    CAPTURE(outcome.reason);
    CHECK(refused == is_refuted);
    ++(is_refuted ? tally.refused : tally.safe);
  }
  return tally;
}

StartCuboid stances(double x, double y, double yaw) {
  return {{{"robot.x", {0.55 - x, 0.55 + x, false}},
           {"robot.y", {0.80 - y, 0.80 + y, false}},
           {"robot.yaw", {-yaw, yaw, false}}}};
}

TEST_CASE("reach to a handle: what is proved is what the controller says") {
  const ProofAction open = {
      "Open()", "open-drawer", {{"arm", std::string("left")}, {"joint", std::string("dMid")}}};
  const Tally tally = hold_against_controller(kitchen_world(), stances(0.3, 0.4, 0.6), {open},
                                              "OpenDrawer::plan, require_reach", 0.6);
  CHECK(tally.safe > 5);
  CHECK(tally.refused > 5);
}

TEST_CASE("the neck's turn and tilt: what is proved is what the controller says") {
  WorldSpec stiff = kitchen_world();
  stiff.mobile->camera.max_pan_rad = 0.4;
  stiff.mobile->camera.max_tilt_rad = 0.6;
  const ProofAction look = {"Look()", "look", {{"place", std::string("dTop")}}};
  const Tally tally =
      hold_against_controller(stiff, stances(0.3, 0.3, 0.8), {look}, "Perception::look_at", 0.5);
  CHECK(tally.safe > 5);
  CHECK(tally.refused > 5);
}

}  // namespace
}  // namespace parallax::harness
