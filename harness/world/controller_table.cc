#include <algorithm>
#include <array>
#include <limits>
#include <string_view>

#include "harness/world/arguments.h"

namespace parallax::harness {
namespace {

constexpr double kNoFallback = std::numeric_limits<double>::quiet_NaN();

constexpr std::string_view kUnusedPose = "accepted and unused: this robot works along one line";
constexpr std::string_view kSettle = "rest at the end";
constexpr double kMaxCount = 1000.0;

constexpr ArgumentSpec number(std::string_view name, std::string_view unit, double fallback,
                              std::string_view help) {
  return {name, unit, false, fallback, true, help};
}
constexpr ArgumentSpec within(std::string_view name, double fallback, double low, double high,
                              std::string_view unit, std::string_view help) {
  return {name, unit, false, fallback, true, help, low, high};
}
/// How many of something; at most as many as `at_most` says.
constexpr ArgumentSpec count(std::string_view name, double fallback, std::string_view help,
                             std::string_view at_most = {}) {
  return {name, "1", false, fallback, true, help, 1.0, kMaxCount, true, at_most};
}
constexpr ArgumentSpec any_number(std::string_view name, std::string_view unit,
                                  std::string_view help) {
  return {name, unit, false, kNoFallback, false, help};
}
constexpr ArgumentSpec named(std::string_view name, std::string_view what, std::string_view help,
                             bool required = true) {
  return {name, what, required, 0.0, false, help};
}
constexpr ArgumentSpec settle(double fallback_s) {
  return {"settle_s", "s", false, fallback_s, false, kSettle, 0.0};
}

constexpr ArgumentSpec kArm = named("arm", "arm", "which arm");
constexpr ArgumentSpec kToolSpeed = number("max_speed_m_s", "m/s", 0.25, "of the tool");
constexpr ArgumentSpec kApproachSpeed =
    number("approach_speed_m_s", "m/s", 0.15, "on the last stretch");
constexpr ArgumentSpec kClearance =
    number("clearance_m", "m", 0.005, "of each pad before it closes");
constexpr ArgumentSpec kSqueeze = number("effort_n", "n", 60.0, "squeezing force");

constexpr std::array kGoing = {
    ArgumentSpec{"target.x", "m", true, 0.0, false, "where robot.x is to be"},
    any_number("target.y", "m", kUnusedPose),
    any_number("target.z", "m", kUnusedPose),
    any_number("target.yaw", "rad", kUnusedPose),
    number("max_speed_m_s", "m/s", 0.6, "cruising speed of the base"),
    number("acceleration_m_s2", "m/s^2", 0.8, "of the base"),
    number("goal_tolerance_m", "m", 0.005,
           "the base brakes when so near, and fails when it ends farther away"),
    ArgumentSpec{"settle_s", "s", false, 0.2, true, "rest at the goal"},
};

constexpr std::array kPickingUp = {
    named("object", "body", "the free body to pick up"),
    ArgumentSpec{"grip_force_n", "n", false, kNoFallback, true,
                 "squeezing force; unless given, the robot's"},
    number("tool_tolerance_m", "m", 0.012, "the reach axis brakes when so near to the object"),
    ArgumentSpec{"grasp_height_m", "m", false, 0.0, false,
                 "middle of the pads above the object's origin"},
    number("max_speed_m_s", "m/s", 0.25, "of reach and lift"),
    number("lift_speed_m_s", "m/s", 0.15, "of the lift when loaded"),
    number("close_speed_m_s", "m/s", 0.05, "of the driven pad"),
    number("hold_s", "s", 0.2, "squeezing before the lift"),
    number("settle_s", "s", 0.25, "rest after the lift"),
};

constexpr std::array kPlacing = {
    ArgumentSpec{"target.x", "m", true, 0.0, false, "where the tool is to let go"},
    any_number("target.y", "m", kUnusedPose),
    any_number("target.z", "m", kUnusedPose),
    any_number("target.yaw", "rad", kUnusedPose),
    named("object", "body", "the body that must be held; unless given, whichever is", false),
    number("tool_tolerance_m", "m", 0.012, "the reach axis brakes when so near to the target"),
    number("max_speed_m_s", "m/s", 0.25, "of reach and of the empty lift"),
    number("lower_speed_m_s", "m/s", 0.15, "of the loaded lift"),
    number("open_speed_m_s", "m/s", 0.10, "of the driven pad"),
    number("settle_s", "s", 0.25, "rest after the gripper has left"),
};

constexpr std::array kDrive = {
    named("place", "place", "where to drive, unless the target says", false),
    any_number("target.x", "m", "laid over the place"),
    any_number("target.y", "m", "laid over the place"),
    any_number("target.z", "m", "accepted and unused"),
    any_number("target.yaw", "rad", "laid over the place; the heading at the end"),
    number("max_speed_m_s", "m/s", 0.6, "cruising speed"),
    number("acceleration_m_s2", "m/s^2", 1.0, "of start and braking"),
    number("max_yaw_rate_rad_s", "rad/s", 0.8, "of the turn at the goal"),
    number("yaw_acceleration_rad_s2", "rad/s^2", 1.5, "of the same"),
    number("stop_within_m", "m", 0.002, "[rad] the base brakes when so near to the goal"),
    number("goal_tolerance_m", "m", 0.05, "farther away it has failed"),
    number("yaw_tolerance_rad", "rad", 0.05, "turned farther away it has failed"),
    within("sweep_step_m", 0.01, 0.001, 1.0, "m", "between the places that are tried on the way"),
    settle(0.5),
};

constexpr std::array kLook = {
    named("place", "place", "what to look at", false),
    any_number("target.x", "m", "accepted and unused where a place is named"),
    any_number("target.y", "m", "as target.x"),
    any_number("target.z", "m", "as target.x"),
    any_number("target.yaw", "rad", "as target.x"),
    settle(0.1),
};

constexpr std::array kDetect = {
    named("kind", "kind", "what to look for: `kind` of a body, or its name"),
    count("points", 9, "points along the body that rays are cast at"),
    count("points_needed", 5, "of them, to be in the cone and not hidden", "points"),
    settle(0.1),
};

constexpr std::array kPickUp = {
    kArm,
    named("object", "graspable", "the body to pick up"),
    ArgumentSpec{"effort_n", "n", false, kNoFallback, true,
                 "squeezing force; unless given, that of the grasp"},
    number("clearance_m", "m", 0.015, "of each pad before it closes; less where it opens less"),
    number("standoff_m", "m", 0.10, "of the last, straight stretch"),
    kToolSpeed,
    kApproachSpeed,
    number("hold_s", "s", 0.4, "squeezing before the lift"),
    number("lift_m", "m", 0.12, "height of the lift"),
    number("lift_speed_m_s", "m/s", 0.10, "of the lift"),
    number("lift_acceleration_m_s2", "m/s^2", 0.3, "of the lift"),
    settle(0.3),
};

constexpr std::array kPlace = {
    kArm,
    named("object", "body", "what must be held; unless given, whatever is", false),
    named("place", "place", "where the lowest point is to be", false),
    any_number("target.x", "m", "laid over the place"),
    any_number("target.y", "m", "laid over the place"),
    any_number("target.z", "m", "laid over the place"),
    any_number("target.yaw", "rad", "accepted and unused"),
    number("hover_m", "m", 0.12, "above the place before and after"),
    kToolSpeed,
    number("lower_speed_m_s", "m/s", 0.10, "of the loaded tool going down"),
    number("goal_tolerance_m", "m", 0.05, "farther beside the place it has failed"),
    settle(0.5),
};

constexpr std::array kOpenDrawer = {
    kArm,
    named("joint", "drawer", "the slider to move"),
    kSqueeze,
    kClearance,
    number("standoff_m", "m", 0.20, "of the last, straight stretch"),
    kToolSpeed,
    kApproachSpeed,
    number("pull_speed_m_s", "m/s", 0.15, "of the drawer"),
    number("hold_s", "s", 0.1, "squeezing before the pull"),
    number("stop_tolerance_m", "m", 0.02, "farther from its stop it has failed"),
    settle(0.3),
};

constexpr std::array kCloseDrawer = {
    kArm,
    named("joint", "drawer", "the slider to move"),
    number("standoff_m", "m", 0.20, "of the stretch before the palm meets the handle"),
    kToolSpeed,
    number("pull_speed_m_s", "m/s", 0.15, "of the drawer"),
    number("stop_tolerance_m", "m", 0.02, "farther from its stop it has failed"),
    settle(0.3),
};

constexpr std::array kMoveDoor = {
    kArm,
    named("joint", "door", "the hinge to turn"),
    kSqueeze,
    kClearance,
    number("standoff_m", "m", 0.20, "of the straight stretches to and from the handle"),
    kToolSpeed,
    kApproachSpeed,
    number("pull_speed_m_s", "m/s", 0.20, "of the hand on its arc"),
    number("hold_s", "s", 0.1, "squeezing before the door is moved"),
    number("stop_tolerance_rad", "rad", 0.05, "farther from its stop it has failed"),
    settle(0.3),
};

constexpr std::array kPark = {
    kArm,
    kToolSpeed,
    settle(0.2),
};

constexpr std::array kMoveTorso = {
    named("place", "place", "its z is the height above the lowest", false),
    any_number("height_m", "m", "laid over the place"),
    number("max_speed_m_s", "m/s", 0.05, "of the torso"),
};

constexpr std::array kOpenGripper = {
    kArm,
    settle(0.5),
};

constexpr std::array kRegrip = {
    kArm,
    number("effort_n", "n", 40.0, "squeezing force from now on"),
    number("hold_s", "s", 0.3, "squeezing before the end"),
};

constexpr RobotKind kMobile = RobotKind::kMobile;

constexpr std::array kControllers = {
    ControllerSpec{"close-door", kMoveDoor, "leads a door shut by its handle", kMobile},
    ControllerSpec{"close-drawer", kCloseDrawer, "pushes a drawer shut by its handle", kMobile},
    ControllerSpec{"detect", kDetect, "looks for bodies of a kind where the camera points",
                   kMobile},
    ControllerSpec{"drive", kDrive, "drives straight to a pose and turns there", kMobile},
    ControllerSpec{"going", kGoing, "drives the base along x"},
    ControllerSpec{"look", kLook, "points the camera at a place", kMobile},
    ControllerSpec{"move-torso", kMoveTorso, "lifts or lowers the torso", kMobile},
    ControllerSpec{"open-door", kMoveDoor, "leads a door open by its handle", kMobile},
    ControllerSpec{"open-drawer", kOpenDrawer, "pulls a drawer open by its handle", kMobile},
    ControllerSpec{"open-gripper", kOpenGripper, "opens a gripper wide", kMobile},
    ControllerSpec{"park", kPark, "brings the tool to where it is carried", kMobile},
    ControllerSpec{"pick-up", kPickUp, "grasps a body by friction and lifts it", kMobile},
    ControllerSpec{"picking-up", kPickingUp, "grasps a body between the pads and lifts it"},
    ControllerSpec{"place", kPlace, "sets down what is held", kMobile},
    ControllerSpec{"placing", kPlacing, "sets down what is held"},
    ControllerSpec{"regrip", kRegrip, "squeezes what is held with another force", kMobile},
};

}  // namespace

std::span<const ControllerSpec> controllers() { return kControllers; }

const ControllerSpec* find_controller(std::string_view name) {
  const auto found = std::find_if(kControllers.begin(), kControllers.end(),
                                  [&](const ControllerSpec& spec) { return spec.name == name; });
  return found == kControllers.end() ? nullptr : &*found;
}

}  // namespace parallax::harness
