#include "harness/robot/mobile_controller.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "harness/world/angles.h"

namespace parallax::harness {
namespace {

constexpr double kStep_m = 0.010;    // of the sweeps
constexpr double kRetreat_m = 0.05;  // between the retreats that are tried
constexpr int kRetreats = 11;        // up to 0.5 m
constexpr double kHeight_m = 0.10;   // between the heights
constexpr double kSame_m = 1e-6;

/// Straight ways from a fixed start, in coordinates of the world.
class Ways {
 public:
  Ways(const Sweep& sweep, const Eigen::Vector3d& from) : sweep_(sweep), from_(from) {}

  bool free(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    const auto hit = sweep_.along(a - from_, b - a, kStep_m);
    if (hit) blocked_ = hit;
    return !hit;
  }
  const std::optional<Obstacle>& blocked() const { return blocked_; }

 private:
  const Sweep& sweep_;
  Eigen::Vector3d from_;
  std::optional<Obstacle> blocked_;
};

/// The retreats from `point` from which the way up to `height_m` is free, nearest first.
std::vector<Eigen::Vector3d> shafts(Ways& ways, const Eigen::Vector3d& point,
                                    const Eigen::Vector3d& back, double height_m) {
  std::vector<Eigen::Vector3d> found;
  Eigen::Vector3d last = point;
  for (int i = 0; i < kRetreats && found.size() < 3; ++i) {
    const Eigen::Vector3d foot = point + i * kRetreat_m * back;
    if (!ways.free(last, foot)) break;
    last = foot;
    if (ways.free(foot, {foot.x(), foot.y(), height_m})) found.push_back(foot);
  }
  return found;
}

Eigen::Vector3d raised(const Eigen::Vector3d& p, double height_m) {
  return {p.x(), p.y(), height_m};
}

constexpr double kToolAcceleration_m_s2 = 0.5;
constexpr double kToolTolerance_m = 0.001;
constexpr double kToolApproachRate_hz = 10.0;
constexpr Motion kWrist{1.5, 4.0, kWristTolerance_rad, 10.0};  // radians
constexpr Motion kFinger{0.10, 0.5, kFingerTolerance_m, 10.0};
constexpr double kCloseSpeed_m_s = 0.05;
/// Room round the arm that a way is looked for with, the most first. The last is for ways that
/// begin in touch, as that of a load that was just lifted.
constexpr std::array kRoom_m = {0.04, 0.015, 0.005, -0.002};

}  // namespace

ToolPath find_tool_path(const Sweep& sweep, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                        const Eigen::Vector3d& back, double ceiling_m) {
  Ways ways(sweep, from);
  if (ways.free(from, to)) return {{to}, std::nullopt};
  const double lowest_m = std::max(from.z(), to.z());
  for (double height_m = lowest_m; height_m <= std::max(ceiling_m, lowest_m) + kSame_m;
       height_m += kHeight_m) {
    const auto starts = shafts(ways, from, back, height_m);
    const auto ends = starts.empty() ? starts : shafts(ways, to, back, height_m);
    for (const Eigen::Vector3d& start : starts) {
      for (const Eigen::Vector3d& end : ends) {
        if (!ways.free(raised(start, height_m), raised(end, height_m))) continue;
        ToolPath path;
        Eigen::Vector3d last = from;
        for (const Eigen::Vector3d& corner :
             {start, raised(start, height_m), raised(end, height_m), end, to}) {
          if ((corner - last).norm() > kSame_m) path.corners.push_back(corner);
          last = corner;
        }
        return path;
      }
    }
  }
  return {{}, ways.blocked()};
}

MobileController::MobileController(const ControlContext& context, const Arguments& arguments)
    : PhasedController(context), arguments_(arguments) {
  if (const auto name = arguments.text("arm")) arm_ = context.mobile->find_arm(*name);
}

Motion MobileController::tool_motion() const {
  return {number("max_speed_m_s"), kToolAcceleration_m_s2, kToolTolerance_m, kToolApproachRate_hz};
}

Eigen::Vector3d MobileController::target_point() const {
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  if (const PlaceSpec* place = arguments_.place("place")) p = perception().place_in_world(*place);
  const double x = number("target.x"), y = number("target.y"), z = number("target.z");
  return {std::isnan(x) ? p.x() : x, std::isnan(y) ? p.y() : y, std::isnan(z) ? p.z() : z};
}

bool MobileController::require_reach(const Eigen::Vector3d& tool_W, const std::string& what) {
  const double distance_m = (tool_W - robot().shoulder(arm())).norm();
  const ArmSpec& spec = arm().spec();
  const double margin_m = std::min(spec.max_reach_m - distance_m, distance_m - spec.min_reach_m);
  if (margin_m >= 0.0) return true;
  refuse_with(kManipulationUnreachable,
              fmt::format("{} is {} from the shoulder, the reach is {} to {}", what,
                          metres(distance_m), metres(spec.min_reach_m), metres(spec.max_reach_m)),
              {{"reach", margin_m}});
  return false;
}

BodyMask MobileController::arm_and_load() const {
  BodyMask mask(world().layout().bodies.size(), false);
  for (const BodyId id : arm().bodies()) mask[id.index()] = true;
  if (const auto load = context().grasp.held_body(arm().gripper())) mask[load->index()] = true;
  return mask;
}

Sweep MobileController::arm_sweep(BodyId touched) const {
  BodyMask ignored = robot().parts();
  ignored[touched.index()] = true;
  return {world(), arm_and_load(), ignored, 0.0};
}

void MobileController::add_tool_move(std::string_view name, std::function<Eigen::Vector3d()> target,
                                     Motion motion) {
  add_tool_move_until(name, std::move(target), motion, [] { return false; });
}

void MobileController::add_tool_move_until(std::string_view name,
                                           std::function<Eigen::Vector3d()> target, Motion motion,
                                           std::function<bool()> done) {
  add(
      name,
      [this, target = std::move(target), motion] {
        const Eigen::Vector3d goal = target();
        const double way_m = (goal - arm().tool()).norm();
        arm().move_tool_to(goal, motion);
        return patience_s(way_m, motion);
      },
      [this, done = std::move(done)] { return done() || arm().tool_at_rest(); });
}

void MobileController::add_tool_path(std::string_view name,
                                     std::function<Eigen::Vector3d()> target) {
  add(
      name,
      [this, name, target = std::move(target)] {
        const Eigen::Vector3d goal = target();
        const double ceiling_m = std::max(robot().carry_point(arm()).z(), arm().tool().z()) + 0.1;
        ToolPath path;
        for (std::size_t i = 0; i < kRoom_m.size() && path.corners.empty(); ++i) {
          const Sweep sweep(world(), arm_and_load(), robot().parts(), -kRoom_m[i]);
          path = find_tool_path(sweep, arm().tool(), goal, -robot().base().heading(), ceiling_m);
        }
        if (path.corners.empty()) {
          refuse_with(kManipulationUnreachable,
                      path.blocked ? fmt::format("no free way for the {} arm: `{}` meets `{}`",
                                                 arm().spec().name, path.blocked->part,
                                                 path.blocked->obstacle)
                                   : "no free way");
          return 0.0;
        }
        for (const Eigen::Vector3d& corner : path.corners) {
          add_tool_move(
              name, [corner] { return corner; }, tool_motion());
        }
        return 0.0;
      },
      [] { return true; });
}

void MobileController::add_wrist(double yaw_rad) {
  add(
      "turning",
      [this, yaw_rad] {
        const double way = std::abs(wrapped(yaw_rad - arm().wrist_rad()));
        arm().turn_wrist_to(yaw_rad, kWrist);
        return patience_s(way, kWrist);
      },
      [this] { return arm().tool_at_rest(); });
}

void MobileController::add_opening(std::function<double()> opening_m) {
  add(
      "opening",
      [this, opening_m = std::move(opening_m)] {
        const double goal_m = opening_m();
        const double way_m = std::abs(goal_m - arm().opening_m());
        arm().open_to(goal_m, kFinger);
        return patience_s(way_m, kFinger);
      },
      [this] { return arm().finger_at_rest(); });
}

void MobileController::add_squeeze(double force_n, double hold_s, std::function<bool()> gripped) {
  add(
      "closing",
      [this, force_n, hold_s] {
        arm().squeeze(force_n, kCloseSpeed_m_s);
        return closing_time_s(arm().opening_m(), kCloseSpeed_m_s, hold_s);
      },
      [this, hold_s, gripped = std::move(gripped), lasted = StepsInARow()]() mutable {
        return static_cast<double>(lasted.note(gripped())) * world().timestep_s() >= hold_s;
      });
}

Outcome MobileController::failed(std::string_view condition, const std::string& text,
                                 State margins) {
  return {SimStatus::kFailed, fmt::format("{}: {}", condition, text), 0.0, std::move(margins)};
}

void MobileController::refuse_with(std::string_view condition, const std::string& text,
                                   State margins) {
  robot().brake_all();
  refuse(fmt::format("{}: {}", condition, text), std::move(margins));
}

}  // namespace parallax::harness
