// Which tests of a trace's actions can be decided by the start alone.
//
// The actions are gone through in order with what is known of the state: where each thing was at
// the start, and what the actions before have done if they succeeded (known_state.cc). For each
// action, tests of its controller are made that depend on nothing else: the sweep of a drive,
// reach of a handle, gaze, the last stretch of a grasp. Each test gets its check and a second
// evaluation (drive_check.cc, second_drive.cc). Where something is not known, the action is left
// to simulation and the reason is told; after an action whose effects cannot be known, nothing
// is. Linear in the actions.

#include "harness/geometry_proof/trace_proof.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "harness/geometry_proof/hand_shapes.h"
#include "harness/robot/mobile_robot.h"
#include "harness/world/shapes.h"

namespace parallax::harness {
namespace {

/// The input for the examination of an action.
struct ActionInput {
  const WorldSpec& spec;
  const WorldLayout& layout;
  const StartCuboid& region;
  const Arguments& arguments;
  const KnownState& state;
};

std::unique_ptr<ActionTest> test_of(const ActionInput& in) {
  return std::make_unique<ActionTest>(in.spec, in.layout, in.region, in.state);
}

void add_drive(const ActionInput& in, ProvableAction& action) {
  const PlaceSpec* place = in.arguments.place("place");
  const auto target = target_of(in.layout, in.state, in.arguments);
  const double given = in.arguments.number("target.yaw");
  if (!target || (place == nullptr && (std::isnan(in.arguments.number("target.x")) ||
                                       std::isnan(in.arguments.number("target.y"))))) {
    action.left_to_simulation = "where it leads does not follow from the start";
    return;
  }
  if (std::isnan(given) && place == nullptr) {
    action.left_to_simulation = "its heading at the goal is the one that it begins with";
    return;
  }
  auto test = test_of(in);
  if (!test->scene().unknown().empty()) {
    action.left_to_simulation = fmt::format("the actions before it leave open where {} may be",
                                            fmt::join(test->scene().unknown(), ", "));
    return;
  }
  const double yaw_rad = std::isnan(given) ? place->yaw_rad : given;
  const double step_m = in.arguments.number("sweep_step_m");
  const ProofScene& scene = test->scene();
  test->set(make_drive_check(scene, *target, yaw_rad, step_m),
            make_second_drive(in.spec, in.layout, scene.region(), test->state(), *target, yaw_rad,
                              step_m));
  action.tests.push_back(std::move(test));
}

std::size_t arm_of(const ActionInput& in) {
  const auto& arms = in.spec.mobile->arms;
  const auto name = in.arguments.text("arm");
  const auto found =
      std::find_if(arms.begin(), arms.end(), [&](const ArmSpec& arm) { return arm.name == name; });
  return static_cast<std::size_t>(found - arms.begin());
}

KnownPoint shifted(const KnownPoint& point, const Eigen::Vector3d& by) {
  return {point.low + by, point.high + by};
}

/// The hand at the handle, and where it has moved it to, are within reach: the first thing that
/// opening and closing ask.
void add_drawer(const ActionInput& in, bool opens, ProvableAction& action) {
  const SliderId slider = *in.arguments.slider("joint");
  const JointSpec& joint = in.layout.sliders[slider];
  const HandleSpec& handle = *joint.handle;
  const Bounds1 q = in.state.slider_m[slider.index()];
  const double goal = opens ? *joint.high_m : *joint.low_m;
  const double drift = in.state.slack.drift_m, within = in.arguments.number("stop_tolerance_m");
  const Bounds1 left{goal - q.upper - drift, goal - q.lower + drift};
  const auto at = locate(in.layout, in.state, joint.child, handle.p_CH);
  auto test = test_of(in);
  const std::size_t index = arm_of(in);
  const ArmGeometry& arm = test->scene().arm(index);
  const bool is_free =
      std::none_of(in.state.bodies.begin(), in.state.bodies.end(), [&](const KnownBody& body) {
        return body.where == KnownBody::Where::kHeld &&
               body.arm == in.spec.mobile->arms[index].name;
      });
  if (!at || (left.lower <= within && left.upper >= -within) || (opens && !is_free)) {
    action.left_to_simulation = "whether there is anything to do does not follow from the start";
    return;
  }
  // The wrist turns the hand to one heading in the world, whatever the base's is.
  const Eigen::AngleAxisd turn(handle.wrist_rad - test->scene().base_yaw_rad(),
                               Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d axis = joint.axis_W.normalized();
  Eigen::Vector3d hand;  // from the handle
  if (opens) {
    hand = -(turn * arm.pad_line_W) * (0.5 * in.spec.mobile->arms[index].opening_m -
                                       0.5 * handle.width_m - in.arguments.number("clearance_m"));
  } else {
    const Eigen::Vector3d ahead = left.lower > 0.0 ? axis : Eigen::Vector3d(-axis);
    const Eigen::Vector3d in_palm = arm.R_WP.transpose() * (turn.inverse() * ahead);
    const double half = 0.5 * in_palm.cwiseAbs().dot(arm.palm_size_m);
    hand = -arm.palm_offset - ahead * (0.5 * handle.width_m + half);
  }
  // The hand goes on a little beyond the stop.
  const double beyond = std::copysign(kBeyondStop_m, left.lower);
  const Eigen::Vector3d one = (left.lower + beyond) * axis, other = (left.upper + beyond) * axis;
  const KnownPoint grip = shifted(*at, hand);
  const KnownPoint end{grip.low + one.cwiseMin(other), grip.high + one.cwiseMax(other)};
  const CheckedTest about{
      std::string(opens ? "open-drawer" : "close-drawer"),
      opens ? "OpenDrawer::plan, require_reach" : "CloseDrawer::plan, require_reach",
      "harness/robot/mobile_drawer.cc", "manipulation-pose-unreachable",
      "the handle is within the arm's reach, where it is and where it is moved to"};
  const ProofScene& scene = test->scene();
  test->set(
      make_reach_check(scene, about, index, {grip, end}),
      make_second_reach(in.spec, in.layout, scene.region(), test->state(), index, {grip, end}));
  action.tests.push_back(std::move(test));
}

void add_look(const ActionInput& in, ProvableAction& action) {
  const PlaceSpec* place = in.arguments.place("place");
  if (place == nullptr && std::isnan(in.arguments.number("target.x"))) {
    action.left_to_simulation = "it is told neither a place nor a target";
    return;
  }
  const auto there = place != nullptr ? locate(in.layout, in.state, place->frame, place->p_FP)
                                      : target_of(in.layout, in.state, in.arguments);
  if (!there) {
    action.left_to_simulation = "where it looks does not follow from the start";
    return;
  }
  auto test = test_of(in);
  const ProofScene& scene = test->scene();
  test->set(make_gaze_check(scene, *there),
            make_second_gaze(in.spec, in.layout, scene.region(), test->state(), *there));
  action.tests.push_back(std::move(test));
}

void add_pick_up(const ActionInput& in, ProvableAction& action) {
  const BodyId object = *in.arguments.body("object");
  auto test = test_of(in);
  const ProofScene& scene = test->scene();
  const auto elsewhere = std::find_if(scene.unknown().begin(), scene.unknown().end(),
                                      [](const std::string& what) { return what.front() == '`'; });
  if (in.state.bodies[object.index()].where != KnownBody::Where::kAtStart ||
      elsewhere != scene.unknown().end()) {
    action.left_to_simulation = "where things are does not follow from the start";
    return;
  }
  const auto descent = descent_of(scene, arm_of(in), object, in.arguments);
  if (!descent) {
    action.left_to_simulation =
        "the hand does not come from above, or not as the body is turned, or where the body was "
        "seen from is not known";
    return;
  }
  if (in.spec.mobile->camera.detection.confusion_rate > 0.0) {
    action.left_to_simulation = "the camera may take something else for it";
    return;
  }
  test->assume(fmt::format("the hand turns and opens as it is to, within {} rad and {} m",
                           kWristTolerance_rad, kFingerTolerance_m));
  test->assume(
      fmt::format("`{}` is believed to be within {:.3g} m and {:.3g} rad of where it is seen",
                  in.layout.bodies[object].name, descent->error_m, descent->error_rad));
  test->set(make_hand_check(scene, *descent),
            make_second_hand(in.spec, in.layout, scene.region(), test->state(), arm_of(in), object,
                             *descent));
  action.tests.push_back(std::move(test));
}

void add_tests(const ActionInput& in, std::string_view controller, ProvableAction& action) {
  if (controller == "drive") return add_drive(in, action);
  if (controller == "open-drawer") return add_drawer(in, true, action);
  if (controller == "close-drawer") return add_drawer(in, false, action);
  if (controller == "look") return add_look(in, action);
  if (controller == "pick-up") return add_pick_up(in, action);
  action.left_to_simulation = "no test of its controller is decided by the start alone";
}

/// Does the world have only parts that the tests support? These are upright boxes, without hinges,
/// joints that follow others and bodies that are kept apart.
bool is_of_upright_boxes(const WorldLayout& layout) {
  const auto follows = [](const JointSpec& joint) { return joint.follows.has_value(); };
  return layout.hinges.empty() &&
         std::none_of(layout.sliders.begin(), layout.sliders.end(), follows) &&
         std::all_of(layout.bodies.begin(), layout.bodies.end(), [](const BodySpec& body) {
           return body.apart.empty() &&
                  std::all_of(body.shapes.begin(), body.shapes.end(), &is_upright_box);
         });
}

}  // namespace

std::vector<ProvableAction> provable_actions(const WorldSpec& spec, const WorldLayout& layout,
                                             const StartCuboid& region,
                                             const std::vector<ProofAction>& actions,
                                             const ProofAssumptions& assumptions) {
  std::vector<ProvableAction> all;
  KnownState state = state_at_start(spec, layout, region);
  std::string lost;  // why nothing is known any more
  for (std::size_t i = 0; i < actions.size(); ++i) {
    ProvableAction action{i, actions[i].event, actions[i].controller, {}, lost};
    const ControllerSpec* controller = find_controller(actions[i].controller);
    if (lost.empty() && controller == nullptr) {
      lost = action.left_to_simulation = fmt::format("no controller `{}`", actions[i].controller);
    }
    if (lost.empty() && !spec.mobile) {
      lost = action.left_to_simulation = "the world has no mobile robot";
    }
    if (lost.empty() && !is_of_upright_boxes(layout)) {
      lost = action.left_to_simulation =
          "the world has shapes that are no upright boxes, or hinges";
    }
    if (lost.empty()) {
      const auto checked = Arguments::check(*controller, actions[i].arguments, spec, layout);
      if (const auto* message = std::get_if<std::string>(&checked)) {
        lost = action.left_to_simulation = *message;
      } else {
        const Arguments& arguments = std::get<Arguments>(checked);
        add_tests({spec, layout, region, arguments, state}, controller->name, action);
        if (const auto why = assume_success(spec, layout, actions[i].event, *controller, arguments,
                                            assumptions, state)) {
          lost = *why;
        }
      }
    }
    all.push_back(std::move(action));
  }
  return all;
}

}  // namespace parallax::harness
