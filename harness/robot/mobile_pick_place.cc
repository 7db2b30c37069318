#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>

#include "harness/robot/mobile_controller.h"
#include "harness/world/angles.h"

namespace parallax::harness {
namespace {

constexpr double kSearch_m = 0.014;  // beyond where the near pad should have met the body

/// Takes hold of a body where it is believed to be, by friction alone, and lifts it.
class PickUp final : public MobileController {
 public:
  PickUp(const ControlContext& context, const Arguments& arguments)
      : MobileController(context, arguments),
        object_(*arguments.body("object")),
        grasp_(*world().layout().bodies[object_].grasp) {
    if (context.grasp.held_by(arm().gripper(), object_)) {
      refuse_with(kGraspFailed, fmt::format("`{}` is held already", name_of(object_)));
    } else if (context.grasp.held_body(arm().gripper())) {
      refuse_with(kGraspFailed, "the gripper is not empty");
    } else if (!perception().belief(object_).perceived || !perception().believed(object_)) {
      refuse_with(kObjectNotFound, fmt::format("`{}` was not perceived", name_of(object_)));
    } else {
      plan();
    }
  }

 private:
  void plan() {
    const double heading_rad = robot().base().pose().yaw_rad;
    const double frame_rad =
        grasp_.follows_body ? perception().belief(object_).yaw_rad : heading_rad;
    const Eigen::AngleAxisd turn(frame_rad, Eigen::Vector3d::UnitZ());
    const double wrist_W = frame_rad + grasp_.wrist_rad;
    // Pads squeeze along y of the palm: a turn by half a circle is the same grasp with the pads
    // exchanged; the smaller turn of the wrist is taken.
    double wrist = wrapped(wrist_W - heading_rad);
    if (wrist > 0.5 * M_PI) wrist -= M_PI;
    if (wrist <= -0.5 * M_PI) wrist += M_PI;
    const Eigen::Vector3d grasp_W = *perception().believed(object_) + turn * grasp_.p_BG;
    // A grasp that the joints do not reach one way round may be within reach the other.
    const double other = wrist > 0.0 ? wrist - M_PI : wrist + M_PI;
    if (!reaches(target_for(grasp_W, wrist), wrist) && reaches(target_for(grasp_W, other), other)) {
      wrist = other;
    }
    to_near_ = arm().pad_line(wrist);
    target_ = target_for(grasp_W, wrist);
    if (!require_reach(target_, wrist, fmt::format("`{}`", name_of(object_)))) return;
    add_phases(wrist, target_ - number("standoff_m") * way_in());
  }

  /// The tool position for a grasp: the near pad passes at the clearance; the far one closes up to
  /// it.
  Eigen::Vector3d target_for(const Eigen::Vector3d& grasp_W, double wrist) const {
    return tool_beside(grasp_W, grasp_.width_m, clearance(), wrist);
  }

  /// The clearance of each pad before it closes; no more than the gripper opens.
  double clearance() const {
    return std::min(number("clearance_m"), 0.5 * (arm().spec().opening_m - grasp_.width_m));
  }

  /// Straight down, or level between the pads, so that neither pad brushes the body on its way.
  Eigen::Vector3d way_in() const {
    if (grasp_.from_above) return -Eigen::Vector3d::UnitZ();
    const Eigen::Vector3d along = to_near_.cross(Eigen::Vector3d::UnitZ()).normalized();
    return along.dot(robot().base().heading()) < 0.0 ? Eigen::Vector3d(-along) : along;
  }

  void add_phases(double wrist, const Eigen::Vector3d& standoff) {
    const double opening_m = std::min(arm().spec().opening_m, grasp_.width_m + 2.0 * clearance());
    add_wrist(wrist);
    add_opening([opening_m] { return opening_m; });
    add_step([this, standoff] { check_last_stretch(standoff); });
    add_tool_path("reaching", [standoff] { return standoff; });
    Motion slow = tool_motion();
    slow.max_speed_m_s = number("approach_speed_m_s");
    add_tool_move(
        "approaching", [this] { return target_; }, slow);
    add_touching();
    const double given = number("effort_n");
    add_squeeze(std::isnan(given) ? grasp_.effort_n : given, number("hold_s"), [this] {
      const Touch& touch = world().touch(object_);
      return touch.near_pad(arm().gripper()) && touch.far_pad(arm().gripper());
    });
    const Motion loaded{number("lift_speed_m_s"), number("lift_acceleration_m_s2"), 0.001, 10.0};
    add_tool_move(
        "lifting",
        [this] {
          return Eigen::Vector3d(arm().tool() + number("lift_m") * Eigen::Vector3d::UnitZ());
        },
        loaded);
    add_pause("settling", number("settle_s"));
  }

  /// Brings the near pad to the body, so that the far one does not tip it over.
  void add_touching() {
    static constexpr Motion kTouching{0.02, 1.0, 0.0005, 10.0};
    const double way_m = clearance() + kSearch_m;
    add_tool_move_until(
        "touching", [this, way_m] { return Eigen::Vector3d(arm().tool() - way_m * to_near_); },
        kTouching, [this] { return world().touch(object_).near_pad(arm().gripper()); });
    add_step([this] { arm().brake(); });
  }

  /// The way in and the lift are straight: what is in their way makes the pose unreachable.
  void check_last_stretch(const Eigen::Vector3d& standoff) {
    ArmWays ways = arm_ways(object_, 0.0);
    auto fault = ways.along(standoff, target_);
    if (!fault) fault = ways.along(target_, target_ + number("lift_m") * Eigen::Vector3d::UnitZ());
    if (!fault) return;
    refuse_way(*fault, fmt::format("at `{}`", name_of(object_)));
  }

  Outcome judge(std::string_view overdue) override {
    if (context().grasp.held_by(arm().gripper(), object_)) {
      perception().forget(object_);
      const Eigen::Vector3d offset = world().position(object_) - arm().tool();
      return {SimStatus::kOk, {}, 0.0, {{"grasp_offset", offset.head<2>().norm()}}};
    }
    return failed(
        kGraspFailed,
        with_overdue(fmt::format("`{}` is not held after the lift", name_of(object_)), overdue));
  }

  BodyId object_;
  GraspSpec grasp_;
  Eigen::Vector3d target_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d to_near_ = Eigen::Vector3d::UnitY();
};

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
    const BodyBounds load = world().bounds(*object_);
    const Eigen::Vector3d p = world().position(*object_);
    const Eigen::Vector3d from_load = arm().tool() - Eigen::Vector3d(p.x(), p.y(), load.low.z());
    set_down_ = goal_ + from_load;
    if (!require_reach(set_down_, arm().wrist_rad(), "the place")) return;
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

std::unique_ptr<Controller> make_pick_up(const ControlContext& context,
                                         const Arguments& arguments) {
  return std::make_unique<PickUp>(context, arguments);
}

std::unique_ptr<Controller> make_place(const ControlContext& context, const Arguments& arguments) {
  return std::make_unique<Place>(context, arguments);
}

}  // namespace parallax::harness
