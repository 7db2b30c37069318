#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "harness/world/mobile_controller.h"

namespace parallax::harness {
namespace {

constexpr double kPull_acceleration_m_s2 = 0.3;
constexpr double kBeyondStop_m = 0.005;  // the hand goes on a little, so that the stop is met

/// Takes a drawer by its handle and moves it to one of its stops.
class MoveDrawer final : public MobileController {
 public:
  MoveDrawer(const ControlContext& context, const Arguments& arguments, bool opens)
      : MobileController(context, arguments), slider_(*arguments.slider("joint")) {
    const JointSpec& joint = world().layout().sliders[slider_];
    handle_ = *joint.handle;
    child_ = *world().layout().find_body(joint.child);
    // The far stop is the open end; 0 is the default placement, on the way between them.
    goal_m_ = opens ? *joint.high_m : *joint.low_m;
    if (context.grasp.held_body(arm().gripper())) {
      refuse_with(kGraspFailed, "the gripper is not empty");
      return;
    }
    const double left_m = goal_m_ - world().slider_position_m(slider_);
    if (std::abs(left_m) <= number("stop_tolerance_m")) return;  // it is there
    plan(joint, left_m);
  }

 private:
  void plan(const JointSpec& joint, double left_m) {
    const double heading_rad = robot().base().pose().yaw_rad;
    const double wrist = wrapped(handle_.wrist_rad - heading_rad);
    const Eigen::Vector3d to_near =
        Eigen::AngleAxisd(wrist - arm().wrist_rad(), Eigen::Vector3d::UnitZ()) * arm().pad_line();
    const double clearance_m = number("clearance_m");
    const Eigen::Vector3d grip =
        world().position(child_) + world().rotation(child_) * handle_.p_CH -
        to_near * (0.5 * arm().spec().opening_m - 0.5 * handle_.width_m - clearance_m);
    const Eigen::Vector3d travel =
        joint.axis_W.normalized() * (left_m + std::copysign(kBeyondStop_m, left_m));
    const std::string what = fmt::format("the handle of `{}`", joint.name);
    if (!require_reach(grip, what) || !require_reach(grip + travel, what)) return;
    const Eigen::Vector3d standoff = grip - number("standoff_m") * handle_.approach.normalized();
    add_wrist(wrist);
    add_opening([this] { return arm().spec().opening_m; });
    add_tool_path(
        "reaching", [standoff] { return standoff; }, std::nullopt);
    Motion slow = tool_motion();
    slow.max_speed_m_s = number("approach_speed_m_s");
    add_step([this, standoff, grip] { check_grip(standoff, grip); });
    add_tool_move(
        "approaching", [grip] { return grip; }, slow);
    // The pads close on a bar that cannot give way: a time, not a touch, ends it.
    add_squeeze(number("effort_n"), number("hold_s"), [this] {
      return arm().opening_m() <= handle_.width_m + 2.0 * number("clearance_m") + 0.002;
    });
    const Motion pull{number("pull_speed_m_s"), kPull_acceleration_m_s2, 0.001, 10.0};
    add_tool_move(
        "pulling", [this, travel] { return Eigen::Vector3d(arm().tool() + travel); }, pull);
    add_step([this] { arm().brake(); });
    add_opening([this] { return arm().spec().opening_m; });
    add_tool_move(
        "drawing back",
        [this] {
          return Eigen::Vector3d(arm().tool() -
                                 number("standoff_m") * handle_.approach.normalized());
        },
        tool_motion());
    add_pause("settling", number("settle_s"));
  }

  void check_grip(const Eigen::Vector3d& standoff, const Eigen::Vector3d& grip) {
    BodyMask ignored = robot().parts();
    ignored[child_.index()] = true;
    const Sweep sweep(world(), arm_and_load(), ignored, 0.0);
    const auto hit = sweep.along(standoff - arm().tool(), grip - standoff, 0.01);
    if (!hit) return;
    refuse_with(kManipulationUnreachable,
                fmt::format("at the handle `{}` would meet `{}`", hit->part, hit->obstacle));
  }

  Outcome judge(std::string_view overdue) override {
    const double short_m = std::abs(goal_m_ - world().slider_position_m(slider_));
    const State margins{{"stop", number("stop_tolerance_m") - short_m}};
    if (short_m <= number("stop_tolerance_m")) return {SimStatus::kOk, {}, 0.0, margins};
    std::string text = fmt::format("`{}` is {} short of its stop",
                                   world().layout().sliders[slider_].name, metres(short_m));
    if (!overdue.empty()) text += fmt::format(" ({} did not come to its end)", overdue);
    return failed(kGoalNotReached, text, margins);
  }

  SliderId slider_;
  HandleSpec handle_;
  BodyId child_;
  double goal_m_ = 0.0;
};

}  // namespace

std::unique_ptr<Controller> make_open_drawer(const ControlContext& context,
                                             const Arguments& arguments) {
  return std::make_unique<MoveDrawer>(context, arguments, true);
}

std::unique_ptr<Controller> make_close_drawer(const ControlContext& context,
                                              const Arguments& arguments) {
  return std::make_unique<MoveDrawer>(context, arguments, false);
}

}  // namespace parallax::harness
