#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/base/word_table.h"
#include "harness/world/convex_hull.h"

namespace parallax::harness {

/// The form that fills the box of a shape. Cylinders and capsules stand along the shape's z axis;
/// the caps of a capsule lie inside its box.
enum class ShapeForm : std::uint8_t { kBox, kSphere, kCylinder, kCapsule, kHull };

/// One shape of a body, turned in the body's frame B about x, then y, then z.
struct BodyShape {
  Eigen::Vector3d size_m = Eigen::Vector3d::Zero();  // of the box round it
  Eigen::Vector3d p_BS = Eigen::Vector3d::Zero();    // centre of the shape in B [m]
  double yaw_rad = 0.0;
  ShapeForm form = ShapeForm::kBox;  // for round forms, size_m.x() and .y() are the diameter
  double roll_rad = 0.0, pitch_rad = 0.0;
  /// The hull of kHull. Shared, as it never changes and shapes are copied with every probe of a
  /// sweep.
  std::shared_ptr<const ConvexHull> hull = {};
};

/// The distribution of a body's mass, where it does not follow from its shapes.
struct InertiaSpec {
  Eigen::Vector3d p_BC = Eigen::Vector3d::Zero();       // centre of mass in B [m]
  Eigen::Matrix3d I_C_kg_m2 = Eigen::Matrix3d::Zero();  // about it, along the axes of B
};

/// The grasp of a body by a gripper.
struct GraspSpec {
  Eigen::Vector3d p_BG = Eigen::Vector3d::Zero();  // middle of the pads from the body's origin [m]
  /// Offset and wrist turn with the body's heading, or with the robot's.
  bool follows_body = true;
  double wrist_rad = 0.0;   // of the pads' line against the frame above; 0: pads squeeze along y
  bool from_above = false;  // else level, along the robot's heading
  double width_m = 0.05;    // of the part that the pads close on
  double effort_n = 20.0;   // squeezing force
};

/// Shapes that move as one. A body that no joint names is free; the floor is built in and called
/// "floor", so no body may have that name.
struct BodySpec {
  std::string name;
  std::vector<BodyShape> shapes;
  double mass_kg = 0.0;  // 0: static, part of the world; else spread evenly over the shapes, or
  std::optional<InertiaSpec> inertia;
  std::string material;                            // key of FrictionSpec::pairs
  Eigen::Vector3d p_WB = Eigen::Vector3d::Zero();  // default position in the world [m]
  double yaw_rad = 0.0;
  bool gravity = true;
  bool collides = true;
  /// Bodies that share a word do not collide with each other; blanks part several.
  std::string apart;
  /// Which of x, y, z, yaw, bottom, mass a scenario may set at reset; the others keep their
  /// default. The robot's base body takes x (and, of a mobile robot, y and yaw) and carries the
  /// whole robot along.
  std::vector<std::string> settable;
  std::string kind;  // what a camera recognises it as; empty: its name
  std::optional<GraspSpec> grasp;

  bool can_set(std::string_view item) const {
    return std::find(settable.begin(), settable.end(), item) != settable.end();
  }
  const std::string& kind_name() const { return kind.empty() ? name : kind; }
};

/// kFixed welds two bodies into one rigid body, so it neither bends nor costs time. kGantry
/// carries the child along x, y and z of the parent and turns it about z, upright at all times;
/// with the world as parent its height is that of the floor relief, whatever the load. kHinge turns
/// the child about the axis through p_WA; without stops it turns for ever.
enum class JointType : std::uint8_t { kSlider, kFixed, kGantry, kHinge };

/// How far a stop of a hinge may lie from its default: two turns, so that degrees are noticed.
inline constexpr double kMostTurn_rad = 13.0;
/// Up to here an angle says by itself which turn it belongs to, even where a stop gives a little.
inline constexpr double kHalfTurn_rad = 3.1;

/// Where a gripper takes hold of the child of a slider or a hinge to move it; at its default
/// placement. What a hinge turns takes the directions along.
struct HandleSpec {
  Eigen::Vector3d p_CH = Eigen::Vector3d::Zero();  // middle of the grip in the child's frame [m]
  Eigen::Vector3d approach = Eigen::Vector3d::UnitX();  // last stretch of the tool's way, world
  double wrist_rad = 0.0;                               // of the pads' line, world
  double width_m = 0.016;
};

/// The suspension that carries the child of a gantry of the world, in place of a hand that holds it
/// upright at its height: a spring and a damper for the height, loaded so that the robot stands at
/// its default height, and others against roll and pitch. The dampers work against a level at rest.
struct SuspensionSpec {
  double stiffness_n_m = 0.0, damping_n_s_m = 0.0;
  double stiffness_nm_rad = 0.0, damping_nm_s = 0.0;
};

/// A joint that another one leads: its position is `ratio` times that of the leader, and what
/// pushes the one is felt by the other.
struct FollowSpec {
  std::string leader;  // a slider or hinge that follows none itself
  double ratio = 1.0;  // in the units of both joints
};

/// Position 0 is the default placement; positive moves the child along axis_W, or turns it about
/// that by the right hand.
struct JointSpec {
  std::string name;
  JointType type = JointType::kSlider;
  std::string parent;  // body name, or empty for the world
  std::string child;
  Eigen::Vector3d axis_W = Eigen::Vector3d::UnitX();  // at the default placement
  std::optional<double> low_m, high_m;                // stops
  double max_force_n = 0.0;     // motor, or dry friction where nothing drives it; 0: free
  double max_torque_nm = 50.0;  // of a gantry about z; of a hinge as max_force_n of a slider
  Eigen::Vector3d p_WA = Eigen::Vector3d::Zero();  // a point of a hinge's axis, by default [m]
  std::optional<double> low_rad, high_rad;         // stops of a hinge
  double damping_n_s_m = 0.0;                      // of a slider
  double damping_nm_s = 0.0;                       // of a hinge, per rad
  std::optional<HandleSpec> handle;
  std::optional<SuspensionSpec> suspension;  // of a gantry of the world
  std::optional<FollowSpec> follows;         // of a slider or hinge
};

/// Can a hinge with stops pass half a turn? Then its turns are counted; the angle of one without
/// stops lies within half a turn.
inline bool counts_turns(const JointSpec& hinge) {
  if (!hinge.low_rad && !hinge.high_rad) return false;
  return hinge.low_rad.value_or(-kMostTurn_rad) < -kHalfTurn_rad ||
         hinge.high_rad.value_or(kMostTurn_rad) > kHalfTurn_rad;
}

/// Coulomb friction by pair of materials; the key is sorted ("box", "pad").
struct FrictionSpec {
  double fallback = 0.5;
  std::map<std::pair<std::string, std::string>, double> pairs;
};

struct SolverSpec {
  double timestep_s = 0.002;
  double gravity_m_s2 = -9.81;
  double erp = 0.2;
  double cfm = 1e-5;
  std::optional<double> contact_erp, contact_cfm;  // of contacts, where they differ
  double surface_layer_m = 0.001;
  double max_correcting_velocity_m_s = 1.0;
  double start_penetration_m = 0.002;      // deeper at reset: invalid start
  std::int64_t max_contacts_per_pair = 8;  // of two shapes
  // The limit for two bodies, among contacts with the same normal; none: as many as their shapes
  // have.
  std::optional<std::int64_t> max_contacts_per_side;
  // A free body slower than this for so long is put to sleep until something touches it.
  double sleep_linear_m_s = 0.01;
  double sleep_angular_rad_s = 0.02;
  double sleep_after_s = 0.3;
  // A body is held when both pads of a gripper have touched it for so long, and its lowest point
  // was so far above everything below it.
  double held_after_s = 0.2;
  double held_clearance_m = 0.010;
  // Joints of a robot on gantries that are at rest are not solved: what they connect moves as one.
  bool resting_joints = true;
};

/// A point with a heading that actions can name: in the world, or in the frame of a body that
/// moves ("the middle of the upper drawer").
struct PlaceSpec {
  std::string name;
  std::string frame;  // body, or empty for the world
  Eigen::Vector3d p_FP = Eigen::Vector3d::Zero();
  double yaw_rad = 0.0;
};

/// A robot on a line, by joint and body name. All empty: a world without one.
struct LineRobotSpec {
  std::string base_joint;    // drives along x
  std::string base_body;     // what "robot.x" reports
  std::string reach_joint;   // moves the tool along x relative to the base
  std::string lift_joint;    // moves the tool along z; position 0 is the carry height
  std::string finger_joint;  // the driven pad
  std::string near_pad_body, far_pad_body;
  double grip_force_n = 20.0;
  double opening_m = 0.09;  // between the pads' inner faces when open
};

/// An arm of a mobile robot: a gripper that hangs from a palm, and what carries the palm: a gantry,
/// whose reach is that of the arm that it stands for, or a chain of joints. Positions in the frame
/// of the base, with the torso at its lowest where the torso carries them.
struct ArmSpec {
  std::string name;
  std::string joint;               // gantry of the palm; empty:
  std::vector<std::string> chain;  // hinges and sliders, from the robot to the palm
  std::string finger_joint;        // slider of the far pad, along the palm's y
  std::string palm_body, near_pad_body, far_pad_body;
  Eigen::Vector3d p_BS = Eigen::Vector3d::Zero();     // shoulder [m]
  double min_reach_m = 0.25, max_reach_m = 0.95;      // of the tool from the shoulder
  Eigen::Vector3d carry_B = Eigen::Vector3d::Zero();  // tool when parked [m]
  double opening_m = 0.09;                            // between the pads' inner faces when open
  double grip_force_n = 20.0;                         // of grasps that name no effort
};

/// How far estimates of detected bodies are off. They stand on surfaces that the robot knows, so it
/// is their place on them and their turn about the vertical that is uncertain. Root mean squares.
struct DetectionSpec {
  double bias_m = 0.003, bias_rad = 0.021;    // one shift and turn for all detections of a run
  double noise_m = 0.004, noise_rad = 0.028;  // another for each detection
  double miss_rate = 0.0;                     // of bodies in sight, each time they are looked for
  double confusion_rate = 0.0;  // of bodies of another kind in sight where none of the kind is seen
};

struct CameraSpec {
  Eigen::Vector3d p_BC = Eigen::Vector3d::Zero();  // in the base frame, torso at its lowest [m]
  double half_angle_rad = 0.2;
  double min_range_m = 0.3, max_range_m = 2.5;
  double max_pan_rad = 2.8;
  double min_tilt_rad = -0.4, max_tilt_rad = 1.3;  // positive looks down
  DetectionSpec detection;
};

/// A base that drives and turns in the plane, an optional lifting torso, arms and a camera.
struct MobileRobotSpec {
  std::string base_joint;           // gantry, parent world
  std::string base_body;            // what "robot.x" reports
  std::string torso_joint;          // slider along z, or empty
  double relief_amplitude_m = 0.0;  // of the floor under the wheels: a sine over the way driven
  double relief_wavelength_m = 0.1;
  CameraSpec camera;
  std::vector<ArmSpec> arms;  // sorted by name
};

/// The engine that steps a world.
enum class EngineKind : std::uint8_t { kOde, kMujoco, kBullet };
inline constexpr auto kEngineWords = base::word_table<EngineKind>("ode", "mujoco", "bullet");
constexpr std::string_view to_string(EngineKind kind) { return kEngineWords.of(kind); }

/// Everything the engine needs; pure data, read from the scenario's `world` section.
struct WorldSpec {
  EngineKind engine = EngineKind::kOde;  // the scenario's `simulator`
  SolverSpec solver;
  FrictionSpec friction;
  std::string floor_material = "floor";
  std::vector<BodySpec> bodies;  // any order: the engine creates them sorted by name
  std::vector<JointSpec> joints;
  std::vector<PlaceSpec> places;  // sorted by name
  LineRobotSpec robot;
  std::optional<MobileRobotSpec> mobile;  // then `robot` is empty
};

/// The pads of all grippers: one of a line robot, one for each arm of a mobile one.
struct GripperSpec {
  std::string near_pad_body, far_pad_body;
};
inline std::vector<GripperSpec> grippers(const WorldSpec& spec) {
  std::vector<GripperSpec> all;
  if (spec.mobile) {
    for (const ArmSpec& arm : spec.mobile->arms) {
      all.push_back({arm.near_pad_body, arm.far_pad_body});
    }
  } else if (!spec.robot.near_pad_body.empty()) {
    all.push_back({spec.robot.near_pad_body, spec.robot.far_pad_body});
  }
  return all;
}

/// The body that "robot" stands for; empty without a robot.
inline std::string base_body(const WorldSpec& spec) {
  return spec.mobile ? spec.mobile->base_body : spec.robot.base_body;
}

}  // namespace parallax::harness
