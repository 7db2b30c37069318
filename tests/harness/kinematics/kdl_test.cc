// Chains of joints held against KDL, the library of the Orocos project: it goes from link to link,
// where ours multiplies motions about axes of one placement.

#include <doctest/doctest.h>

#if !__has_include(<kdl/chain.hpp>)

#include <cstdio>

TEST_CASE("held against KDL") { std::puts("SKIPPED: KDL is not here (liborocos-kdl-dev)"); }

#else

#include <array>
#include <kdl/chain.hpp>
#include <kdl/chaindynparam.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainiksolverpos_lma.hpp>
#include <kdl/chainjnttojacsolver.hpp>
#include <kdl/frames.hpp>
#include <kdl/jntarray.hpp>
#include <span>

#include "harness/kinematics/inverse.h"
#include "harness/kinematics/serial_chain.h"
#include "tests/harness/kinematics/sample_chains.h"

namespace parallax::harness {
namespace {

KDL::Vector to_kdl(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

KDL::Frame to_kdl(const Eigen::Isometry3d& X) {
  const Eigen::Matrix3d R = X.linear();
  return {KDL::Rotation(R(0, 0), R(0, 1), R(0, 2), R(1, 0), R(1, 1), R(1, 2), R(2, 0), R(2, 1),
                        R(2, 2)),
          to_kdl(Eigen::Vector3d(X.translation()))};
}

Eigen::Isometry3d from_kdl(const KDL::Frame& frame) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) X.linear()(row, column) = frame.M(row, column);
    X.translation()(row) = frame.p(row);
  }
  return X;
}

KDL::JntArray to_kdl(const JointVector& q) {
  KDL::JntArray out(static_cast<unsigned>(q.size()));
  for (Eigen::Index i = 0; i < q.size(); ++i) out(static_cast<unsigned>(i)) = q(i);
  return out;
}

/// Each link begins where the root is at positions 0; the last one ends at the tool.
KDL::Chain kdl_chain(const SerialChain& chain, std::span<const ChainMass> masses = {}) {
  KDL::Chain out;
  const Eigen::Isometry3d X_RT = chain.tool(JointVector::Zero(chain.size()));
  for (std::size_t i = 0; i < chain.joints().size(); ++i) {
    const ChainJoint& joint = chain.joints()[i];
    const bool is_last = i + 1 == chain.joints().size();
    const KDL::Frame tip = is_last ? to_kdl(X_RT) : KDL::Frame::Identity();
    KDL::RigidBodyInertia inertia = KDL::RigidBodyInertia::Zero();
    if (!masses.empty()) {
      const Eigen::Vector3d centre_R = masses[i].p_RC;
      const Eigen::Vector3d centre = is_last ? X_RT.inverse() * centre_R : centre_R;
      inertia = KDL::RigidBodyInertia(masses[i].mass_kg, to_kdl(centre));
    }
    out.addSegment(
        KDL::Segment(joint.name,
                     KDL::Joint(joint.name, to_kdl(joint.p_RA), to_kdl(joint.axis_R),
                                joint.slides ? KDL::Joint::TransAxis : KDL::Joint::RotAxis),
                     tip, inertia));
  }
  return out;
}

TEST_CASE("the tool and its Jacobian are where KDL has them") {
  Draws draws(21);
  for (int round = 0; round < 400; ++round) {
    const SerialChain chain = drawn_chain(1 + round % kMostChainJoints, draws);
    const KDL::Chain other = kdl_chain(chain);
    const JointVector q = drawn_positions(chain, draws);
    KDL::ChainFkSolverPos_recursive places(other);
    KDL::Frame tool;
    REQUIRE(places.JntToCart(to_kdl(q), tool) >= 0);
    CHECK((chain.tool(q).matrix() - from_kdl(tool).matrix()).cwiseAbs().maxCoeff() < 1e-12);
    KDL::ChainJntToJacSolver rates(other);
    KDL::Jacobian theirs(static_cast<unsigned>(chain.size()));
    REQUIRE(rates.JntToJac(to_kdl(q), theirs) >= 0);
    CHECK((chain.jacobian(q) - theirs.data).cwiseAbs().maxCoeff() < 1e-12);
  }
}

TEST_CASE("the torques that hold an arm still are KDL's") {
  Draws draws(22);
  for (int round = 0; round < 200; ++round) {
    const SerialChain chain = drawn_chain(7, draws);
    std::array<ChainMass, 7> masses;
    for (ChainMass& mass : masses) mass = {draws.within(0.1, 3.0), draws.vector(0.6)};
    const JointVector q = drawn_positions(chain, draws);
    const Eigen::Vector3d gravity = draws.vector(10.0);
    const KDL::Chain other = kdl_chain(chain, masses);
    KDL::ChainDynParam dynamics(other, to_kdl(gravity));
    KDL::JntArray theirs(7);
    REQUIRE(dynamics.JntToGravity(to_kdl(q), theirs) >= 0);
    const JointVector ours = chain.holding_torques(q, masses, gravity);
    for (Eigen::Index i = 0; i < 7; ++i)
      CHECK(ours(i) == doctest::Approx(theirs(static_cast<unsigned>(i))).epsilon(1e-9));
  }
}

TEST_CASE("positions that were found bring KDL's tool to the goal; what KDL reaches is reached") {
  Draws draws(23);
  const SerialChain chain = six_joint_arm();
  const KDL::Chain other = kdl_chain(chain);
  KDL::ChainFkSolverPos_recursive places(other);
  KDL::ChainIkSolverPos_LMA solver(other);
  int by_kdl = 0;
  for (int round = 0; round < 100; ++round) {
    const Eigen::Isometry3d goal = chain.tool(drawn_positions(chain, draws, 0.9));
    const InverseResult ours = solve_inverse(chain, goal, bent());
    if (ours.reached) {
      KDL::Frame tool;
      REQUIRE(places.JntToCart(to_kdl(ours.q), tool) >= 0);
      const Eigen::Matrix<double, 6, 1> error = pose_error(from_kdl(tool), goal);
      CHECK(error.head<3>().norm() < 1.1e-4);
      CHECK(error.tail<3>().norm() < 1.1e-3);
    }
    KDL::JntArray theirs(6);
    if (solver.CartToJnt(to_kdl(bent()), to_kdl(goal), theirs) < 0) continue;
    bool within = true;  // KDL knows no stops
    for (unsigned i = 0; i < 6; ++i) {
      const ChainJoint& joint = chain.joints()[i];
      within = within && theirs(i) >= joint.low && theirs(i) <= joint.high;
    }
    if (!within) continue;
    ++by_kdl;
    CHECK(ours.reached);
  }
  CHECK(by_kdl > 10);
}

}  // namespace
}  // namespace parallax::harness

#endif
