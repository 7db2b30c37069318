#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <optional>
#include <string_view>
#include <utility>

#include "harness/robot/controller.h"

namespace parallax::harness {
namespace {

/// A controller of the robot on a line.
class LineController : public PhasedController {
 protected:
  explicit LineController(const ControlContext& context) : PhasedController(context) {}

  LineRobot& robot() const { return *context().line; }
  const LineRobotSpec& robot_spec() const { return context().spec.robot; }

  /// How axes move while the gripper is empty, and while it holds something.
  static Motion empty_motion(double speed_m_s) { return {speed_m_s, 0.5, 0.001, 10.0}; }
  static Motion loaded_motion(double speed_m_s) { return {speed_m_s, 0.3, 0.001, 10.0}; }
  /// The same, slow near the target, which it has to come no nearer than this.
  static Motion slow_at_end(Motion motion, double tolerance_m) {
    motion.tolerance_m = tolerance_m;
    motion.approach_rate_hz = 3.0;
    return motion;
  }

  /// Moves one axis to `target` (asked when the phase begins), for at most twice the nominal time.
  void add_move(std::string_view name, LineAxis axis, std::function<double()> target,
                Motion motion) {
    add(
        name,
        [this, axis, target = std::move(target), motion] {
          const double goal_m = target();
          robot().move_to(axis, goal_m, motion);
          return patience_s(goal_m - robot().position_m(axis), motion);
        },
        [this, axis] { return robot().at_rest(axis); });
  }
};

constexpr double kCarryTolerance_m = 0.005;
constexpr Motion kRaise{0.15, 0.5, 0.001, 6.0};

/// Drives the base so that robot.x becomes target.x.
class Going final : public LineController {
 public:
  Going(const ControlContext& context, const Arguments& arguments)
      : LineController(context),
        target_x_m_(arguments.number("target.x")),
        tolerance_m_(arguments.number("goal_tolerance_m")) {
    const double goal_m = base_goal();
    const double beyond_m = robot().beyond_stops_m(LineAxis::kBase, goal_m);
    if (beyond_m > 0.0) {
      refuse(fmt::format("target.x {} lies {} beyond the end of the drive", metres(target_x_m_),
                         metres(beyond_m)));
      return;
    }
    // A tool left low would be dragged along the floor.
    if (std::abs(robot().position_m(LineAxis::kLift)) > kCarryTolerance_m) {
      add_move(
          "raising", LineAxis::kLift, [] { return 0.0; }, kRaise);
    }
    const Motion drive{arguments.number("max_speed_m_s"), arguments.number("acceleration_m_s2"),
                       tolerance_m_, kRaise.approach_rate_hz};
    add_move(
        "driving", LineAxis::kBase, [this] { return base_goal(); }, drive);
    add_braking([this] { robot().brake(LineAxis::kBase); },
                [this] { return robot().at_rest(LineAxis::kBase); });
    add_pause("settling", arguments.number("settle_s"));
  }

 private:
  double base_goal() const {
    return robot().position_m(LineAxis::kBase) + target_x_m_ - robot().base_x_m();
  }

  Outcome judge(std::string_view) override {
    const double error_m = std::abs(target_x_m_ - robot().base_x_m());
    Outcome outcome;
    outcome.margins["goal"] = tolerance_m_ - error_m;
    if (error_m <= tolerance_m_) return outcome;
    outcome.status = SimStatus::kFailed;
    outcome.reason =
        fmt::format("blocked at {}, {} from target.x", metres(robot().base_x_m()), metres(error_m));
    return outcome;
  }

  double target_x_m_;
  double tolerance_m_;
};

constexpr double kCloseAcceleration_m_s2 = 0.5;

/// Raises, opens, moves the tool over the object, lowers, squeezes, lifts.
class PickingUp final : public LineController {
 public:
  PickingUp(const ControlContext& context, const Arguments& arguments)
      : LineController(context), arguments_(arguments), object_(*arguments.body("object")) {
    const Eigen::Vector3d p_TO = object_from_tool();
    const double reach_m = robot().position_m(LineAxis::kReach) + p_TO.x();
    const double beyond_m = robot().beyond_stops_m(LineAxis::kReach, reach_m);
    if (beyond_m > 0.0) {
      refuse(fmt::format("out of reach: {} lies {} beyond the end of the arm", name(),
                         metres(beyond_m)),
             {{"reach", -beyond_m}});
      return;
    }
    const double height_m = robot().position_m(LineAxis::kLift) + p_TO.z();
    const double below_m = robot().beyond_stops_m(LineAxis::kLift, height_m);
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
  std::string name() const { return "`" + name_of(object_) + "`"; }

  /// From the tool to the middle of the grasp, as measured now.
  Eigen::Vector3d object_from_tool() const {
    Eigen::Vector3d p = context().world.position(object_) - robot().tool();
    p.z() += arguments_.number("grasp_height_m");
    return p;
  }

  void add_phases() {
    const double speed = arguments_.number("max_speed_m_s");
    const Motion free = empty_motion(speed);
    const Motion over = slow_at_end(free, arguments_.number("tool_tolerance_m"));
    const Motion loaded = loaded_motion(arguments_.number("lift_speed_m_s"));
    add_move(
        "raising", LineAxis::kLift, [] { return 0.0; }, free);
    add_move(
        "opening", LineAxis::kFinger,
        [this] { return robot().finger_position_for(robot_spec().opening_m); }, free);
    add_move(
        "reaching", LineAxis::kReach,
        [this] { return robot().position_m(LineAxis::kReach) + object_from_tool().x(); }, over);
    add_move(
        "lowering", LineAxis::kLift,
        [this] { return robot().position_m(LineAxis::kLift) + object_from_tool().z(); }, free);
    add(
        "closing", [this] { return begin_closing(); }, [this] { return squeezed_long_enough(); });
    add_move(
        "lifting", LineAxis::kLift, [] { return 0.0; }, loaded);
    add_pause("settling", arguments_.number("settle_s"));
  }

  double begin_closing() {
    // A blocked tool stays where it got to.
    robot().brake(LineAxis::kLift);
    robot().brake(LineAxis::kReach);
    const double given = arguments_.number("grip_force_n");
    const double speed = arguments_.number("close_speed_m_s");
    robot().squeeze(std::isnan(given) ? robot_spec().grip_force_n : given, speed,
                    kCloseAcceleration_m_s2);
    return closing_time_s(robot().opening_m(), speed, arguments_.number("hold_s"));
  }

  bool squeezed_long_enough() {
    const Touch& touch = world().touch(object_);
    const auto steps = squeezed_.note(touch.near_pad() && touch.far_pad());
    return static_cast<double>(steps) * world().timestep_s() >= arguments_.number("hold_s");
  }

  Outcome judge(std::string_view overdue) override {
    Outcome outcome;
    if (context().grasp.held(object_)) {
      outcome.margins["grasp_offset"] = object_from_tool().x();
      return outcome;
    }
    outcome.status = SimStatus::kFailed;
    outcome.reason = with_overdue(name() + " is not held after the lift", overdue);
    return outcome;
  }

  Arguments arguments_;
  BodyId object_;
  StepsInARow squeezed_;
};

/// The load is led this far below where its support should be: slow at the touch, and harmless
/// where nothing is met.
constexpr double kBelowSupport_m = 0.003;

/// Moves what is held over the target, lowers it until something supports it, lets go.
class Placing final : public LineController {
 public:
  Placing(const ControlContext& context, const Arguments& arguments)
      : LineController(context), arguments_(arguments), object_(find_held()) {
    const Motion free = empty_motion(arguments_.number("max_speed_m_s"));
    const auto carry_height = [] { return 0.0; };
    if (!object_) {  // a safe posture, then failure
      add_move("raising", LineAxis::kLift, carry_height, free);
      return;
    }
    const double beyond_m = robot().beyond_stops_m(LineAxis::kReach, reach_goal());
    if (beyond_m > 0.0) {
      refuse(fmt::format("out of reach: target.x {} lies {} beyond the end of the arm",
                         metres(arguments_.number("target.x")), metres(beyond_m)),
             {{"reach", -beyond_m}});
      return;
    }
    add_phases(free);
  }

 private:
  std::string name() const { return "`" + name_of(*object_) + "`"; }

  std::optional<BodyId> find_held() const {
    if (const auto named = arguments_.body("object")) {
      return context().grasp.held(*named) ? named : std::nullopt;
    }
    const WorldLayout& layout = context().world.layout();
    for (std::size_t i = 0; i < layout.bodies.size(); ++i) {
      const BodyId id = layout.bodies.id_at(i);
      if (context().grasp.held(id)) return id;
    }
    return std::nullopt;
  }

  double reach_goal() const {
    return robot().position_m(LineAxis::kReach) + arguments_.number("target.x") -
           robot().tool().x();
  }

  void add_phases(const Motion& free) {
    const Motion over =
        slow_at_end(loaded_motion(free.max_speed_m_s), arguments_.number("tool_tolerance_m"));
    const Motion loaded = loaded_motion(arguments_.number("lower_speed_m_s"));
    const Motion opening = empty_motion(arguments_.number("open_speed_m_s"));
    add_move(
        "reaching", LineAxis::kReach, [this] { return reach_goal(); }, over);
    add(
        "lowering",
        [this, loaded] {
          lost_on_the_way_ = !context().grasp.held(*object_);
          const double way_m = context().grasp.clearance_m(*object_) + kBelowSupport_m;
          const double goal_m =
              lost_on_the_way_ ? 0.0 : robot().position_m(LineAxis::kLift) - way_m;
          robot().move_to(LineAxis::kLift, goal_m, loaded);
          return 2.0 * nominal_time_s(goal_m - robot().position_m(LineAxis::kLift), loaded);
        },
        [this] { return supported(*object_) || robot().at_rest(LineAxis::kLift); });
    add_braking([this] { robot().brake(LineAxis::kLift); },
                [this] { return robot().at_rest(LineAxis::kLift); });
    add_move(
        "opening", LineAxis::kFinger,
        [this] { return robot().finger_position_for(robot_spec().opening_m); }, opening);
    add_move(
        "raising", LineAxis::kLift, [] { return 0.0; }, free);
    add_pause("settling", arguments_.number("settle_s"));
  }

  Outcome judge(std::string_view) override {
    Outcome outcome;
    outcome.status = SimStatus::kFailed;
    if (!object_) {
      outcome.reason = "nothing is held";
    } else if (lost_on_the_way_) {
      outcome.reason = name() + " was lost on the way";
    } else if (context().grasp.held(*object_)) {
      outcome.reason = name() + " did not come off the gripper";
    } else {
      outcome.status = SimStatus::kOk;
    }
    return outcome;
  }

  Arguments arguments_;
  std::optional<BodyId> object_;
  bool lost_on_the_way_ = false;
};

}  // namespace

std::unique_ptr<Controller> make_going(const ControlContext& context, const Arguments& arguments) {
  return std::make_unique<Going>(context, arguments);
}

std::unique_ptr<Controller> make_picking_up(const ControlContext& context,
                                            const Arguments& arguments) {
  return std::make_unique<PickingUp>(context, arguments);
}

std::unique_ptr<Controller> make_placing(const ControlContext& context,
                                         const Arguments& arguments) {
  return std::make_unique<Placing>(context, arguments);
}

}  // namespace parallax::harness
