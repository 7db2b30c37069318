#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "harness/robot/controller.h"
#include "harness/robot/tool_path.h"

namespace parallax::harness {

/// Words that the reasons of failed actions begin with: what CRAM calls the condition.
inline constexpr std::string_view kNavigationUnreachable = "navigation-pose-unreachable";
inline constexpr std::string_view kManipulationUnreachable = "manipulation-pose-unreachable";
inline constexpr std::string_view kObjectNotFound = "object-not-found";
inline constexpr std::string_view kGraspFailed = "object-not-held";
inline constexpr std::string_view kGoalNotReached = "manipulation-goal-not-reached";
inline constexpr std::string_view kLookingFailed = "looking-failed";

/// A controller of the mobile robot.
class MobileController : public PhasedController {
 protected:
  /// Reads `arm`, if the controller takes it.
  MobileController(const ControlContext& context, const Arguments& arguments);

  MobileRobot& robot() const { return *context().mobile; }
  Perception& perception() const { return *context().perception; }
  Arm& arm() const { return *arm_; }
  const Arguments& arguments() const { return arguments_; }
  double number(std::string_view name) const { return arguments_.number(name); }

  /// The motion of the empty or loaded tool; `max_speed_m_s` of the arguments.
  Motion tool_motion() const;
  /// The argument `target.x` (`.y`, `.z`), or the place that the argument `place` names.
  Eigen::Vector3d target_point() const;

  /// Refuses unless the tool can be at `tool_W` with the wrist turned to `wrist_rad`; true if it
  /// can: within the reach of a gantry, or by some positions of the joints of a chain.
  bool require_reach(const Eigen::Vector3d& tool_W, double wrist_rad, const std::string& what);
  bool reaches(const Eigen::Vector3d& tool_W, double wrist_rad) const;
  /// The ways of the arm and its load. Obstacles are all bodies but the robot and `touched`, which
  /// the arm is to touch.
  ArmWays arm_ways(std::optional<BodyId> touched, double tolerance_m) const;
  void add_tool_move(std::string_view name, std::function<Eigen::Vector3d()> target, Motion motion);
  /// The same, but over as soon as `done`.
  void add_tool_move_until(std::string_view name, std::function<Eigen::Vector3d()> target,
                           Motion motion, std::function<bool()> done);
  /// Finds a free way when it begins, or refuses. Where the tool of a chain cannot be led there by
  /// straight lines, all joints swing there at once, if that is free.
  void add_tool_path(std::string_view name, std::function<Eigen::Vector3d()> target);
  void add_wrist(double yaw_rad);  // against the robot's heading
  void add_opening(std::function<double()> opening_m);
  /// Closes on a handle, which gives way little: a time, not a touch, ends it.
  void add_handle_squeeze(const HandleSpec& handle);
  /// Closes with `force_n` until `gripped` has been true for `hold_s`.
  void add_squeeze(double force_n, double hold_s, std::function<bool()> gripped);

  /// The tool position at which the near pad passes, at the clearance, a body that is `width_m`
  /// wide; the far pad closes up to it.
  Eigen::Vector3d tool_beside(const Eigen::Vector3d& p_W, double width_m, double clearance_m,
                              double wrist_rad) const;
  /// `where`: "at the handle".
  void refuse_way(const WayFault& fault, const std::string& where);
  static Outcome failed(std::string_view condition, const std::string& text, State margins = {});
  void refuse_with(std::string_view condition, const std::string& text, State margins = {});

 private:
  bool require_chain_reach(const Eigen::Vector3d& tool_W, double wrist_rad,
                           const std::string& what);
  double reach_margin_m(const Eigen::Vector3d& tool_W) const;
  bool add_swings(const Eigen::Vector3d& goal);
  ToolPath find_path(const Eigen::Vector3d& goal, double ceiling_m) const;

  Arguments arguments_;
  Arm* arm_ = nullptr;
};

std::unique_ptr<Controller> make_drive(const ControlContext&, const Arguments&);
std::unique_ptr<Controller> make_look(const ControlContext&, const Arguments&);
std::unique_ptr<Controller> make_detect(const ControlContext&, const Arguments&);
std::unique_ptr<Controller> make_move_torso(const ControlContext&, const Arguments&);
std::unique_ptr<Controller> make_park(const ControlContext&, const Arguments&);
std::unique_ptr<Controller> make_open_gripper(const ControlContext&, const Arguments&);
std::unique_ptr<Controller> make_regrip(const ControlContext&, const Arguments&);
std::unique_ptr<Controller> make_pick_up(const ControlContext&, const Arguments&);
std::unique_ptr<Controller> make_place(const ControlContext&, const Arguments&);
std::unique_ptr<Controller> make_open_door(const ControlContext&, const Arguments&);
std::unique_ptr<Controller> make_close_door(const ControlContext&, const Arguments&);
std::unique_ptr<Controller> make_open_drawer(const ControlContext&, const Arguments&);
std::unique_ptr<Controller> make_close_drawer(const ControlContext&, const Arguments&);

}  // namespace parallax::harness
