#include <fmt/format.h>

#include <cmath>
#include <utility>
#include <vector>

#include "harness/robot/mobile_controller.h"
#include "harness/world/angles.h"

namespace parallax::harness {
namespace {

constexpr double kApproachRate_hz = 6.0;

/// Drives the base straight to a pose, with the heading that it has, and turns there. Before it
/// moves, everything that will move is swept along the way.
class Drive final : public MobileController {
 public:
  Drive(const ControlContext& context, const Arguments& arguments)
      : MobileController(context, arguments) {
    const PlaceSpec* place = arguments.place("place");
    if (place == nullptr && (std::isnan(number("target.x")) || std::isnan(number("target.y")))) {
      refuse_with(kNavigationUnreachable, "neither a place nor target.x and target.y are given");
      return;
    }
    target_ = target_point().head<2>();
    const double yaw = number("target.yaw");
    yaw_rad_ = !std::isnan(yaw)   ? yaw
               : place != nullptr ? place->yaw_rad
                                  : robot().base().pose().yaw_rad;
    if (is_blocked()) return;
    for (const Arm& arm : robot().arms()) {
      if (const auto load = context.grasp.held_body(arm.gripper()))
        loads_.emplace_back(&arm, *load);
    }
    add_phases();
  }

 private:
  static State margins_of(const Obstacle& hit) {
    State margins = {{"free_way", hit.way_m}};
    if (hit.clearance_m) margins["clearance"] = *hit.clearance_m;
    return margins;
  }

  bool is_blocked() {
    BodyMask moving = robot().parts();
    for (const Arm& arm : robot().arms()) {
      if (const auto load = context().grasp.held_body(arm.gripper())) {
        moving[load->index()] = true;
      }
    }
    const Sweep sweep(world(), moving, moving, 0.0);
    const PlanarPose now = robot().base().pose();
    const Eigen::Vector3d way(target_.x() - now.p.x(), target_.y() - now.p.y(), 0.0);
    auto hit = sweep.along(Eigen::Vector3d::Zero(), way, number("sweep_step_m"));
    if (!hit) {
      const Eigen::Vector3d goal(target_.x(), target_.y(), 0.0);
      hit = sweep.turning(way, goal, wrapped(yaw_rad_ - now.yaw_rad), kTurnStep_rad);
    }
    if (!hit) return false;
    refuse_with(kNavigationUnreachable,
                fmt::format("`{}` would meet `{}`", hit->part, hit->obstacle), margins_of(*hit));
    return true;
  }

  /// Adds the height by which a carried body still reaches above the middle of its gripper [m];
  /// below zero it has slipped out.
  void add_grip(State& margins) {
    for (const auto& [arm, load] : loads_) {
      const double above_m = world().bounds(load).high.z() - arm->tool().z();
      const auto known = margins.find("grip");
      if (known == margins.end() || above_m < std::get<double>(known->second)) {
        margins["grip"] = above_m;
      }
    }
  }

  void add_phases() {
    const Motion straight{number("max_speed_m_s"), number("acceleration_m_s2"),
                          number("stop_within_m"), kApproachRate_hz};
    const Motion turn{number("max_yaw_rate_rad_s"), number("yaw_acceleration_rad_s2"),
                      number("stop_within_m"), kApproachRate_hz};
    add(
        "driving",
        [this, straight] {
          robot().base().drive_to(target_, straight);
          return patience_s((target_ - robot().base().pose().p).norm(), straight);
        },
        [this] { return robot().base().at_rest(); });
    add(
        "turning",
        [this, turn] {
          robot().base().turn_to(yaw_rad_, turn);
          return patience_s(wrapped(yaw_rad_ - robot().base().pose().yaw_rad), turn);
        },
        [this] { return robot().base().at_rest(); });
    add_step([this] { robot().base().brake(); });
    add_pause("settling", number("settle_s"));
  }

  Outcome judge(std::string_view) override {
    perception().drop_lost_gaze();
    const PlanarPose now = robot().base().pose();
    const double error_m = (target_ - now.p).norm();
    const double error_rad = std::abs(wrapped(yaw_rad_ - now.yaw_rad));
    const double tolerance_m = number("goal_tolerance_m");
    State margins{{"goal", tolerance_m - error_m}};
    add_grip(margins);
    if (error_m <= tolerance_m && error_rad <= number("yaw_tolerance_rad")) {
      return {SimStatus::kOk, {}, 0.0, margins};
    }
    return failed(
        kNavigationUnreachable,
        fmt::format("stopped {} and {:.2f} rad from the goal", metres(error_m), error_rad),
        margins);
  }

  Eigen::Vector2d target_ = Eigen::Vector2d::Zero();
  double yaw_rad_ = 0.0;
  std::vector<std::pair<const Arm*, BodyId>> loads_;  // when it set off
};

}  // namespace

std::unique_ptr<Controller> make_drive(const ControlContext& context, const Arguments& arguments) {
  return std::make_unique<Drive>(context, arguments);
}

}  // namespace parallax::harness
