#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "harness/world/arguments.h"
#include "harness/world/grasp_monitor.h"
#include "harness/world/robot.h"

namespace parallax::harness {

/// What a controller acts on. All outlive the controller.
struct ControlContext {
  Robot& robot;
  const GraspMonitor& grasp;
  const OdeWorld& world;
  const RobotSpec& spec;
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

std::unique_ptr<Controller> make_going(const ControlContext& context, const Arguments& arguments);
std::unique_ptr<Controller> make_picking_up(const ControlContext& context,
                                            const Arguments& arguments);
std::unique_ptr<Controller> make_placing(const ControlContext& context, const Arguments& arguments);

/// The factory of a name in controllers(), or null.
ControllerFactory find_factory(std::string_view name);

/// A stretch of an action: begins, and lasts until `done` or for the limit that `begin` gave.
struct Phase {
  std::string_view name;          // "lowering"
  std::function<double()> begin;  // commands the robot; returns the time limit [s]
  std::function<bool()> done;
};

/// A controller made of phases in a row. One whose limit passes is remembered, not the end: the
/// physical result decides.
class PhasedController : public Controller {
 public:
  std::optional<Outcome> tick(double time_s) final;

 protected:
  explicit PhasedController(const ControlContext& context) : context_(context) {}

  Robot& robot() const { return context_.robot; }
  const ControlContext& context() const { return context_; }
  void add(std::string_view name, std::function<double()> begin, std::function<bool()> done);
  /// Waits.
  void add_pause(std::string_view name, double duration_s);
  /// Moves one axis to `target` (asked when the phase begins), for at most twice the nominal time.
  void add_move(std::string_view name, Axis axis, std::function<double()> target, Motion motion);
  /// Skips all phases: the next tick returns `outcome`.
  void refuse(std::string reason, State margins = {});

  /// The judgement after the last phase. `overdue` names the first phase that met its limit.
  virtual Outcome judge(std::string_view overdue) = 0;

 private:
  ControlContext context_;
  std::vector<Phase> phases_;
  std::size_t current_ = 0;
  bool begun_ = false;
  double phase_end_s_ = 0.0;
  std::string_view overdue_;
  std::optional<Outcome> refusal_;
};

/// "0.713 m", for reasons.
std::string metres(double value_m);

}  // namespace parallax::harness
