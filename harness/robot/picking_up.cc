#include <fmt/format.h>

#include <cmath>

#include "harness/robot/line_controller.h"

namespace parallax::harness {
namespace {

constexpr double kToolApproachRate_hz = 3.0;  // slow near the object
constexpr double kFreeApproachRate_hz = 10.0;
constexpr double kToolAcceleration_m_s2 = 0.5;
constexpr double kLoadedAcceleration_m_s2 = 0.3;
constexpr double kAxisTolerance_m = 0.001;
constexpr double kCloseAcceleration_m_s2 = 0.5;
constexpr double kCloseGrace_s = 0.5;

/// Raises, opens, moves the tool over the object, lowers, squeezes, lifts.
class PickingUp final : public LineController {
 public:
  PickingUp(const ControlContext& context, const Arguments& arguments)
      : LineController(context), arguments_(arguments), object_(*arguments.body("object")) {
    const Eigen::Vector3d p_TO = object_from_tool();
    const double reach_m = robot().position_m(Axis::kReach) + p_TO.x();
    const double beyond_m = robot().beyond_stops_m(Axis::kReach, reach_m);
    if (beyond_m > 0.0) {
      refuse(fmt::format("out of reach: {} lies {} beyond the end of the arm", name(),
                         metres(beyond_m)),
             {{"reach", -beyond_m}});
      return;
    }
    const double height_m = robot().position_m(Axis::kLift) + p_TO.z();
    const double below_m = robot().beyond_stops_m(Axis::kLift, height_m);
    if (below_m > 0.0) {
      refuse(fmt::format("out of reach: {} lies {} beyond the end of the lift", name(),
                         metres(below_m)),
             {{"reach", -below_m}});
      return;
    }
    if (context.grasp.held(object_)) {
      refuse(name() + " is held already");
      return;
    }
    add_phases();
  }

 private:
  std::string name() const { return "`" + context().world.layout().bodies[object_].name + "`"; }

  /// From the tool to the middle of the grasp, as measured now.
  Eigen::Vector3d object_from_tool() const {
    Eigen::Vector3d p = context().world.position(object_) - robot().tool();
    p.z() += arguments_.number("grasp_height_m");
    return p;
  }

  void add_phases() {
    const double speed = arguments_.number("max_speed_m_s");
    const Motion free{speed, kToolAcceleration_m_s2, kAxisTolerance_m, kFreeApproachRate_hz};
    const Motion over{speed, kToolAcceleration_m_s2, arguments_.number("tool_tolerance_m"),
                      kToolApproachRate_hz};
    const Motion loaded{arguments_.number("lift_speed_m_s"), kLoadedAcceleration_m_s2,
                        kAxisTolerance_m, kFreeApproachRate_hz};
    add_move(
        "raising", Axis::kLift, [] { return 0.0; }, free);
    add_move(
        "opening", Axis::kFinger,
        [this] { return robot().finger_position_for(robot_spec().opening_m); }, free);
    add_move(
        "reaching", Axis::kReach,
        [this] { return robot().position_m(Axis::kReach) + object_from_tool().x(); }, over);
    add_move(
        "lowering", Axis::kLift,
        [this] { return robot().position_m(Axis::kLift) + object_from_tool().z(); }, free);
    add(
        "closing", [this] { return begin_closing(); }, [this] { return squeezed_long_enough(); });
    add_move(
        "lifting", Axis::kLift, [] { return 0.0; }, loaded);
    add_pause("settling", arguments_.number("settle_s"));
  }

  double begin_closing() {
    // A blocked tool stays where it got to.
    robot().brake(Axis::kLift);
    robot().brake(Axis::kReach);
    const double given = arguments_.number("grip_force_n");
    const double speed = arguments_.number("close_speed_m_s");
    robot().squeeze(std::isnan(given) ? robot_spec().grip_force_n : given, speed,
                    kCloseAcceleration_m_s2);
    return robot().opening_m() / speed + arguments_.number("hold_s") + kCloseGrace_s;
  }

  bool squeezed_long_enough() {
    const Touch& touch = context().world.touch(object_);
    squeezed_steps_ = touch.near_pad() && touch.far_pad() ? squeezed_steps_ + 1 : 0;
    return static_cast<double>(squeezed_steps_) * context().world.timestep_s() >=
           arguments_.number("hold_s");
  }

  Outcome judge(std::string_view overdue) override {
    Outcome outcome;
    if (context().grasp.held(object_)) {
      outcome.margins["grasp_offset"] = object_from_tool().x();
      return outcome;
    }
    outcome.status = SimStatus::kFailed;
    outcome.reason = name() + " is not held after the lift";
    if (!overdue.empty()) outcome.reason += fmt::format(" ({} did not come to its end)", overdue);
    return outcome;
  }

  Arguments arguments_;
  BodyId object_;
  std::int64_t squeezed_steps_ = 0;
};

}  // namespace

std::unique_ptr<Controller> make_picking_up(const ControlContext& context,
                                            const Arguments& arguments) {
  return std::make_unique<PickingUp>(context, arguments);
}

}  // namespace parallax::harness
