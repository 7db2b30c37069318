#pragma once

#include <cstdint>
#include <random>

#include "harness/kinematics/serial_chain.h"

namespace parallax::harness {

/// Numbers that every platform draws alike.
class Draws {
 public:
  explicit Draws(std::uint64_t seed) : engine_(seed) {}
  double within(double low, double high) {
    constexpr double kSteps = 9007199254740992.0;  // 2^53
    return low + (high - low) * (static_cast<double>(engine_() >> 11U) / kSteps);
  }
  Eigen::Vector3d vector(double most) {
    const double x = within(-most, most), y = within(-most, most);
    return {x, y, within(-most, most)};
  }

 private:
  std::mt19937_64 engine_;
};

inline JointVector drawn_positions(const SerialChain& chain, Draws& draws, double share = 1.0) {
  JointVector q(chain.size());
  for (Eigen::Index i = 0; i < chain.size(); ++i) {
    const ChainJoint& joint = chain.joints()[static_cast<std::size_t>(i)];
    q(i) = share * draws.within(joint.low, joint.high);
  }
  return q;
}

/// Joints anywhere, every third of them a slider, and a tool turned anyhow.
inline SerialChain drawn_chain(int joints, Draws& draws) {
  std::vector<ChainJoint> all;
  for (int i = 0; i < joints; ++i) {
    ChainJoint joint;
    joint.name = "joint " + std::to_string(i);
    joint.slides = i % 3 == 2;
    joint.axis_R = draws.vector(1.0).normalized();
    joint.p_RA = draws.vector(0.5);
    joint.low = joint.slides ? -0.2 : -2.0;
    joint.high = joint.slides ? 0.3 : 2.5;
    all.push_back(joint);
  }
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.translation() = draws.vector(0.8);
  X.linear() =
      Eigen::AngleAxisd(draws.within(-3.0, 3.0), draws.vector(1.0).normalized()).toRotationMatrix();
  return {all, X};
}

/// A shoulder that pans at the origin and lifts, an elbow, and a wrist that pitches, rolls and
/// yaws; 0.4 m and 0.4 m long, stretched along x with the tool 0.2 m below the wrist.
inline SerialChain six_joint_arm() {
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY();
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ(), zero = Eigen::Vector3d::Zero();
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.translation() = 0.8 * x - 0.2 * z;
  return {{{"pan", false, z, zero, -2.5, 2.5},
           {"lift", false, y, zero, -2.0, 2.0},
           {"elbow", false, y, 0.4 * x, -2.8, 2.8},
           {"pitch", false, y, 0.8 * x, -2.5, 2.5},
           {"roll", false, x, 0.8 * x, -1.2, 1.2},
           {"yaw", false, z, 0.8 * x, -3.0, 3.0}},
          X};
}

/// The same posture without limits that a hand could not hold: bent, the tool upright.
inline JointVector bent() {
  JointVector q(6);
  q << 0.2, -0.9, 1.8, -0.9, 0.0, -0.2;
  return q;
}

}  // namespace parallax::harness
