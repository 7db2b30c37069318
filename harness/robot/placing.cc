#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "harness/robot/line_controller.h"

namespace parallax::harness {
namespace {

constexpr double kToolApproachRate_hz = 3.0;
constexpr double kToolAcceleration_m_s2 = 0.5;
constexpr double kLoadedAcceleration_m_s2 = 0.3;
constexpr double kAxisTolerance_m = 0.001;
constexpr double kFreeApproachRate_hz = 10.0;
/// The load is led this far below where its support should be: slow at the touch, and harmless
/// where nothing is met.
constexpr double kOvertravel_m = 0.003;
constexpr int kSupportSteps = 5;  // of contact in a row before the load counts as supported

/// Moves what is held over the target, lowers it until something supports it, lets go.
class Placing final : public LineController {
 public:
  Placing(const ControlContext& context, const Arguments& arguments)
      : LineController(context), arguments_(arguments), object_(find_held()) {
    const Motion free{arguments_.number("max_speed_m_s"), kToolAcceleration_m_s2, kAxisTolerance_m,
                      kFreeApproachRate_hz};
    const auto carry_height = [] { return 0.0; };
    if (!object_) {  // a safe posture, then failure
      add_move("raising", Axis::kLift, carry_height, free);
      return;
    }
    const double beyond_m = robot().beyond_stops_m(Axis::kReach, reach_goal());
    if (beyond_m > 0.0) {
      refuse(fmt::format("out of reach: target.x {} lies {} beyond the end of the arm",
                         metres(arguments_.number("target.x")), metres(beyond_m)),
             {{"reach", -beyond_m}});
      return;
    }
    add_phases(free);
  }

 private:
  std::string name() const { return "`" + context().world.layout().bodies[*object_].name + "`"; }

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
    return robot().position_m(Axis::kReach) + arguments_.number("target.x") - robot().tool().x();
  }

  void add_phases(const Motion& free) {
    const Motion over{free.max_speed_m_s, kLoadedAcceleration_m_s2,
                      arguments_.number("tool_tolerance_m"), kToolApproachRate_hz};
    const Motion loaded{arguments_.number("lower_speed_m_s"), kLoadedAcceleration_m_s2,
                        kAxisTolerance_m, kFreeApproachRate_hz};
    const Motion opening{arguments_.number("open_speed_m_s"), kToolAcceleration_m_s2,
                         kAxisTolerance_m, kFreeApproachRate_hz};
    add_move(
        "reaching", Axis::kReach, [this] { return reach_goal(); }, over);
    add(
        "lowering",
        [this, loaded] {
          lost_on_the_way_ = !context().grasp.held(*object_);
          const double way_m = context().grasp.clearance_m(*object_) + kOvertravel_m;
          const double goal_m = lost_on_the_way_ ? 0.0 : robot().position_m(Axis::kLift) - way_m;
          robot().move_to(Axis::kLift, goal_m, loaded);
          return 2.0 * nominal_time_s(goal_m - robot().position_m(Axis::kLift), loaded);
        },
        [this] { return supported() || robot().at_rest(Axis::kLift); });
    add(
        "stopping",
        [this] {
          robot().brake(Axis::kLift);
          return 1.0;
        },
        [this] { return robot().at_rest(Axis::kLift); });
    add_move(
        "opening", Axis::kFinger,
        [this] { return robot().finger_position_for(robot_spec().opening_m); }, opening);
    add_move(
        "raising", Axis::kLift, [] { return 0.0; }, free);
    add_pause("settling", arguments_.number("settle_s"));
  }

  bool supported() {
    support_steps_ = context().world.touch(*object_).support ? support_steps_ + 1 : 0;
    return support_steps_ >= kSupportSteps;
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
  int support_steps_ = 0;
};

}  // namespace

std::unique_ptr<Controller> make_placing(const ControlContext& context,
                                         const Arguments& arguments) {
  return std::make_unique<Placing>(context, arguments);
}

}  // namespace parallax::harness
