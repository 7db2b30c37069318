// The springs under a base against mechanics in closed form.

#include <doctest/doctest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <string>

#include "harness/engine/world_check.h"
#include "tests/harness/engine/engines.h"
#include "tests/harness/world/hand_made.h"

namespace parallax::harness {
namespace {

constexpr double kPull_m_s2 = 9.81;
constexpr double kBase_kg = 80.0;

SuspensionSpec springs(double damping_n_s_m, double damping_nm_s) {
  return {40000.0, damping_n_s_m, 6000.0, damping_nm_s};
}

/// A base of 1 m by 1 m on springs.
WorldSpec suspended(const SuspensionSpec& suspension) {
  BodySpec base = box_body("base", {1.0, 1.0, 0.4}, {0.0, 0.0, 0.3}, kBase_kg);
  WorldSpec spec = world_of({base});
  JointSpec wheels;
  wheels.name = "wheels";
  wheels.type = JointType::kGantry;
  wheels.child = "base";
  wheels.max_force_n = 300.0;
  wheels.suspension = suspension;
  spec.joints = {wheels};
  spec.friction.fallback = 0.8;
  return spec;
}

/// A base whose wheels are held at a height of the floor under them.
class Standing {
 public:
  Standing(EngineKind engine, const WorldSpec& spec) {
    REQUIRE(check_world(stepped_by(engine, spec)).empty());
    world_ = make_world(stepped_by(engine, spec));
    REQUIRE_FALSE(world_->reset(default_placements(world_->layout()), 1).has_value());
  }
  void run(double time_s, double floor_m = 0.0) {
    const auto gantry = *world_->layout().find_gantry("wheels");
    const auto steps = std::lround(time_s / world_->timestep_s());
    for (long i = 0; i < steps; ++i) {
      const double left_m = floor_m - world_->gantry_position_m(gantry).z();
      world_->set_gantry(gantry, {0.0, 0.0, left_m / world_->timestep_s()}, 0.0);
      REQUIRE(world_->step());
    }
  }
  double sag_m() const { return 0.3 - world_->position(base()).z(); }
  Eigen::Vector3d up() const { return world_->rotation(base()).col(2); }

 private:
  BodyId base() const { return *world_->layout().find_body("base"); }
  std::unique_ptr<PhysicsWorld> world_;
};

TEST_CASE("an unloaded base stands at its default height, level") {
  for (const EngineKind engine : engines()) {
    CAPTURE(to_string(engine));
    Standing standing(engine, suspended(springs(2000.0, 300.0)));
    standing.run(2.0);
    CHECK(std::abs(standing.sag_m()) < 1e-5);
    CHECK(standing.up().z() == doctest::Approx(1.0));
  }
}

TEST_CASE("a load in the middle presses the base down by its weight over the stiffness") {
  for (const EngineKind engine : engines()) {
    CAPTURE(to_string(engine));
    WorldSpec spec = suspended(springs(2000.0, 300.0));
    spec.bodies.push_back(box_body("load", {0.2, 0.2, 0.1}, {0.0, 0.0, 0.55}, 12.0));
    Standing standing(engine, spec);
    standing.run(3.0);
    CHECK(standing.sag_m() == doctest::Approx(12.0 * kPull_m_s2 / 40000.0).epsilon(0.01));
    CHECK(standing.up().z() == doctest::Approx(1.0));
  }
}

TEST_CASE("a load at the side leans the base by its moment over the stiffness") {
  for (const EngineKind engine : engines()) {
    CAPTURE(to_string(engine));
    WorldSpec spec = suspended(springs(2000.0, 300.0));
    spec.bodies.push_back(box_body("load", {0.2, 0.2, 0.1}, {0.35, 0.0, 0.55}, 6.0));
    Standing standing(engine, spec);
    standing.run(3.0);
    // Forwards, about y. The load's and the body's own heights add a little: 0.25 m and 0.2 m over
    // the middle that turns, at an angle of a fiftieth of a radian.
    const double lean_rad = std::atan2(standing.up().x(), standing.up().z());
    CHECK(lean_rad == doctest::Approx(6.0 * kPull_m_s2 * 0.35 / 6000.0).epsilon(0.03));
    CHECK(std::abs(standing.up().y()) < 1e-4);
  }
}

TEST_CASE("a base that is let go swings as a mass on a spring with a damper") {
  for (const EngineKind engine : engines()) {
    CAPTURE(to_string(engine));
    constexpr double kDamping_n_s_m = 500.0;
    Standing standing(engine, suspended(springs(kDamping_n_s_m, 300.0)));
    // The floor rises by 5 mm at once: the base goes up to it in a swing.
    const double rate_hz = kDamping_n_s_m / (2.0 * kBase_kg);
    const double frequency = std::sqrt(40000.0 / kBase_kg - rate_hz * rate_hz);
    for (const double share : {0.25, 0.5, 0.75, 1.0}) {
      standing.run(0.25 * 2.0 * std::numbers::pi / frequency, 0.005);
      const double t = share * 2.0 * std::numbers::pi / frequency;
      const double left_m =
          0.005 * std::exp(-rate_hz * t) *
          (std::cos(frequency * t) + rate_hz / frequency * std::sin(frequency * t));
      // Steps of 2 ms, taken at their end, damp a little besides.
      CHECK(-standing.sag_m() == doctest::Approx(0.005 - left_m).scale(1.0).epsilon(4e-4));
    }
  }
}

TEST_CASE("springs that are none, or of a gantry of the robot, are refused") {
  const auto complaint = [](const WorldSpec& spec) {
    const auto problems = check_world(spec);
    return problems.empty() ? std::string() : problems[0].path + " " + problems[0].message;
  };
  WorldSpec spec = suspended({0.0, 100.0, 6000.0, 100.0});
  CHECK(complaint(spec) == "joints/wheels/suspension/stiffness_n_m is not a positive number");
  spec = suspended(springs(-1.0, 0.0));
  CHECK(complaint(spec) == "joints/wheels/suspension/damping_n_s_m is negative or not a number");
  spec = suspended(springs(1.0, 1.0));
  spec.bodies.push_back(box_body("cart", {1.0, 1.0, 0.1}, {0.0, 0.0, 0.05}, 5.0));
  spec.joints[0].parent = "cart";
  CHECK(complaint(spec) == "joints/wheels/suspension belongs to gantries of the world");
}

}  // namespace
}  // namespace parallax::harness
