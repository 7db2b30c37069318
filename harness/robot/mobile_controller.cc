#include "harness/robot/mobile_controller.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "harness/world/angles.h"

namespace parallax::harness {
namespace {

constexpr double kToolAcceleration_m_s2 = 0.5;
constexpr double kToolTolerance_m = 0.001;
constexpr double kToolApproachRate_hz = 10.0;
constexpr Motion kWrist{1.5, 4.0, kWristTolerance_rad, 10.0};  // radians
constexpr Motion kSwing{0.8, 1.6, 0.002, 10.0};                // radians of the farthest joint
constexpr Motion kFinger{0.10, 0.5, kFingerTolerance_m, 10.0};
constexpr double kCloseSpeed_m_s = 0.05;
/// Room round the arm that a way is looked for with, the most first. The last is for ways that
/// begin in touch, as that of a load that was just lifted.
constexpr std::array kRoom_m = {0.04, 0.015, 0.005, -0.002};

}  // namespace

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

/// The margin to the nearer limit of a gantry's reach [m]; below 0: out of reach.
double MobileController::reach_margin_m(const Eigen::Vector3d& tool_W) const {
  const double distance_m = (tool_W - robot().shoulder(arm())).norm();
  const ArmSpec& spec = arm().spec();
  return std::min(spec.max_reach_m - distance_m, distance_m - spec.min_reach_m);
}

bool MobileController::reaches(const Eigen::Vector3d& tool_W, double wrist_rad) const {
  if (arm().chain() != nullptr) return arm().chain()->reach(tool_W, wrist_rad).reached;
  return reach_margin_m(tool_W) >= 0.0;
}

bool MobileController::require_reach(const Eigen::Vector3d& tool_W, double wrist_rad,
                                     const std::string& what) {
  if (arm().chain() != nullptr) return require_chain_reach(tool_W, wrist_rad, what);
  const double margin_m = reach_margin_m(tool_W);
  if (margin_m >= 0.0) return true;
  const double distance_m = (tool_W - robot().shoulder(arm())).norm();
  const ArmSpec& spec = arm().spec();
  refuse_with(kManipulationUnreachable,
              fmt::format("{} is {} from the shoulder, the reach is {} to {}", what,
                          metres(distance_m), metres(spec.min_reach_m), metres(spec.max_reach_m)),
              {{"reach", margin_m}});
  return false;
}

bool MobileController::require_chain_reach(const Eigen::Vector3d& tool_W, double wrist_rad,
                                           const std::string& what) {
  const PalmChain& chain = *arm().chain();
  const InverseResult found = chain.reach(tool_W, wrist_rad);
  if (found.reached) return true;
  std::string text = fmt::format(
      "{} is beyond the joints of the {} arm: the tool comes to within "
      "{} and {:.2f} rad",
      what, arm().spec().name, metres(found.short_m), found.short_rad);
  const auto& joints = chain.arm().chain.joints();
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if ((found.at_stop >> i & 1U) != 0) text += fmt::format(", `{}` at its stop", joints[i].name);
  }
  refuse_with(kManipulationUnreachable, text, {{"reach", -found.short_m}});
  return false;
}

ArmWays MobileController::arm_ways(std::optional<BodyId> touched, double tolerance_m) const {
  BodyMask ignored(world().layout().bodies.size(), false);
  if (touched) ignored[touched->index()] = true;
  return {
      world(),         arm(),      context().grasp.held_body(arm().gripper()), std::move(ignored),
      robot().parts(), tolerance_m};
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

ToolPath MobileController::find_path(const Eigen::Vector3d& goal, double ceiling_m) const {
  ToolPath path;
  for (const double room_m : kRoom_m) {
    ArmWays ways = arm_ways(std::nullopt, -room_m);
    const StretchTest test = [&ways](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
      return ways.along(a, b);
    };
    path = find_tool_path(test, arm().tool(), goal, -robot().base().heading(), ceiling_m);
    // Each stretch is free in some posture; the arm has to be led through all in a row.
    auto fault = ways.follow(path.corners);
    if (!fault && !path.corners.empty()) return path;
    if (fault) path = {{}, std::move(fault)};
  }
  return path;
}

bool MobileController::add_swings(const Eigen::Vector3d& goal) {
  for (const double room_m : kRoom_m) {
    const auto ways = arm_ways(std::nullopt, -room_m).swings(goal);
    if (ways.empty()) continue;
    for (const ChainWay& way : ways) {
      const double farthest = (way.last() - way.samples.front()).cwiseAbs().maxCoeff();
      add(
          "swinging",
          [this, way, farthest] {
            arm().swing_along(way, kSwing);
            return patience_s(farthest, kSwing);
          },
          [this] { return arm().tool_at_rest(); });
    }
    add_tool_move(
        "reaching", [goal] { return goal; }, tool_motion());
    return true;
  }
  return false;
}

void MobileController::add_tool_path(std::string_view name,
                                     std::function<Eigen::Vector3d()> target) {
  add(
      name,
      [this, name, target = std::move(target)] {
        const Eigen::Vector3d goal = target();
        const double ceiling_m = std::max(robot().carry_point(arm()).z(), arm().tool().z()) + 0.1;
        const ToolPath path = find_path(goal, ceiling_m);
        if (path.corners.empty() && add_swings(goal)) return 0.0;
        if (path.corners.empty()) {
          refuse_with(kManipulationUnreachable,
                      path.blocked ? fmt::format("no free way for the {} arm: {}",
                                                 arm().spec().name, path.blocked->text())
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
        // A wrist that cannot turn here turns on its way to where it works.
        if (!arm_ways(std::nullopt, 0.0).turns_on_the_spot(yaw_rad)) {
          arm().aim_wrist(yaw_rad);
          return 0.0;
        }
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

void MobileController::add_handle_squeeze(const HandleSpec& handle) {
  add_squeeze(number("effort_n"), number("hold_s"), [this, width_m = handle.width_m] {
    return arm().opening_m() <= width_m + 2.0 * number("clearance_m") + 0.002;
  });
}

Eigen::Vector3d MobileController::tool_beside(const Eigen::Vector3d& p_W, double width_m,
                                              double clearance_m, double wrist_rad) const {
  return p_W -
         arm().pad_line(wrist_rad) * (0.5 * arm().spec().opening_m - 0.5 * width_m - clearance_m);
}

void MobileController::refuse_way(const WayFault& fault, const std::string& where) {
  State margins;
  if (fault.hit && fault.hit->clearance_m) margins["clearance"] = *fault.hit->clearance_m;
  refuse_with(kManipulationUnreachable, where + " " + fault.text("would meet"), std::move(margins));
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
