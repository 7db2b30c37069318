#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/robot/grasp_monitor.h"
#include "harness/robot/line_robot.h"
#include "harness/robot/mobile_robot.h"
#include "harness/robot/perception.h"
#include "harness/world/arguments.h"

namespace parallax::harness {

/// The objects that a controller acts on. All outlive the controller. One of the robots is present.
struct ControlContext {
  const WorldSpec& spec;
  const PhysicsWorld& world;
  const GraspMonitor& grasp;
  LineRobot* line = nullptr;
  MobileRobot* mobile = nullptr;
  Perception* perception = nullptr;  // of the mobile robot
};

/// One action while it runs.
class Controller {
 public:
  virtual ~Controller() = default;
  /// Asked before each timestep with the time since the action began; commands the robot, and
  /// returns the outcome once the action is over. `Outcome::sim_time_s` is the caller's to fill.
  virtual std::optional<Outcome> tick(double time_s) = 0;
};

using ControllerFactory = std::unique_ptr<Controller> (*)(const ControlContext&, const Arguments&);

/// The factory of a name in controllers(), or null.
ControllerFactory find_factory(std::string_view name);

// Controllers of the robot on a line; those of the mobile robot are in mobile_controller.h.
std::unique_ptr<Controller> make_going(const ControlContext& context, const Arguments& arguments);
std::unique_ptr<Controller> make_picking_up(const ControlContext& context,
                                            const Arguments& arguments);
std::unique_ptr<Controller> make_placing(const ControlContext& context, const Arguments& arguments);

/// A stretch of an action: begins, and lasts until `done` or for the limit that `begin` gave.
struct ActionPhase {
  std::string_view name;          // "lowering"
  std::function<double()> begin;  // commands the robot; returns the time limit [s]
  std::function<bool()> done;
};

/// Counts the timesteps in a row in which something was so.
class StepsInARow {
 public:
  std::int64_t note(bool is_so) { return steps_ = is_so ? steps_ + 1 : 0; }

 private:
  std::int64_t steps_ = 0;
};

/// A controller made of phases in a row. One whose limit passes is remembered, not the end: the
/// physical result decides.
class PhasedController : public Controller {
 public:
  std::optional<Outcome> tick(double time_s) final;

 protected:
  explicit PhasedController(const ControlContext& context) : context_(context) {}

  const ControlContext& context() const { return context_; }
  const PhysicsWorld& world() const { return context_.world; }
  const std::string& name_of(BodyId id) const { return world().layout().bodies[id].name; }
  /// Adds a phase at the end, or, while a phase begins, right after that phase.
  void add(std::string_view name, std::function<double()> begin, std::function<bool()> done);
  /// Waits.
  void add_pause(std::string_view name, double duration_s);
  /// Does something that takes no time.
  void add_step(std::function<void()> what);
  /// Brakes, and waits until all is at rest.
  void add_braking(std::function<void()> brake, std::function<bool()> at_rest);
  /// Skips all phases: the next tick returns `outcome`.
  void refuse(std::string reason, State margins = {});
  /// `reason`, with the phase that was overdue, if one was.
  static std::string with_overdue(std::string reason, std::string_view overdue);

  /// Has the load come to stand on something? Call it in each timestep of a descent.
  bool supported(BodyId load);

  /// The judgement after the last phase. `overdue` names the first phase that met its limit.
  virtual Outcome judge(std::string_view overdue) = 0;

 private:
  ControlContext context_;
  std::vector<ActionPhase> phases_;
  std::size_t current_ = 0;
  std::optional<std::size_t> insert_at_;  // while a phase begins
  bool begun_ = false;
  double phase_end_s_ = 0.0;
  std::string_view overdue_;
  std::optional<Outcome> refusal_;
  StepsInARow support_;
};

/// The time after which a motion of `distance_m` counts as overdue [s].
double patience_s(double distance_m, const Motion& motion);

/// The time allowed for pads to close from `opening_m` and then to squeeze for `hold_s` [s].
double closing_time_s(double opening_m, double speed_m_s, double hold_s);

/// "0.713 m", for reasons.
std::string metres(double value_m);

}  // namespace parallax::harness
