#include <fmt/format.h>

#include <cmath>

#include "harness/robot/mobile_controller.h"

namespace parallax::harness {
namespace {

/// The load is led this far below where its support should be.
constexpr double kOvertravel_m = 0.010;

/// Sets down what is held at a place, lets go and draws the gripper back upwards.
class Place final : public MobileController {
 public:
  Place(const ControlContext& context, const Arguments& arguments)
      : MobileController(context, arguments), object_(held()) {
    if (!object_) {
      refuse_with(kGraspFailed, "nothing to place is held");
      return;
    }
    goal_ = target_point();
    const double hover_m = number("hover_m");
    // The load keeps its place in the gripper: its lowest point is to come to the place.
    const Bounds load = world().bounds(*object_);
    const Eigen::Vector3d p = world().position(*object_);
    const Eigen::Vector3d from_load = arm().tool() - Eigen::Vector3d(p.x(), p.y(), load.low.z());
    set_down_ = goal_ + from_load;
    if (!require_reach(set_down_, "the place")) return;
    const Eigen::Vector3d above = set_down_ + hover_m * Eigen::Vector3d::UnitZ();
    add_tool_path("reaching", [above] { return above; });
    add_lowering();
    add_opening([this] { return arm().spec().opening_m; });
    add_tool_move(
        "drawing back",
        [this, hover_m] {
          return Eigen::Vector3d(arm().tool() + hover_m * Eigen::Vector3d::UnitZ());
        },
        tool_motion());
    add_pause("settling", number("settle_s"));
  }

 private:
  std::optional<BodyId> held() const {
    const auto load = context().grasp.held_body(arm().gripper());
    const auto named = arguments().body("object");
    if (named && load != named) return std::nullopt;
    return load;
  }

  void add_lowering() {
    const Motion slow{number("lower_speed_m_s"), 0.3, 0.001, 10.0};
    add(
        "lowering",
        [this, slow] {
          if (!context().grasp.held_by(arm().gripper(), *object_)) {
            refuse_with(kGraspFailed, fmt::format("`{}` was lost on the way", name_of(*object_)));
            return 0.0;
          }
          const Eigen::Vector3d down = set_down_ - kOvertravel_m * Eigen::Vector3d::UnitZ();
          arm().move_tool_to(down, slow);
          return patience_s((down - arm().tool()).norm(), slow);
        },
        [this] { return supported(*object_) || arm().tool_at_rest(); });
    add_step([this] { arm().brake(); });
  }

  Outcome judge(std::string_view) override {
    if (context().grasp.held_by(arm().gripper(), *object_)) {
      return failed(kGoalNotReached,
                    fmt::format("`{}` did not come off the gripper", name_of(*object_)));
    }
    perception().believe_as_is(*object_);
    const double error_m = (world().position(*object_) - goal_).head<2>().norm();
    const State margins{{"goal", number("goal_tolerance_m") - error_m}};
    if (error_m <= number("goal_tolerance_m")) return {SimStatus::kOk, {}, 0.0, margins};
    return failed(kGoalNotReached,
                  fmt::format("`{}` lies {} beside the place", name_of(*object_), metres(error_m)),
                  margins);
  }

  std::optional<BodyId> object_;
  Eigen::Vector3d goal_ = Eigen::Vector3d::Zero(), set_down_ = Eigen::Vector3d::Zero();
};

}  // namespace

std::unique_ptr<Controller> make_place(const ControlContext& context, const Arguments& arguments) {
  return std::make_unique<Place>(context, arguments);
}

}  // namespace parallax::harness
