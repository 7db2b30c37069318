// Vectors, rotations and rigid motions, compared with Eigen and with laws that must hold for them.
#include "compiler/builtins/pose_math.h"

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace parallax::compiler {
namespace {

constexpr int kRounds = 2000;

class Random {
 public:
  double number(double size) { return std::uniform_real_distribution<double>(-size, size)(bits_); }
  Vector3 vector() { return {number(10.0), number(10.0), number(10.0)}; }
  Quaternion any() { return {number(2.0), number(2.0), number(2.0), number(2.0)}; }
  Quaternion turn() {
    for (;;) {
      if (const auto out = unit(any())) return *out;
    }
  }
  RigidMotion motion() { return {vector(), turn()}; }

 private:
  std::mt19937_64 bits_{7};
};

Eigen::Vector3d eigen(const Vector3& v) { return {v.x, v.y, v.z}; }
Eigen::Quaterniond eigen(const Quaternion& q) { return {q.w, q.x, q.y, q.z}; }
Eigen::Isometry3d eigen(const RigidMotion& m) {
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
  out.translate(eigen(m.at));
  out.rotate(eigen(m.turn));
  return out;
}

double apart(const Vector3& v, const Eigen::Vector3d& e) { return (eigen(v) - e).norm(); }
/// Distance of the two rotations; q and -q are the same rotation.
double apart(const Quaternion& q, const Eigen::Quaterniond& e) {
  return (eigen(q).toRotationMatrix() - e.toRotationMatrix()).norm();
}
double apart(const RigidMotion& m, const Eigen::Isometry3d& e) {
  return (eigen(m).matrix() - e.matrix()).norm();
}

TEST_CASE("pose arithmetic agrees with Eigen") {
  Random random;
  for (int i = 0; i < kRounds; ++i) {
    const auto a = random.vector();
    const auto b = random.vector();
    const auto p = random.any();
    const auto q = random.any();
    const auto turn = random.turn();
    const double angle = random.number(7.0);
    CHECK(apart(cross(a, b), eigen(a).cross(eigen(b))) < 1e-12);
    CHECK(std::abs(dot(a, b) - eigen(a).dot(eigen(b))) < 1e-12);
    CHECK(std::abs(length(a) - eigen(a).norm()) < 1e-12);
    const auto pq = eigen(p) * eigen(q);
    CHECK((eigen(product(p, q)).coeffs() - pq.coeffs()).norm() < 1e-12);
    REQUIRE(inverse(p));
    CHECK((eigen(*inverse(p)).coeffs() - eigen(p).inverse().coeffs()).norm() < 1e-6);
    CHECK(apart(rotated(turn, a), eigen(turn) * eigen(a)) < 1e-12);
    REQUIRE(around(a, angle));
    CHECK(apart(*around(a, angle),
                Eigen::Quaterniond(Eigen::AngleAxisd(angle, eigen(a).normalized()))) < 1e-12);
    const double x = random.number(4.0);
    const double y = random.number(4.0);
    const Eigen::Quaterniond euler = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()) *
                                     Eigen::AngleAxisd(y, Eigen::Vector3d::UnitY()) *
                                     Eigen::AngleAxisd(x, Eigen::Vector3d::UnitX());
    CHECK(apart(from_euler(x, y, angle), euler) < 1e-12);
    const auto m = random.motion();
    const auto n = random.motion();
    CHECK(apart(composed(m, n), eigen(m) * eigen(n)) < 1e-12);
    CHECK(apart(inverse(m), eigen(m).inverse()) < 1e-12);
  }
}

TEST_CASE("pose arithmetic: inverses, grouping, lengths") {
  Random random;
  for (int i = 0; i < kRounds; ++i) {
    const auto a = random.motion();
    const auto b = random.motion();
    const auto c = random.motion();
    const auto v = random.vector();
    const Eigen::Isometry3d identity = Eigen::Isometry3d::Identity();
    CHECK(apart(composed(a, inverse(a)), identity) < 1e-12);
    CHECK(apart(composed(inverse(a), a), identity) < 1e-12);
    CHECK(apart(composed(composed(a, b), c), eigen(composed(a, composed(b, c)))) < 1e-11);
    CHECK(apart(inverse(composed(a, b)), eigen(composed(inverse(b), inverse(a)))) < 1e-11);
    CHECK(std::abs(length(rotated(a.turn, v)) - length(v)) < 1e-12);
    CHECK(std::abs(length(composed(a, b).turn) - 1.0) < 1e-15);
    // A turn by an angle is one by that angle.
    const double angle = std::abs(random.number(std::numbers::pi));
    CHECK(std::abs(angle_rad(*around(v, angle)) - angle) < 1e-6);
  }
  // Rounding does not add up over a long chain.
  RigidMotion chain;
  const RigidMotion step = {{0.1, 0.0, 0.0}, *around({0.0, 0.0, 1.0}, 0.001)};
  for (int i = 0; i < 100000; ++i) chain = composed(chain, step);
  CHECK(std::abs(length(chain.turn) - 1.0) < 1e-14);
}

TEST_CASE("pose arithmetic: what has no direction or is not finite") {
  CHECK(!unit({0.0, 0.0, 0.0, 0.0}));
  CHECK(!unit({1e-7, 0.0, 0.0, 0.0}));
  CHECK(!inverse(Quaternion{0.0, 0.0, 0.0, 0.0}));
  CHECK(!around({0.0, 0.0, 0.0}, 1.0));
  const double infinite = std::numeric_limits<double>::infinity();
  CHECK(!unit({infinite, 0.0, 0.0, 1.0}));
  CHECK(!unit({std::nan(""), 0.0, 0.0, 1.0}));
  CHECK(!around({std::nan(""), 0.0, 1.0}, 1.0));
  CHECK(!is_finite(scaled({1e300, 0.0, 0.0}, 1e300)));
  // Large but finite ones have a direction.
  REQUIRE(unit({1e300, 0.0, 0.0, 1e300}));
  CHECK(std::abs(length(*unit({1e300, 0.0, 0.0, 1e300})) - 1.0) < 1e-15);
}

TEST_CASE("pose arithmetic: angles are in [-pi, pi)") {
  constexpr double kPi = std::numbers::pi;
  CHECK(normalized_angle_rad(kPi) == doctest::Approx(-kPi));
  CHECK(normalized_angle_rad(-kPi) == doctest::Approx(-kPi));
  CHECK(normalized_angle_rad(3.0 * kPi / 2.0) == doctest::Approx(-kPi / 2.0));
  CHECK(normalized_angle_rad(0.5) == doctest::Approx(0.5));
  CHECK(normalized_angle_rad(1e6) < kPi);
  CHECK(std::abs(std::sin(normalized_angle_rad(1234.5)) - std::sin(1234.5)) < 1e-12);
}

}  // namespace
}  // namespace parallax::compiler
