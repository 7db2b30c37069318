#pragma once

#include <functional>
#include <string_view>
#include <utility>

#include "harness/robot/controller.h"

namespace parallax::harness {

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

std::unique_ptr<Controller> make_going(const ControlContext& context, const Arguments& arguments);
std::unique_ptr<Controller> make_picking_up(const ControlContext& context,
                                            const Arguments& arguments);
std::unique_ptr<Controller> make_placing(const ControlContext& context, const Arguments& arguments);

}  // namespace parallax::harness
