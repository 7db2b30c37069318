#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace parallax::harness {

/// One box of a body, axis-aligned in the body's frame B.
struct BoxShape {
  Eigen::Vector3d size_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d p_BS = Eigen::Vector3d::Zero();  // centre of the shape in B [m]
};

/// Boxes that move as one. A body that no joint names is free; the floor is built in and called
/// "floor", so no body may have that name.
struct BodySpec {
  std::string name;
  std::vector<BoxShape> shapes;
  double mass_kg = 0.0;  // 0: static, part of the world; else spread evenly over the shapes
  std::string material;  // key of FrictionSpec::pairs
  Eigen::Vector3d p_WB = Eigen::Vector3d::Zero();  // default position in the world [m]
  double yaw_rad = 0.0;
  bool gravity = true;
  bool collides = true;
  /// Which of x, y, z, yaw a scenario may set at reset; the others keep their default. The
  /// robot's base body takes x only, and carries the whole robot along.
  std::vector<std::string> settable;
};

/// kFixed welds two bodies into one rigid body, so it neither bends nor costs time.
enum class JointType : std::uint8_t { kSlider, kFixed };

/// Position 0 is the default placement; positive moves the child along axis_W.
struct JointSpec {
  std::string name;
  JointType type = JointType::kSlider;
  std::string parent;  // body name, or empty for the world
  std::string child;
  Eigen::Vector3d axis_W = Eigen::Vector3d::UnitX();  // at the default placement
  std::optional<double> low_m, high_m;                // stops
  double max_force_n = 0.0;                           // motor; 0 leaves the joint free
};

/// Coulomb friction by pair of materials; the key is sorted ("box", "pad").
struct FrictionSpec {
  double fallback = 0.5;
  std::map<std::pair<std::string, std::string>, double> pairs;
};

/// Roles that the controllers need, by joint and body name. All empty: a world without a robot.
struct RobotSpec {
  std::string base_joint;    // drives along x
  std::string base_body;     // what "robot.x" reports
  std::string reach_joint;   // moves the tool along x relative to the base
  std::string lift_joint;    // moves the tool along z; position 0 is the carry height
  std::string finger_joint;  // the driven pad
  std::string near_pad_body, far_pad_body;
  double grip_force_n = 20.0;
  double opening_m = 0.09;  // between the pads' inner faces when open
};

struct SolverSpec {
  double timestep_s = 0.002;
  double gravity_m_s2 = -9.81;
  double erp = 0.2;
  double cfm = 1e-5;
  double surface_layer_m = 0.001;
  double max_correcting_velocity_m_s = 1.0;
  double start_penetration_m = 0.002;  // deeper at reset: invalid start
  std::int64_t max_contacts_per_pair = 8;
  // A free body slower than this for so long is put to sleep until something touches it.
  double sleep_linear_m_s = 0.01;
  double sleep_angular_rad_s = 0.02;
  double sleep_after_s = 0.3;
};

/// Everything the engine needs; pure data, read from the scenario's `world` section.
struct WorldSpec {
  SolverSpec solver;
  FrictionSpec friction;
  std::string floor_material = "floor";
  std::vector<BodySpec> bodies;  // any order: the engine creates them sorted by name
  std::vector<JointSpec> joints;
  RobotSpec robot;
};

}  // namespace parallax::harness
