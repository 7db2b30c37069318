#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <span>
#include <string>
#include <vector>

namespace parallax::harness {

inline constexpr int kMostChainJoints = 12;

/// Positions of the joints of a chain, from its root: [rad] of hinges, [m] of sliders; 0 is the
/// placement that the chain is described in. Never on the heap.
using JointVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostChainJoints, 1>;
/// (6 x joints): what the tool does as each joint moves; three rows of the velocity of its point,
/// then three of its turning, along the axes of the root.
using ChainJacobian =
    Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, kMostChainJoints>;

/// A joint where it is at position 0, in the frame R of the root.
struct ChainJoint {
  std::string name;
  bool slides = false;                                // else it turns
  Eigen::Vector3d axis_R = Eigen::Vector3d::UnitZ();  // unit
  Eigen::Vector3d p_RA = Eigen::Vector3d::Zero();     // a point of the axis [m]
  double low = -1.0, high = 1.0;                      // stops, which include 0
};

/// The mass that hangs on a joint, up to the next joint, at position 0.
struct ChainMass {
  double mass_kg = 0.0;
  Eigen::Vector3d p_RC = Eigen::Vector3d::Zero();  // its centre in R [m]
};

/// Hinges and sliders in a row that carry a tool. The pose of the tool is a product of the motions
/// of the joints about axes that are all given in one placement: Brockett 1984; Lynch and Park
/// 2017, section 4.1.
class SerialChain {
 public:
  SerialChain() = default;
  /// Takes at least one joint, at most kMostChainJoints; `X_RT` is the tool's pose at positions 0.
  SerialChain(std::vector<ChainJoint> joints, const Eigen::Isometry3d& X_RT);

  Eigen::Index size() const { return static_cast<Eigen::Index>(joints_.size()); }
  const std::vector<ChainJoint>& joints() const { return joints_; }

  /// The tool in the root's frame.
  Eigen::Isometry3d tool(const JointVector& q) const;
  /// The motions in R, since positions 0, of the parts that hang on each joint: a pose X there is
  /// motions[i] * X now.
  void motions(const JointVector& q, std::span<Eigen::Isometry3d> out) const;
  ChainJacobian jacobian(const JointVector& q) const;

  /// The torque or force with which each joint holds the masses still [Nm or N], positive along its
  /// axis. `masses` has one entry for each joint; `gravity_R` is in the root's frame [m/s^2].
  JointVector holding_torques(const JointVector& q, std::span<const ChainMass> masses,
                              const Eigen::Vector3d& gravity_R) const;

  /// No placement of the tool is farther from the first joint's point than this [m].
  double longest_reach_m() const;

 private:
  std::vector<ChainJoint> joints_;
  Eigen::Isometry3d X_RT_ = Eigen::Isometry3d::Identity();
};

}  // namespace parallax::harness
