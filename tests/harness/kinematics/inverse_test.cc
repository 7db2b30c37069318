#include "harness/kinematics/inverse.h"

#include <doctest/doctest.h>

#include <cmath>

#include "tests/harness/kinematics/sample_chains.h"

namespace parallax::harness {
namespace {

bool within_stops(const SerialChain& chain, const JointVector& q) {
  for (Eigen::Index i = 0; i < chain.size(); ++i) {
    const ChainJoint& joint = chain.joints()[static_cast<std::size_t>(i)];
    if (q(i) < joint.low || q(i) > joint.high) return false;
  }
  return true;
}

/// Checks that the result describes itself correctly, whether it reached the goal or not.
void check_honest(const SerialChain& chain, const Eigen::Isometry3d& goal,
                  const InverseResult& result) {
  const auto error = pose_error(chain.tool(result.q), goal);
  CHECK(within_stops(chain, result.q));
  CHECK(result.short_m == doctest::Approx(error.head<3>().norm()));
  CHECK(result.short_rad == doctest::Approx(error.tail<3>().norm()));
  CHECK(result.reached == (error.head<3>().norm() <= 1e-4 && error.tail<3>().norm() <= 1e-3));
}

TEST_CASE("poses that an arm of six joints has had are found again") {
  Draws draws(21);
  const SerialChain chain = six_joint_arm();
  int reached = 0;
  constexpr int kRounds = 500;
  for (int round = 0; round < kRounds; ++round) {
    const Eigen::Isometry3d goal = chain.tool(drawn_positions(chain, draws));
    const InverseResult result = solve_inverse(chain, goal, JointVector::Zero(6));
    check_honest(chain, goal, result);
    if (result.reached) ++reached;
  }
  // Postures at the stops of several joints lie behind walls; restarts find nearly all.
  CHECK(reached >= kRounds - 10);
}

TEST_CASE("chains of any build, with sliders and with joints to spare, find their poses again") {
  Draws draws(22);
  int reached = 0;
  constexpr int kRounds = 200;
  for (int round = 0; round < kRounds; ++round) {
    const SerialChain chain = drawn_chain(7 + round % 3, draws);
    const Eigen::Isometry3d goal = chain.tool(drawn_positions(chain, draws, 0.8));
    const InverseResult result = solve_inverse(chain, goal, JointVector::Zero(chain.size()));
    check_honest(chain, goal, result);
    if (result.reached) ++reached;
  }
  CHECK(reached >= kRounds - 10);
}

TEST_CASE("a goal out of reach is said to be, with what is missing") {
  const SerialChain chain = six_joint_arm();
  Eigen::Isometry3d goal = Eigen::Isometry3d::Identity();
  // Level, the wrist is 0.2 m above the tool: 1.2 m away, where the arm ends at 0.8 m.
  goal.translation() = Eigen::Vector3d(1.2, 0.0, -0.2);
  InverseOptions options;
  options.radian_as_m = 10.0;  // the turn is kept, at the cost of the place
  const InverseResult result = solve_inverse(chain, goal, bent(), options);
  check_honest(chain, goal, result);
  CHECK_FALSE(result.reached);
  CHECK(result.short_m == doctest::Approx(0.4).epsilon(0.01));
  // Turned away, the tool would come nearer: as the weight says.
  CHECK(solve_inverse(chain, goal, bent()).short_m < 0.4);
}

TEST_CASE("stops are kept, and named where they are in the way") {
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.translation() = Eigen::Vector3d(1.0, 0.0, 0.0);
  const SerialChain chain({{"a", false, z, {0.0, 0.0, 0.0}, -1.0, 0.5}}, X);
  Eigen::Isometry3d goal = Eigen::Isometry3d::Identity();
  goal.rotate(Eigen::AngleAxisd(1.2, z));
  goal.translation() = goal.linear() * X.translation();
  const InverseResult result = solve_inverse(chain, goal, JointVector::Zero(1));
  check_honest(chain, goal, result);
  CHECK_FALSE(result.reached);
  CHECK(result.q(0) == doctest::Approx(0.5));
  CHECK(result.at_stop == 1U);
  CHECK(result.short_rad == doctest::Approx(0.7));
}

TEST_CASE("the same question has the same answer to the last bit") {
  Draws draws(23);
  const SerialChain chain = six_joint_arm();
  for (int round = 0; round < 20; ++round) {
    const Eigen::Isometry3d goal = chain.tool(drawn_positions(chain, draws));
    const InverseResult one = solve_inverse(chain, goal, bent());
    const InverseResult other = solve_inverse(chain, goal, bent());
    CHECK(one.q == other.q);
  }
}

}  // namespace
}  // namespace parallax::harness
