#include "harness/kinematics/serial_chain.h"

#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include "harness/kinematics/inverse.h"
#include "tests/harness/kinematics/sample_chains.h"

namespace parallax::harness {
namespace {

TEST_CASE("two hinges in a plane put the tool where plane geometry says") {
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.translation() = Eigen::Vector3d(0.9, 0.0, 0.1);
  const SerialChain chain({{"a", false, z, {0.0, 0.0, 0.3}}, {"b", false, z, {0.5, 0.0, 0.0}}}, X);
  JointVector q(2);
  q << 0.7, -0.4;
  const Eigen::Isometry3d tool = chain.tool(q);
  CHECK(tool.translation().x() == doctest::Approx(0.5 * std::cos(0.7) + 0.4 * std::cos(0.3)));
  CHECK(tool.translation().y() == doctest::Approx(0.5 * std::sin(0.7) + 0.4 * std::sin(0.3)));
  CHECK(tool.translation().z() == doctest::Approx(0.1));
  CHECK(std::atan2(tool.linear()(1, 0), tool.linear()(0, 0)) == doctest::Approx(0.3));
}

TEST_CASE("the Jacobian is what small differences say, whatever the chain") {
  Draws draws(11);
  for (int round = 0; round < 200; ++round) {
    const SerialChain chain = drawn_chain(1 + round % kMostChainJoints, draws);
    const JointVector q = drawn_positions(chain, draws);
    const ChainJacobian J = chain.jacobian(q);
    REQUIRE(J.cols() == chain.size());
    for (Eigen::Index i = 0; i < chain.size(); ++i) {
      constexpr double kStep = 1e-6;
      JointVector before = q, after = q;
      before(i) -= kStep;
      after(i) += kStep;
      const Eigen::Matrix<double, 6, 1> rate =
          pose_error(chain.tool(before), chain.tool(after)) / (2.0 * kStep);
      CHECK((rate - J.col(i)).cwiseAbs().maxCoeff() < 1e-6);
    }
  }
}

TEST_CASE("what hangs on the last joint moves as the tool does") {
  Draws draws(12);
  for (int round = 0; round < 50; ++round) {
    const SerialChain chain = drawn_chain(7, draws);
    const JointVector q = drawn_positions(chain, draws);
    std::array<Eigen::Isometry3d, kMostChainJoints> motions;
    chain.motions(q, std::span(motions).first(7));
    const Eigen::Isometry3d at_zero = chain.tool(JointVector::Zero(7));
    CHECK((motions[6] * at_zero).isApprox(chain.tool(q), 1e-12));
  }
}

TEST_CASE("the torques that hold an arm still are the slope of its potential energy") {
  Draws draws(13);
  for (int round = 0; round < 100; ++round) {
    const SerialChain chain = drawn_chain(6, draws);
    const JointVector q = drawn_positions(chain, draws);
    std::array<ChainMass, 6> masses;
    for (ChainMass& mass : masses) mass = {draws.within(0.1, 3.0), draws.vector(0.6)};
    const Eigen::Vector3d gravity = draws.vector(10.0);
    const auto energy_j = [&](const JointVector& at) {
      std::array<Eigen::Isometry3d, kMostChainJoints> motions;
      chain.motions(at, std::span(motions).first(6));
      double sum = 0.0;
      for (std::size_t i = 0; i < 6; ++i) {
        sum -= masses[i].mass_kg * gravity.dot(motions[i] * masses[i].p_RC);
      }
      return sum;
    };
    const JointVector torques = chain.holding_torques(q, masses, gravity);
    for (Eigen::Index i = 0; i < 6; ++i) {
      constexpr double kStep = 1e-6;
      JointVector before = q, after = q;
      before(i) -= kStep;
      after(i) += kStep;
      const double slope = (energy_j(after) - energy_j(before)) / (2.0 * kStep);
      CHECK(torques(i) == doctest::Approx(slope).epsilon(1e-5).scale(1.0));
    }
  }
}

TEST_CASE(
    "no tool is farther from the first joint than the longest reach, and a stretched one is "
    "there") {
  Draws draws(14);
  for (int round = 0; round < 200; ++round) {
    const SerialChain chain = drawn_chain(5, draws);
    const Eigen::Vector3d tool = chain.tool(drawn_positions(chain, draws)).translation();
    CHECK((tool - chain.joints()[0].p_RA).norm() <= chain.longest_reach_m() + 1e-12);
  }
  CHECK(six_joint_arm().longest_reach_m() == doctest::Approx(1.0));
}

}  // namespace
}  // namespace parallax::harness
