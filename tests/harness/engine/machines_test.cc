// The machines of docs/internals/physics.md in every engine: their error at one step, and at a
// quarter.

#include "tools/bench/engines/machines.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "tests/harness/engine/engines.h"
#include "tools/bench/engines/grips.h"

namespace parallax::harness {
namespace {

TEST_CASE("machines move as mechanics says in every engine, the closer the shorter the step") {
  REQUIRE(tools::machines().size() == 6);
  for (const EngineKind engine : engines()) {
    for (const auto& machine : tools::machines()) {
      CAPTURE(to_string(engine));
      CAPTURE(machine.name);
      const double error = machine.error(engine, 0.002), at_a_quarter = machine.error(engine, 5e-4);
      CHECK(error < machine.bound);
      // A first-order integrator has a quarter of the error at a quarter of the step.
      CHECK((at_a_quarter < 0.5 * error || at_a_quarter < machine.none));
    }
  }
}

constexpr double kStep_s = 0.002;

TEST_CASE("a grip and a slope hold what friction bears: a cone does so in every direction") {
  for (const EngineKind engine : engines_with_trees()) {
    CAPTURE(to_string(engine));
    for (const double degrees : {0.0, 20.0, 45.0}) {
      CAPTURE(degrees);
      const double angle = degrees * std::numbers::pi / 180.0;
      // Bullet corrects the two directions of a contact each by its own inertia, so the friction of
      // a corner that slides leans to the side that resists less, by up to 0.93 of its length.
      const double most = engine == EngineKind::kBullet ? 1.0 / 0.93 : 1.01;
      const double grip = tools::least_grip(engine, kStep_s, angle);
      const double slope = tools::least_slope_friction(engine, kStep_s, angle);
      CHECK(grip > 0.99);
      CHECK(grip < most);
      CHECK(slope > 0.99);
      CHECK(slope < most);
    }
  }
}

TEST_CASE("a hull that is a box is gripped as that box is") {
  for (const EngineKind engine : engines()) {
    CAPTURE(to_string(engine));
    for (const double angle : {0.0, 0.25 * std::numbers::pi}) {
      CHECK(tools::least_grip(engine, kStep_s, angle, tools::LoadForm::kHull) ==
            doctest::Approx(tools::least_grip(engine, kStep_s, angle)).epsilon(0.01));
    }
    CHECK(tools::creep_m_s(engine, kStep_s, tools::LoadForm::kHull) < 4e-5);
  }
}

TEST_CASE("ODE bounds friction along two axes, and holds as much along both at the same time") {
  for (const double degrees : {0.0, 20.0, 45.0}) {
    CAPTURE(degrees);
    const double angle = degrees * std::numbers::pi / 180.0;
    const double expected = std::cos(angle);  // the larger of the two parts of the load
    CHECK(tools::least_grip(EngineKind::kOde, kStep_s, angle) ==
          doctest::Approx(expected).epsilon(0.02));
    CHECK(tools::least_slope_friction(EngineKind::kOde, kStep_s, angle) ==
          doctest::Approx(expected).epsilon(0.03));
  }
}

TEST_CASE("a load that is held with twice the force that it needs stays where it is") {
  for (const EngineKind engine : engines()) {
    CAPTURE(to_string(engine));
    CHECK(tools::creep_m_s(engine, kStep_s) < 2e-5);
    CHECK(tools::creep_m_s(engine, 0.004) < 4e-5);
  }
}

}  // namespace
}  // namespace parallax::harness
