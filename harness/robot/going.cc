#include <fmt/format.h>

#include <cmath>

#include "harness/robot/line_controller.h"

namespace parallax::harness {
namespace {

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
    const double beyond_m = robot().beyond_stops_m(Axis::kBase, goal_m);
    if (beyond_m > 0.0) {
      refuse(fmt::format("target.x {} lies {} beyond the end of the drive", metres(target_x_m_),
                         metres(beyond_m)));
      return;
    }
    // A tool left low would be dragged along the floor.
    if (std::abs(robot().position_m(Axis::kLift)) > kCarryTolerance_m) {
      add_move(
          "raising", Axis::kLift, [] { return 0.0; }, kRaise);
    }
    const Motion drive{arguments.number("max_speed_m_s"), arguments.number("acceleration_m_s2"),
                       tolerance_m_, kRaise.approach_rate_hz};
    add_move(
        "driving", Axis::kBase, [this] { return base_goal(); }, drive);
    add(
        "braking",
        [this] {
          robot().brake(Axis::kBase);
          return 1.0;
        },
        [this] { return robot().at_rest(Axis::kBase); });
    add_pause("settling", arguments.number("settle_s"));
  }

 private:
  double base_goal() const {
    return robot().position_m(Axis::kBase) + target_x_m_ - robot().base_x_m();
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

}  // namespace

std::unique_ptr<Controller> make_going(const ControlContext& context, const Arguments& arguments) {
  return std::make_unique<Going>(context, arguments);
}

}  // namespace parallax::harness
