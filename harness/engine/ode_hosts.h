#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "harness/engine/ode_engine.h"

struct dMass;

namespace parallax::harness {

/// Force and torque, the latter about a point that the context names; world axes [N, Nm].
struct Wrench {
  Eigen::Vector3d force = Eigen::Vector3d::Zero(), torque = Eigen::Vector3d::Zero();
};

/// A joint of the robot, as the engine has it.
struct RobotJoint {
  enum class Kind : std::uint8_t { kGantry, kSlider, kHinge };
  Kind kind = Kind::kSlider;
  std::uint32_t index = 0;  // among those of its kind
  const JointSpec* spec = nullptr;
  std::optional<std::uint32_t> parent;  // index of a link; none: the world
  std::uint32_t child = 0;              // index of a link
  std::vector<dxJoint*> parts;          // of a gantry: linear, angular; else the joint, its motors
  bool may_rest = true;
  bool rests = false;
  /// A hinge with no gantry between it and the one of the base. It may rest while what it moves
  /// touches something, as what that pushes is part of its load.
  bool in_chain = false;
};

/// Which body of the engine moves a link of the robot: its own, or, when joints at rest make
/// several links one rigid body, another without shapes that has the mass of all of them. The
/// bodies of these links are disabled, follow it and keep the shapes. What hangs at the world by
/// joints at rest has no host and stands still.
class Hosts {
 public:
  /// Takes over the joints of the robot, if it is one on gantries. The engine is complete, its
  /// bodies are where they are by default; it must outlive this.
  explicit Hosts(OdeWorld::Engine& engine);
  ~Hosts();
  Hosts(const Hosts&) = delete;
  Hosts& operator=(const Hosts&) = delete;

  /// Parents come before their children. Empty: every link is its own host, for ever.
  std::vector<RobotJoint>& joints() { return joints_; }
  const std::vector<RobotJoint>& joints() const { return joints_; }
  dxBody* of(std::uint32_t link) const { return links_[link].host; }

  /// No joint rests, and everything is attached anew in one order: what was before leaves no trace
  /// in the order of the engine's lists.
  void reset();
  /// Makes it so as the joints' `rests` say now. Nothing jumps: poses and velocities stay.
  void regroup();
  /// Call it before a step.
  void remember_velocities();
  /// Call it after a step: moves links that have another host along with that host.
  void follow();

  /// The motion of the parent of a joint since the default: a point at p_W then is at `shift` +
  /// `turn` p_W now, if it hangs at the parent.
  struct Motion {
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
    Eigen::Vector3d shift = Eigen::Vector3d::Zero();
  };
  Motion motion_of_parent(const RobotJoint& joint) const;
  /// Call it before a step, once all of its contacts are attached by `listen`. `count`: the number
  /// of contacts to come.
  void expect_contacts(std::size_t count);
  /// Counts the forces of a contact of links, or of something else (none), as parts of loads.
  void listen(dxJoint* contact, std::optional<std::uint32_t> one,
              std::optional<std::uint32_t> other);
  /// Measures the loads that joints at rest had to bear in the step, from the motion of all that
  /// they carry, the forces of the joints that hang at it and moved, and the contact forces. Call
  /// it after `follow`.
  void measure_loads(double timestep_s);
  /// The torque of a hinge's motor in the last step in which the joint was solved [Nm].
  double motor_torque_nm(std::size_t joint) const;
  /// The torque is about `about_W`.
  Wrench load(const RobotJoint& joint, const Eigen::Vector3d& about_W) const;

 private:
  struct Feedback;
  struct LinkState {
    dxBody* own = nullptr;
    dxBody* host = nullptr;
    dxBody* shared = nullptr;  // the host of the links with this root, if there are several
    bool of_robot = false;
    std::optional<std::uint32_t> root;  // the first of the links that move with it; none: the world
    double mass_kg = 0.0;
    Eigen::Matrix3d I_L = Eigen::Matrix3d::Zero();        // about its middle, along its axes
    Eigen::Vector3d p_default = Eigen::Vector3d::Zero();  // in the world
    Eigen::Matrix3d R_default = Eigen::Matrix3d::Identity();
    Eigen::Vector3d p_HL = Eigen::Vector3d::Zero();  // in its host
    Eigen::Quaterniond q_HL = Eigen::Quaterniond::Identity();
    Wrench load;  // about the world's origin
    Eigen::Vector3d v_before = Eigen::Vector3d::Zero(), w_before = Eigen::Vector3d::Zero();
  };

  void add_joint(RobotJoint::Kind kind, std::size_t index, const JointSpec& spec,
                 std::vector<dxJoint*> parts);
  void collect_joints();
  void sort_joints();
  void find_chains();
  void subtract_contacts();
  void prepare_to_share(LinkState& root);
  Wrench inertial_load(const LinkState& link, double timestep_s) const;
  void merge(std::uint32_t root);
  static void add_mass(const LinkState& link, dMass& total);
  void attach(RobotJoint& joint);
  void attach_in_reference(RobotJoint& joint, dxBody* child, dxBody* parent);
  void attach_gantry(RobotJoint& joint, dxBody* child, dxBody* parent);

  OdeWorld::Engine& engine_;
  std::vector<RobotJoint> joints_;
  std::vector<LinkState> links_;  // by LinkId; of the robot
  std::unique_ptr<Feedback> feedback_;
};

}  // namespace parallax::harness
