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

  Robot& robot() const { return *context().line; }
  const LineRobotSpec& robot_spec() const { return context().spec.robot; }

  /// Moves one axis to `target` (asked when the phase begins), for at most twice the nominal time.
  void add_move(std::string_view name, Axis axis, std::function<double()> target, Motion motion) {
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
