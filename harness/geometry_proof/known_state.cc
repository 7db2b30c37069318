// Knowledge of the world after actions that succeeded.
//
// Before the first action all is where the start puts it. Each controller that succeeds changes
// that in its own way: a drive puts the base at its goal within its tolerance, a drawer's slider
// at its stop, a pick-up a body into a hand, a place or an opened gripper leaves its body
// anywhere. What an action was not to move stays within a small drift. These are assumptions,
// each told in words; the proof holds under them, and a check against simulations can refute
// them. After a controller whose effects are not modelled nothing is known. Linear in the bodies
// for each action.

#include "harness/geometry_proof/known_state.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "harness/robot/mobile_robot.h"

namespace parallax::harness {
namespace {

/// The slider whose child `body` is or is welded to.
std::optional<SliderId> slider_of(const WorldLayout& layout, BodyId body) {
  for (std::size_t i = 0; i < layout.sliders.size(); ++i) {
    const SliderId id = layout.sliders.id_at(i);
    const BodyId child = *layout.find_body(layout.sliders[id].child);
    if (layout.link_of[child.index()] == layout.link_of[body.index()]) return id;
  }
  return std::nullopt;
}

Bounds1 range_of(const StartCuboid& region, const std::string& variable, double fallback) {
  for (const auto& dimension : region.dimensions) {
    if (dimension.variable == variable) {
      return {dimension.interval.lower, dimension.interval.upper};
    }
  }
  return {fallback, fallback};
}

/// Does it begin in the box round what the slider carries, wherever it is drawn?
bool lies_in(const StartCuboid& region, const BodySpec& body, const BodySpec& carrier) {
  const Bounds1 x = range_of(region, body.name + ".x", body.p_WB.x());
  const Bounds1 y = range_of(region, body.name + ".y", body.p_WB.y());
  Eigen::Vector3d low = Eigen::Vector3d::Constant(1e300), high = -low;
  for (const BodyShape& shape : carrier.shapes) {
    if (shape.yaw_rad != 0.0 || carrier.yaw_rad != 0.0) return false;
    low = low.cwiseMin(carrier.p_WB + shape.p_BS - 0.5 * shape.size_m);
    high = high.cwiseMax(carrier.p_WB + shape.p_BS + 0.5 * shape.size_m);
  }
  const Bounds1 bottom = range_of(region, body.name + ".bottom", body.p_WB.z());
  return x.lower >= low.x() && x.upper <= high.x() && y.lower >= low.y() && y.upper <= high.y() &&
         bottom.lower >= low.z() && bottom.upper <= high.z();
}

std::size_t arm_index(const WorldSpec& spec, const Arguments& arguments) {
  const auto name = arguments.text("arm");
  for (std::size_t i = 0; i < spec.mobile->arms.size(); ++i) {
    if (spec.mobile->arms[i].name == name) return i;
  }
  return 0;
}

/// The camera has moved: from where things were seen is not known any more.
void forget_looks(KnownState& state) {
  for (KnownBody& body : state.bodies) body.look.reset();
}

/// The user's assumption about a slider, if there is one.
const Bounds1* given_slider(const ProofAssumptions& assumptions, const JointSpec& joint) {
  for (const auto& [name, bounds] : assumptions.sliders) {
    if (name == joint.name + ".q") return &bounds;
  }
  return nullptr;
}

}  // namespace

KnownState state_at_start(const WorldSpec& spec, const WorldLayout& layout,
                          const StartCuboid& region) {
  KnownState state;
  state.slack = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, {}};
  state.slider_m.resize(layout.sliders.size());
  state.bodies.resize(layout.bodies.size());
  if (spec.mobile) state.arms.assign(spec.mobile->arms.size(), KnownArm::kAtStart);
  for (std::size_t i = 0; i < layout.bodies.size(); ++i) {
    if (!layout.is_free[i]) continue;
    const BodySpec& body = layout.bodies[layout.bodies.id_at(i)];
    for (std::size_t k = 0; k < layout.sliders.size(); ++k) {
      const SliderId slider = layout.sliders.id_at(k);
      const BodyId child = *layout.find_body(layout.sliders[slider].child);
      if (lies_in(region, body, layout.bodies[child])) state.bodies[i].carrier = slider;
    }
  }
  return state;
}

std::optional<std::string> assume_success(const WorldSpec& spec, const WorldLayout& layout,
                                          const std::string& event,
                                          const ControllerSpec& controller,
                                          const Arguments& arguments,
                                          const ProofAssumptions& assumptions, KnownState& state) {
  if (!spec.mobile) return "what the robot on a line does first is left to simulation";
  if (state.is_start) {
    state.is_start = false;
    state.slack = assumptions;
    state.relief_m = spec.mobile->relief_amplitude_m;
    state.assumed.push_back(
        fmt::format("what an action was not to move stays within {} m and {} rad of its place",
                    assumptions.drift_m, assumptions.drift_rad));
    // A lift that was never asked to move stays at its place like all else.
    state.lift_m = {-assumptions.drift_m, assumptions.drift_m};
  }
  const std::string_view name = controller.name;
  const auto assume = [&](const std::string& text) {
    state.assumed.push_back(fmt::format("{}: {}", event, text));
  };
  if (name == "look") {
    const auto target = target_of(layout, state, arguments);
    const PlaceSpec* place = arguments.place("place");
    if (place == nullptr && !target) return fmt::format("where {} looks is not known", event);
    state.gaze = place != nullptr ? *place : PlaceSpec{"", "", target->low, 0.0};
    return std::nullopt;
  }
  if (name == "detect") {
    const auto kind = arguments.text("kind");
    for (std::size_t i = 0; i < state.bodies.size(); ++i) {
      const BodyId id = layout.bodies.id_at(i);
      if (!layout.is_free[i] || layout.bodies[id].kind_name() != kind) continue;
      state.bodies[i].look = KnownBody::Look{static_cast<int>(arguments.number("points")),
                                             static_cast<int>(arguments.number("points_needed"))};
    }
    return std::nullopt;
  }
  if (name == "move-torso") {
    const double given = arguments.number("height_m");
    const PlaceSpec* place = arguments.place("place");
    const double height = std::isnan(given) && place != nullptr ? place->p_FP.z() : given;
    state.lift_m = {height - kTorsoTolerance_m, height + kTorsoTolerance_m};
    forget_looks(state);
    assume(fmt::format("the torso stands within {} m of {} m", kTorsoTolerance_m, height));
    return std::nullopt;
  }
  if (name == "park") {
    state.arms[arm_index(spec, arguments)] = KnownArm::kParked;
    assume(fmt::format("the tool is within {} m of where it is carried", assumptions.parked_m));
    return std::nullopt;
  }
  if (name == "open-drawer" || name == "close-drawer") {
    const SliderId slider = *arguments.slider("joint");
    const JointSpec& joint = layout.sliders[slider];
    const double within = arguments.number("stop_tolerance_m");
    const double stop = name == "open-drawer" ? *joint.high_m : *joint.low_m;
    const Bounds1* given = given_slider(assumptions, joint);
    // Beyond the stop by no more than it gives way.
    Bounds1& q = state.slider_m[slider.index()];
    const double beyond = std::min(assumptions.drift_m, within);
    q = name == "open-drawer" ? Bounds1{stop - within, stop + beyond}
                              : Bounds1{stop - beyond, stop + within};
    if (given != nullptr && given->upper >= q.lower && given->lower <= q.upper) q = *given;
    state.arms[arm_index(spec, arguments)] = KnownArm::kAnywhere;
    assume(fmt::format("{}.q is {:.6g} to {:.6g} m", joint.name, q.lower, q.upper));
    for (std::size_t i = 0; i < state.bodies.size(); ++i) {
      if (state.bodies[i].carrier != slider) continue;
      assume(fmt::format("`{}` keeps its place in `{}` within {} m and {} rad",
                         layout.bodies[layout.bodies.id_at(i)].name, joint.child,
                         assumptions.sliding_m, assumptions.sliding_rad));
    }
    return std::nullopt;
  }
  if (name == "pick-up") {
    const BodyId body = *arguments.body("object");
    const std::size_t arm = arm_index(spec, arguments);
    state.arms[arm] = KnownArm::kAnywhere;
    state.bodies[body.index()] = {KnownBody::Where::kHeld,
                                  spec.mobile->arms[arm].name,
                                  state.drives,
                                  state.bodies[body.index()].carrier,
                                  {}};
    assume(
        fmt::format("`{}` is held by the {} arm, within {} m and {} rad of how it was gripped, "
                    "{} m in height, leaning by {} rad at most",
                    layout.bodies[body].name, spec.mobile->arms[arm].name, assumptions.held_m,
                    assumptions.held_rad, assumptions.held_height_m, assumptions.lean_rad));
    return std::nullopt;
  }
  if (name == "drive") {
    const auto target = target_of(layout, state, arguments);
    const PlaceSpec* place = arguments.place("place");
    const double yaw = arguments.number("target.yaw");
    if (!target || (std::isnan(yaw) && place == nullptr)) {
      return fmt::format("where {} leads does not follow from the start", event);
    }
    KnownState::Goal goal;
    goal.p = 0.5 * (target->low + target->high).head<2>();
    goal.within_m = std::min(arguments.number("goal_tolerance_m"), assumptions.goal_m) +
                    0.5 * (target->high - target->low).head<2>().norm();
    goal.yaw_rad = std::isnan(yaw) ? place->yaw_rad : yaw;
    goal.within_rad = std::min(arguments.number("yaw_tolerance_rad"), assumptions.goal_rad);
    state.base_at = goal;
    ++state.drives;
    forget_looks(state);
    state.gaze.reset();  // the neck stays as it was left, and the place may be out of the cone
    assume(fmt::format("the base stands within {} m and {} rad of the goal", goal.within_m,
                       goal.within_rad));
    return std::nullopt;
  }
  if (name == "place" || name == "open-gripper") {
    const std::string arm = spec.mobile->arms[arm_index(spec, arguments)].name;
    for (KnownBody& body : state.bodies) {
      if (body.where == KnownBody::Where::kHeld && body.arm == arm) {
        body.where = KnownBody::Where::kAnywhere;
      }
    }
    KnownArm& arm_state = state.arms[arm_index(spec, arguments)];
    if (name == "place" || arm_state == KnownArm::kAtStart) arm_state = KnownArm::kAnywhere;
    return std::nullopt;
  }
  if (name == "regrip") {
    KnownArm& arm_state = state.arms[arm_index(spec, arguments)];
    if (arm_state == KnownArm::kAtStart) arm_state = KnownArm::kAnywhere;
    return std::nullopt;
  }
  return fmt::format("nothing is known of the world after `{}`", name);
}

AffineForm coordinate(const KnownPoint& point, Eigen::Index axis) {
  const double middle = 0.5 * (point.low(axis) + point.high(axis));
  const double radius = std::max(point.high(axis) - middle, middle - point.low(axis));
  return AffineForm::within(middle, radius * (1.0 + 1e-12));
}

std::optional<KnownPoint> locate(const WorldLayout& layout, const KnownState& state,
                                 const std::string& frame, const Eigen::Vector3d& p_F) {
  KnownPoint point{p_F, p_F};
  if (frame.empty()) return point;
  const auto body = layout.find_body(frame);
  if (!body || layout.bodies[*body].yaw_rad != 0.0 || layout.is_free[body->index()]) {
    return std::nullopt;
  }
  point.low += layout.bodies[*body].p_WB;
  point.high += layout.bodies[*body].p_WB;
  if (!layout.link_of[body->index()]) return point;  // does not move
  const auto slider = slider_of(layout, *body);
  if (!slider || !layout.sliders[*slider].parent.empty()) return std::nullopt;
  const Bounds1 q = state.slider_m[slider->index()];
  const Eigen::Vector3d axis = layout.sliders[*slider].axis_W.normalized();
  const Eigen::Vector3d one = q.lower * axis, other = q.upper * axis;
  const Eigen::Vector3d drift = Eigen::Vector3d::Constant(state.slack.drift_m);
  point.low += one.cwiseMin(other) - drift;
  point.high += one.cwiseMax(other) + drift;
  return point;
}

std::optional<KnownPoint> target_of(const WorldLayout& layout, const KnownState& state,
                                    const Arguments& arguments) {
  KnownPoint point;
  if (const PlaceSpec* place = arguments.place("place")) {
    const auto there = locate(layout, state, place->frame, place->p_FP);
    if (!there) return std::nullopt;
    point = *there;
  }
  const char* names[] = {"target.x", "target.y", "target.z"};
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const double given = arguments.number(names[axis]);
    if (!std::isnan(given)) point.low(axis) = point.high(axis) = given;
  }
  return point;
}

}  // namespace parallax::harness
