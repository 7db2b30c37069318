// Forward kinematics of a chain as a product of motions about fixed axes (Brockett 1984; Lynch
// and Park 2017, section 4.1).
//
// All axes are given in one frame, where the joints are at 0. The motion of a part is the
// product of the motions of the joints before it, each about its axis there, so no frames of
// links are needed. A column of the Jacobian is the moved axis, and for a hinge its cross
// product with the arm to the tool. Holding torques sum, for each joint, the moments of all
// masses behind it about its moved axis. Linear in the joints, torques quadratic.

#include "harness/kinematics/serial_chain.h"

#include <algorithm>
#include <array>
#include <utility>

namespace parallax::harness {
namespace {

Eigen::Isometry3d motion_of(const ChainJoint& joint, double position) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  if (joint.slides) {
    X.translation() = position * joint.axis_R;
    return X;
  }
  X.linear() = Eigen::AngleAxisd(position, joint.axis_R).toRotationMatrix();
  X.translation() = joint.p_RA - X.linear() * joint.p_RA;
  return X;
}

using Motions = std::array<Eigen::Isometry3d, kMostChainJoints>;

}  // namespace

SerialChain::SerialChain(std::vector<ChainJoint> joints, const Eigen::Isometry3d& X_RT)
    : joints_(std::move(joints)), X_RT_(X_RT) {}

Eigen::Isometry3d SerialChain::tool(const JointVector& q) const {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    X = X * motion_of(joints_[i], q(static_cast<Eigen::Index>(i)));
  }
  return X * X_RT_;
}

void SerialChain::motions(const JointVector& q, std::span<Eigen::Isometry3d> out) const {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    X = X * motion_of(joints_[i], q(static_cast<Eigen::Index>(i)));
    out[i] = X;
  }
}

ChainJacobian SerialChain::jacobian(const JointVector& q) const {
  Motions moved;
  motions(q, std::span(moved).first(joints_.size()));
  const Eigen::Vector3d p_RT = moved[joints_.size() - 1] * X_RT_.translation();
  ChainJacobian J(6, size());
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    // A joint's own motion leaves its axis where it is.
    const Eigen::Vector3d axis = moved[i].linear() * joints_[i].axis_R;
    if (joints_[i].slides) {
      J.col(column) << axis, Eigen::Vector3d::Zero();
    } else {
      J.col(column) << axis.cross(p_RT - moved[i] * joints_[i].p_RA), axis;
    }
  }
  return J;
}

JointVector SerialChain::holding_torques(const JointVector& q, std::span<const ChainMass> masses,
                                         const Eigen::Vector3d& gravity_R) const {
  Motions moved;
  motions(q, std::span(moved).first(joints_.size()));
  JointVector torques = JointVector::Zero(size());
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const Eigen::Vector3d axis = moved[i].linear() * joints_[i].axis_R;
    const Eigen::Vector3d anchor = moved[i] * joints_[i].p_RA;
    for (std::size_t j = i; j < joints_.size(); ++j) {
      const Eigen::Vector3d weight = masses[j].mass_kg * gravity_R;
      const Eigen::Vector3d arm = moved[j] * masses[j].p_RC - anchor;
      torques(static_cast<Eigen::Index>(i)) -=
          axis.dot(joints_[i].slides ? weight : Eigen::Vector3d(arm.cross(weight)));
    }
  }
  return torques;
}

double SerialChain::longest_reach_m() const {
  double sum_m = 0.0;
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const Eigen::Vector3d next =
        i + 1 < joints_.size() ? joints_[i + 1].p_RA : Eigen::Vector3d(X_RT_.translation());
    sum_m += (next - joints_[i].p_RA).norm();
    if (joints_[i].slides) sum_m += std::max(-joints_[i].low, joints_[i].high);
  }
  return sum_m;
}

}  // namespace parallax::harness
