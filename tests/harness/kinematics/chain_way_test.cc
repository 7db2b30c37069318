#include "harness/kinematics/chain_way.h"

#include <doctest/doctest.h>

#include <cmath>

#include "tests/harness/kinematics/sample_chains.h"

namespace parallax::harness {
namespace {

Eigen::Isometry3d shifted(Eigen::Isometry3d X, const Eigen::Vector3d& by) {
  X.translation() += by;
  return X;
}

double off_line_m(const Eigen::Vector3d& p, const Eigen::Vector3d& from,
                  const Eigen::Vector3d& to) {
  const Eigen::Vector3d ahead = (to - from).normalized();
  return (p - from - ahead * ahead.dot(p - from)).norm();
}

TEST_CASE("a tool led along a line stays on it, upright, between the samples too") {
  const SerialChain chain = six_joint_arm();
  const Eigen::Isometry3d from = chain.tool(bent());
  const Eigen::Isometry3d goal = shifted(from, {0.15, 0.25, 0.10});
  const ChainWay way = follow_way(chain, bent(), goal, {}, nullptr);
  REQUIRE(way.whole());
  for (int i = 0; i <= 1000; ++i) {
    const double share = i / 1000.0;
    const Eigen::Isometry3d X = chain.tool(way.at(share));
    CHECK(off_line_m(X.translation(), from.translation(), goal.translation()) < 2e-4);
    CHECK((X.translation() - from.translation()).norm() ==
          doctest::Approx(share * 0.308221).epsilon(0.002).scale(0.1));
    CHECK(std::acos(std::min(1.0, X.linear()(2, 2))) < 2e-3);
  }
  CHECK(pose_error(chain.tool(way.last()), goal).norm() < 1e-3);
}

TEST_CASE("the slope of a way is how its positions change") {
  const SerialChain chain = six_joint_arm();
  const ChainWay way =
      follow_way(chain, bent(), shifted(chain.tool(bent()), {0.1, -0.2, 0.0}), {}, nullptr);
  REQUIRE(way.whole());
  for (const double share : {0.03, 0.31, 0.77, 0.985}) {
    const JointVector change = (way.at(share + 1e-5) - way.at(share - 1e-5)) / 2e-5;
    CHECK((change - way.slope(share)).cwiseAbs().maxCoeff() < 1e-6);
  }
}

TEST_CASE("a turn on the spot leaves the tool where it is") {
  const SerialChain chain = six_joint_arm();
  Eigen::Isometry3d goal = chain.tool(bent());
  const Eigen::Vector3d p = goal.translation();
  goal.linear() = Eigen::AngleAxisd(1.4, Eigen::Vector3d::UnitZ()) * goal.linear();
  const ChainWay way = follow_way(chain, bent(), goal, {}, nullptr);
  REQUIRE(way.whole());
  for (int i = 0; i <= 100; ++i) {
    CHECK((chain.tool(way.at(i / 100.0)).translation() - p).norm() < 2e-4);
  }
}

TEST_CASE("a way out of reach ends where the arm is stretched, and says so") {
  const SerialChain chain = six_joint_arm();
  const Eigen::Isometry3d from = chain.tool(bent());
  const ChainWay way = follow_way(chain, bent(), shifted(from, {1.0, 0.2, 0.0}), {}, nullptr);
  CHECK_FALSE(way.whole());
  CHECK(way.share > 0.1);
  CHECK(way.share < 1.0);
  // The wrist, 0.2 m above the tool, is nearly as far from the shoulder as the arm is long.
  const Eigen::Vector3d wrist = chain.tool(way.last()) * Eigen::Vector3d(0.0, 0.0, 0.2);
  CHECK(wrist.norm() > 0.75);
  CHECK(wrist.norm() <= 0.8 + 1e-4);
}

TEST_CASE("a stop that ends a way is named") {
  const SerialChain chain = six_joint_arm();
  Eigen::Isometry3d goal = chain.tool(bent());
  goal.linear() = Eigen::AngleAxisd(2.9, Eigen::Vector3d::UnitX()) * goal.linear();
  const ChainWay way = follow_way(chain, bent(), goal, {}, nullptr);
  CHECK_FALSE(way.whole());
  CHECK(way.fault.find("`roll`") != std::string::npos);
}

TEST_CASE("a line over the shoulder's axis cannot be followed") {
  // Over the axis, the pan would have to turn by half a circle at once.
  const SerialChain chain = six_joint_arm();
  JointVector q(6);
  q << 0.0, -1.5, 2.7, -1.2, 0.0, 0.0;
  const Eigen::Isometry3d from = chain.tool(q);
  const Eigen::Vector3d p = from.translation();
  const ChainWay way = follow_way(chain, q, shifted(from, {-p.x() - 0.2, 0.003, 0.0}), {}, nullptr);
  CHECK_FALSE(way.whole());
}

TEST_CASE("what a check says ends the way before it") {
  const SerialChain chain = six_joint_arm();
  const Eigen::Isometry3d from = chain.tool(bent());
  const double wall_m = from.translation().y() + 0.095;
  const auto check = [&](const JointVector& q) -> std::optional<std::string> {
    if (chain.tool(q).translation().y() < wall_m) return std::nullopt;
    return "a wall";
  };
  const ChainWay way = follow_way(chain, bent(), shifted(from, {0.0, 0.25, 0.0}), {}, check);
  CHECK(way.fault == "a wall");
  CHECK(way.share == doctest::Approx(0.36));
  CHECK(chain.tool(way.at(1.0)).translation().y() < wall_m);
}

TEST_CASE("a swing takes all joints evenly from one end to the other, in steps that are short") {
  JointVector goal = bent();
  goal(0) += 1.3;
  goal(2) -= 0.4;
  const ChainWay way = swing_way(bent(), goal, 0.05);
  CHECK(way.whole());
  CHECK(way.samples.front() == bent());
  CHECK((way.last() - goal).norm() < 1e-12);
  CHECK((way.at(0.37) - (bent() + 0.37 * (goal - bent()))).norm() < 1e-12);
  for (std::size_t i = 1; i < way.samples.size(); ++i) {
    CHECK((way.samples[i] - way.samples[i - 1]).cwiseAbs().maxCoeff() <= 0.05 + 1e-12);
  }
}

}  // namespace
}  // namespace parallax::harness
