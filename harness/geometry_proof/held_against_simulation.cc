#include "harness/geometry_proof/held_against_simulation.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "harness/robot/ode_simulator.h"
#include "harness/world/angles.h"

namespace parallax::harness {
namespace {

constexpr double kTimeLimit_s = 120.0;
constexpr int kMostDraws = 100;  // of invalid starts in a row

double number_in(const State& state, const std::string& name, double fallback) {
  const auto found = state.find(name);
  return found == state.end() ? fallback : as_number(found->second).value_or(fallback);
}

bool off(double a, double b, double by) { return std::abs(a - b) > by + 1e-9; }

/// The assumptions that the state before an action breaks.
std::vector<std::string> broken_assumptions(const WorldSpec& spec, const WorldLayout& layout,
                                            const ProofScene& scene, const KnownState& known,
                                            const State& start, const State& now) {
  std::vector<std::string> broken;
  const BodySpec& base = layout.bodies[*layout.find_body(spec.mobile->base_body)];
  double x = number_in(start, "robot.x", base.p_WB.x());
  double y = number_in(start, "robot.y", base.p_WB.y());
  double yaw = number_in(start, "robot.yaw", base.yaw_rad);
  double move = known.slack.drift_m, turn = known.slack.drift_rad;
  if (known.base_at) {
    x = known.base_at->p.x(), y = known.base_at->p.y(), yaw = known.base_at->yaw_rad;
    move += known.base_at->within_m, turn += known.base_at->within_rad;
  }
  const double at_x = number_in(now, "robot.x", x), at_y = number_in(now, "robot.y", y);
  const double heading = number_in(now, "robot.yaw", yaw);
  if (off(at_x, x, move) || off(at_y, y, move) || std::abs(wrapped(heading - yaw)) > turn + 1e-9) {
    broken.push_back("the base has moved");
  }
  const double lift = number_in(now, "robot.lift", 0.0);
  if (lift < known.lift_m.lower - 1e-9 || lift > known.lift_m.upper + 1e-9) {
    broken.push_back("the torso is elsewhere");
  }
  for (const SliderId id : observed_sliders(layout, *spec.mobile)) {
    const JointSpec& joint = layout.sliders[id];
    if (joint.name == spec.mobile->torso_joint) continue;
    const Bounds1 q = known.slider_m[id.index()];
    const double at = number_in(now, joint.name + ".q", q.lower);
    if (at < q.lower - known.slack.drift_m - 1e-9 || at > q.upper + known.slack.drift_m + 1e-9) {
      broken.push_back(fmt::format("{}.q is outside its range", joint.name));
    }
  }
  const Eigen::AngleAxisd R(heading, Eigen::Vector3d::UnitZ());
  for (std::size_t a = 0; a < known.arms.size(); ++a) {
    const ArmSpec& arm = spec.mobile->arms[a];
    const Eigen::Vector3d tool(number_in(now, arm.name + ".x", 0.0),
                               number_in(now, arm.name + ".y", 0.0),
                               number_in(now, arm.name + ".z", 0.0));
    const Eigen::Vector3d carry = Eigen::Vector3d(at_x, at_y, lift) + R * arm.carry_B;
    if (known.arms[a] == KnownArm::kParked &&
        (tool - carry).norm() > known.slack.parked_m + known.relief_m + 1e-9) {
      broken.push_back(fmt::format("the {} arm is not parked", arm.name));
    }
    for (std::size_t i = 0; i < known.bodies.size(); ++i) {
      const BodySpec& body = layout.bodies[layout.bodies.id_at(i)];
      if (known.bodies[i].where != KnownBody::Where::kHeld || known.bodies[i].arm != arm.name) {
        continue;
      }
      const Eigen::Vector3d p(number_in(now, body.name + ".x", 0.0),
                              number_in(now, body.name + ".y", 0.0),
                              number_in(now, body.name + ".z", 0.0));
      const double turned = number_in(now, body.name + ".yaw", 0.0);
      const double tilt = std::hypot(number_in(now, body.name + ".roll", 0.0),
                                     number_in(now, body.name + ".pitch", 0.0));
      const double start_yaw = number_in(start, body.name + ".yaw", body.yaw_rad);
      const GraspSpec grasp = body.grasp.value_or(GraspSpec{});
      const Eigen::AngleAxisd frame(turned, Eigen::Vector3d::UnitZ());
      const double slid = known.bodies[i].carrier ? known.slack.sliding_rad : 0.0;
      double apart_m = 1e300, higher_m = 0.0;
      for (const double side : {1.0, -1.0}) {
        const Eigen::Vector3d off = p + frame * scene.gripped_at(grasp, a, side) - tool;
        apart_m = std::min(apart_m, off.head<2>().norm());
        higher_m = std::abs(off.z());
      }
      if (apart_m > known.slack.held_m + 1e-9 || higher_m > known.slack.held_height_m + 1e-9 ||
          tilt > known.slack.lean_rad ||
          std::abs(wrapped(turned - start_yaw)) >
              known.slack.held_rad + known.slack.drift_rad + slid) {
        broken.push_back(fmt::format("`{}` has slipped in the gripper", body.name));
      }
    }
  }
  for (std::size_t i = 0; i < known.bodies.size(); ++i) {
    const BodySpec& body = layout.bodies[layout.bodies.id_at(i)];
    if (!layout.is_free[i] || known.bodies[i].where != KnownBody::Where::kAtStart) continue;
    double within = known.slack.drift_m, within_rad = known.slack.drift_rad;
    Eigen::Vector2d low(number_in(start, body.name + ".x", body.p_WB.x()),
                        number_in(start, body.name + ".y", body.p_WB.y()));
    Eigen::Vector2d high = low;
    if (known.bodies[i].carrier) {
      const Bounds1 q = known.slider_m[known.bodies[i].carrier->index()];
      const Eigen::Vector2d axis =
          layout.sliders[*known.bodies[i].carrier].axis_W.normalized().head<2>();
      const Eigen::Vector2d one = q.lower * axis, other = q.upper * axis;
      low += one.cwiseMin(other), high += one.cwiseMax(other);
      if (q.lower != 0.0 || q.upper != 0.0) {
        within += known.slack.sliding_m, within_rad += known.slack.sliding_rad;
      }
    }
    const double bx = number_in(now, body.name + ".x", low.x());
    const double by = number_in(now, body.name + ".y", low.y());
    const double by_yaw = number_in(start, body.name + ".yaw", body.yaw_rad);
    if (bx < low.x() - within - 1e-9 || bx > high.x() + within + 1e-9 ||
        by < low.y() - within - 1e-9 || by > high.y() + within + 1e-9 ||
        std::abs(wrapped(number_in(now, body.name + ".yaw", by_yaw) - by_yaw)) >
            within_rad + 1e-9) {
      broken.push_back(fmt::format("`{}` has moved", body.name));
    }
    const Bounds1 height = scene.free_height(layout.bodies.id_at(i));
    const double bz = number_in(now, body.name + ".z", height.lower);
    const double lean = std::hypot(number_in(now, body.name + ".roll", 0.0),
                                   number_in(now, body.name + ".pitch", 0.0));
    if (bz < height.lower - 1e-9 || bz > height.upper + 1e-9 ||
        lean > known.slack.drift_rad + 1e-9) {
      broken.push_back(fmt::format("`{}` lies higher, lower or aslant", body.name));
    }
  }
  return broken;
}

}  // namespace

std::vector<SimulatedTest> simulate_tests(const WorldSpec& spec, const WorldLayout& layout,
                                          const Sampler& sampler, std::uint64_t seed,
                                          std::int64_t count, const std::vector<ProofAction>& calls,
                                          const std::vector<ProvableAction>& actions,
                                          const std::vector<ActionCertificate>& proved,
                                          const std::atomic<bool>* stop) {
  std::size_t last = 0, tests = 0;
  for (const ProvableAction& action : actions) {
    tests += action.tests.size();
    if (!action.tests.empty()) last = action.number;
  }
  std::vector<SimulatedTest> out(tests);
  if (tests == 0) return out;
  OdeSimulator simulator(spec);
  for (std::int64_t n = 0; n < count && (stop == nullptr || !stop->load()); ++n) {
    State start;
    Outcome reset;
    for (int attempt = 0; attempt < kMostDraws; ++attempt) {
      const DrawKey key{seed, 0, DrawPhase::kSearch, static_cast<std::uint64_t>(n),
                        static_cast<std::uint64_t>(attempt)};
      start = sampler.draw(key);
      reset = simulator.reset(start, simulator_seed(key));
      if (reset.status == SimStatus::kOk) break;
    }
    if (reset.status != SimStatus::kOk) break;
    std::vector<double> drawn;
    for (const auto& [name, interval] : sampler.cuboid().dimensions) {
      if (interval.lower < interval.upper) drawn.push_back(number_in(start, name, 0.0));
    }
    std::size_t index = 0, action = 0;
    for (std::size_t i = 0; i <= last; ++i) {
      while (action < actions.size() && actions[action].number < i) ++action;
      const bool is_tested = action < actions.size() && actions[action].number == i;
      const State before = is_tested ? simulator.state() : State{};
      const Outcome outcome = simulator.act(calls[i].controller, calls[i].arguments, kTimeLimit_s);
      for (std::size_t t = 0; is_tested && t < actions[action].tests.size(); ++t, ++index) {
        const ActionTest& test = *actions[action].tests[t];
        SimulatedTest& tally = out[index];
        auto broken = broken_assumptions(spec, layout, test.scene(), test.state(), start, before);
        if (!broken.empty()) {
          ++tally.not_as_assumed;
          for (const std::string& text : broken) ++tally.broken[text];
          continue;
        }
        const DecidedBox* box = box_of(proved[action].tests[t].boxes, drawn);
        if (box == nullptr) continue;
        const CheckedTest& about = test.check().test();
        const bool failed_at_once =
            outcome.status == SimStatus::kFailed && outcome.sim_time_s == 0.0;
        if (!about.is_at_once && failed_at_once) {
          ++tally.not_as_assumed;
          ++tally.broken["the action failed before the test"];
          continue;
        }
        const bool refused = outcome.status == SimStatus::kFailed &&
                             failed_at_once == about.is_at_once &&
                             outcome.reason.starts_with(about.refusal);
        auto& counted = tally.by_verdict[static_cast<std::size_t>(box->verdict)];
        ++counted.starts;
        counted.refused += refused ? 1 : 0;
        const bool contradicts = (box->verdict == BoxVerdict::kSafe && refused) ||
                                 (box->verdict == BoxVerdict::kRefuted && !refused);
        if (contradicts) tally.contradictions.push_back(start);
      }
    }
  }
  return out;
}

}  // namespace parallax::harness
