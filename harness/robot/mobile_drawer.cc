#include <fmt/format.h>

#include <cmath>

#include "harness/robot/mobile_controller.h"
#include "harness/world/angles.h"

namespace parallax::harness {
namespace {

constexpr double kPull_acceleration_m_s2 = 0.3;
constexpr double kAtStop_m = 0.001;

/// The common part of opening and closing: a slider with a handle, and the stop it is to go to.
class MoveDrawer : public MobileController {
 protected:
  MoveDrawer(const ControlContext& context, const Arguments& arguments, bool opens)
      : MobileController(context, arguments), slider_(*arguments.slider("joint")) {
    handle_ = *joint().handle;
    child_ = *world().layout().find_body(joint().child);
    // The far stop is the open end; 0 is the default placement, on the way between them.
    goal_m_ = opens ? *joint().high_m : *joint().low_m;
  }

  const JointSpec& joint() const { return world().layout().sliders[slider_]; }
  const HandleSpec& handle() const { return handle_; }
  /// The rest of the drawer's way, signed.
  double left_m() const { return goal_m_ - world().slider_position_m(slider_); }
  bool is_there() const { return std::abs(left_m()) <= number("stop_tolerance_m"); }
  /// The hand's way, which leads a little beyond the stop.
  Eigen::Vector3d travel() const {
    return joint().axis_W.normalized() * (left_m() + std::copysign(kBeyondStop_m, left_m()));
  }
  Eigen::Vector3d handle_in_world() const {
    return world().position(child_) + world().rotation(child_) * handle_.p_CH;
  }

  /// Both ends of the hand's way are within reach.
  bool require_way(const Eigen::Vector3d& tool_W, double wrist_rad) {
    const std::string what = fmt::format("the handle of `{}`", joint().name);
    return require_reach(tool_W, wrist_rad, what) &&
           require_reach(tool_W + travel(), wrist_rad, what);
  }

  /// Moves the drawer from where the hand is at it, and the hand away from it by `back`.
  void add_moving(const Eigen::Vector3d& travel, bool lets_go, const Eigen::Vector3d& back) {
    const Motion pace{number("pull_speed_m_s"), kPull_acceleration_m_s2, 0.001, 10.0};
    add_tool_move_until(
        "moving it", [this, travel] { return Eigen::Vector3d(arm().tool() + travel); }, pace,
        [this] { return std::abs(left_m()) < kAtStop_m; });
    add_step([this] { arm().brake(); });
    if (lets_go) add_opening([this] { return arm().spec().opening_m; });
    add_tool_move(
        "drawing back", [this, back] { return Eigen::Vector3d(arm().tool() + back); },
        tool_motion());
    add_pause("settling", number("settle_s"));
  }

  void check_way_in(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    const auto fault = arm_ways(child_, 0.0).along(from, to);
    if (!fault) return;
    refuse_way(*fault, "at the handle");
  }

 private:
  Outcome judge(std::string_view overdue) override {
    const double short_m = std::abs(left_m());
    const State margins{{"stop", number("stop_tolerance_m") - short_m}};
    if (is_there()) return {SimStatus::kOk, {}, 0.0, margins};
    const auto text = fmt::format("`{}` is {} short of its stop", joint().name, metres(short_m));
    return failed(kGoalNotReached, with_overdue(text, overdue), margins);
  }

  SliderId slider_;
  HandleSpec handle_;
  BodyId child_;
  double goal_m_ = 0.0;
};

/// Takes a drawer by its handle and pulls it open.
class OpenDrawer final : public MoveDrawer {
 public:
  OpenDrawer(const ControlContext& context, const Arguments& arguments)
      : MoveDrawer(context, arguments, true) {
    if (context.grasp.held_body(arm().gripper())) {
      refuse_with(kGraspFailed, "the gripper is not empty");
    } else if (!is_there()) {
      plan();
    }
  }

 private:
  void plan() {
    const double wrist = wrapped(handle().wrist_rad - robot().base().pose().yaw_rad);
    const Eigen::Vector3d grip =
        tool_beside(handle_in_world(), handle().width_m, number("clearance_m"), wrist);
    if (!require_way(grip, wrist)) return;
    const Eigen::Vector3d back = -number("standoff_m") * handle().approach.normalized();
    const Eigen::Vector3d standoff = grip + back;
    add_wrist(wrist);
    add_opening([this] { return arm().spec().opening_m; });
    add_tool_path("reaching", [standoff] { return standoff; });
    Motion slow = tool_motion();
    slow.max_speed_m_s = number("approach_speed_m_s");
    add_step([this, standoff, grip] { check_way_in(standoff, grip); });
    add_tool_move(
        "approaching", [grip] { return grip; }, slow);
    add_handle_squeeze(handle());
    add_moving(travel(), true, back);
  }
};

/// Pushes a drawer shut with the palm against its handle, whether or not the hand holds something.
class CloseDrawer final : public MoveDrawer {
 public:
  CloseDrawer(const ControlContext& context, const Arguments& arguments)
      : MoveDrawer(context, arguments, false) {
    if (!is_there()) plan();
  }

 private:
  void plan() {
    // Either way round the wrist is as good: the smaller turn is taken.
    double wrist = wrapped(handle().wrist_rad - robot().base().pose().yaw_rad);
    if (wrist - arm().wrist_rad() > 0.5 * M_PI) wrist -= M_PI;
    if (wrist - arm().wrist_rad() < -0.5 * M_PI) wrist += M_PI;
    const Eigen::Vector3d ahead = travel().normalized();
    const Eigen::Vector3d push =
        handle_in_world() - arm().palm_offset() -
        ahead * (0.5 * handle().width_m + arm().palm_half_extent_m(ahead, wrist));
    if (!require_way(push, wrist)) return;
    const Eigen::Vector3d standoff = push - number("standoff_m") * ahead;
    add_wrist(wrist);
    add_tool_path("reaching", [standoff] { return standoff; });
    add_step([this, standoff, push] { check_way_in(standoff, push); });
    add_moving(push + travel() - standoff, false, standoff - push);
  }
};

}  // namespace

std::unique_ptr<Controller> make_open_drawer(const ControlContext& context,
                                             const Arguments& arguments) {
  return std::make_unique<OpenDrawer>(context, arguments);
}

std::unique_ptr<Controller> make_close_drawer(const ControlContext& context,
                                              const Arguments& arguments) {
  return std::make_unique<CloseDrawer>(context, arguments);
}

}  // namespace parallax::harness
