// Spheres, cylinders, capsules, inertias and hinges against mechanics in closed form, and against
// equations of motion that are solved here by the method of Runge and Kutta.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "harness/engine/physics_world.h"
#include "harness/engine/world_check.h"
#include "harness/world/shapes.h"
#include "tests/harness/engine/engines.h"
#include "tests/harness/world/hand_made.h"

namespace parallax::harness {
namespace {

constexpr double kGravity_m_s2 = 9.81;

BodySpec round_body(std::string name, ShapeForm form, double radius_m, double length_m,
                    const Eigen::Vector3d& p_WB, double mass_kg) {
  BodySpec body = box_body(std::move(name), round_size_m(form, radius_m, length_m), p_WB, mass_kg);
  body.shapes.front().form = form;
  return body;
}

JointSpec hinge(std::string name, std::string parent, std::string child,
                const Eigen::Vector3d& axis_W, const Eigen::Vector3d& p_WA) {
  JointSpec joint;
  joint.name = std::move(name);
  joint.type = JointType::kHinge;
  joint.parent = std::move(parent);
  joint.child = std::move(child);
  joint.axis_W = axis_W;
  joint.p_WA = p_WA;
  joint.max_torque_nm = 0.0;
  return joint;
}

/// A checked world at the start.
struct Running {
  Running(EngineKind engine, const WorldSpec& spec)
      : owned(make_world(stepped_by(engine, spec))), world(*owned) {
    REQUIRE(check_world(stepped_by(engine, spec)).empty());
    REQUIRE_FALSE(world.reset(default_placements(world.layout()), 1).has_value());
  }
  void run(double time_s) {
    const auto steps = std::lround(time_s / world.timestep_s());
    for (long i = 0; i < steps; ++i) REQUIRE(world.step());
  }
  BodyId body(const char* name) const { return *world.layout().find_body(name); }
  double angle(const char* name) const {
    return world.hinge_angle_rad(*world.layout().find_hinge(name));
  }
  double rate(const char* name) const {
    return world.hinge_rate_rad_s(*world.layout().find_hinge(name));
  }
  std::unique_ptr<PhysicsWorld> owned;
  PhysicsWorld& world;
};

using Angles = std::array<double, 4>;  // two angles and their rates

/// Angles of a system after `time_s`, by Runge and Kutta's method of fourth order.
Angles solved(Angles state, double time_s, const std::function<Angles(const Angles&)>& change) {
  const int steps = 20000;
  const double h = time_s / steps;
  const auto ahead = [](const Angles& at, const Angles& slope, double way) {
    Angles out = at;
    for (std::size_t i = 0; i < out.size(); ++i) out[i] += way * slope[i];
    return out;
  };
  for (int step = 0; step < steps; ++step) {
    const Angles a = change(state), b = change(ahead(state, a, 0.5 * h)),
                 c = change(ahead(state, b, 0.5 * h)), d = change(ahead(state, c, h));
    for (std::size_t i = 0; i < state.size(); ++i) {
      state[i] += h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]);
    }
  }
  return state;
}

constexpr double kBall_m = 0.1, kRod_m = 0.8;  // radius, and from the axis to the middle

double ball_inertia(double mass_kg) { return 0.4 * mass_kg * kBall_m * kBall_m; }

/// A ball beside the axis, let go where its rod is level; it swings about y.
WorldSpec pendulum(double timestep_s) {
  WorldSpec spec =
      world_of({round_body("ball", ShapeForm::kSphere, kBall_m, 0.0, {kRod_m, 0.0, 2.0}, 1.5)});
  spec.joints = {hinge("pivot", "", "ball", Eigen::Vector3d::UnitY(), {0.0, 0.0, 2.0})};
  spec.solver.timestep_s = timestep_s;
  return spec;
}

/// Turn from level after `time_s`, positive downwards: about +y from +x to -z.
double pendulum_angle(double time_s) {
  const double inertia_m2 = kRod_m * kRod_m + ball_inertia(1.0);
  const Angles end = solved({0.0, 0.0, 0.0, 0.0}, time_s, [&](const Angles& at) {
    return Angles{at[2], 0.0, kGravity_m_s2 * kRod_m * std::cos(at[0]) / inertia_m2, 0.0};
  });
  return end[0];
}

TEST_CASE("a pendulum swings as its equation of motion says, the closer the shorter the step") {
  for (const EngineKind engine : engines()) {
    CAPTURE(to_string(engine));
    const double expected = pendulum_angle(2.0);
    std::array<double, 2> error{};
    for (std::size_t i = 0; i < error.size(); ++i) {
      Running running(engine, pendulum(i == 0 ? 0.002 : 0.0005));
      running.run(2.0);
      error[i] = std::abs(running.angle("pivot") - expected);
    }
    CHECK(error[0] < 0.02);
    CHECK(error[1] < 0.005);
    CHECK(error[1] < 0.5 * error[0]);
  }
}

TEST_CASE("an inertia that is given counts instead of the shapes") {
  for (const EngineKind engine : engines()) {
    CAPTURE(to_string(engine));
    Running by_shape(engine, pendulum(0.001));
    by_shape.run(1.0);
    WorldSpec spec = pendulum(0.001);
    BodySpec& ball = spec.bodies.front();
    ball.shapes = {BodyShape{{0.1, 0.2, 0.3}, {-0.4, 0.0, 0.1}}};  // of no account
    ball.p_WB = {0.5, 0.0, 2.1};
    ball.inertia =
        InertiaSpec{{kRod_m - 0.5, 0.0, -0.1}, ball_inertia(1.5) * Eigen::Matrix3d::Identity()};
    Running by_inertia(engine, spec);
    by_inertia.run(1.0);
    CHECK(by_inertia.angle("pivot") == doctest::Approx(by_shape.angle("pivot")).epsilon(1e-6));
  }
}

TEST_CASE("a double pendulum follows its equations for two seconds") {
  for (const EngineKind engine : engines()) {
    CAPTURE(to_string(engine));
    const double m1 = 1.0, m2 = 0.7, l1 = 0.6, l2 = 0.5, g = kGravity_m_s2;
    const double j1 = ball_inertia(m1), j2 = ball_inertia(m2);
    // Angles from straight down, as Lagrange has them.
    const auto change = [&](const Angles& at) {
      const double d = at[0] - at[1];
      const double a = (m1 + m2) * l1 * l1 + j1, b = m2 * l1 * l2 * std::cos(d),
                   c = m2 * l2 * l2 + j2;
      const double e =
          -m2 * l1 * l2 * std::sin(d) * at[3] * at[3] - (m1 + m2) * g * l1 * std::sin(at[0]);
      const double f = m2 * l1 * l2 * std::sin(d) * at[2] * at[2] - m2 * g * l2 * std::sin(at[1]);
      const double determinant = a * c - b * b;
      return Angles{at[2], at[3], (e * c - b * f) / determinant, (a * f - b * e) / determinant};
    };
    const double quarter = 0.5 * std::numbers::pi;
    const Angles expected = solved({quarter, 0.0, 0.0, 0.0}, 2.0, change);
    std::array<double, 2> error{};
    for (std::size_t i = 0; i < error.size(); ++i) {
      WorldSpec spec = world_of(
          {round_body("first", ShapeForm::kSphere, kBall_m, 0.0, {-l1, 0.0, 3.0}, m1),
           round_body("second", ShapeForm::kSphere, kBall_m, 0.0, {-l1, 0.0, 3.0 - l2}, m2)});
      spec.joints = {hinge("a", "", "first", -Eigen::Vector3d::UnitY(), {0.0, 0.0, 3.0}),
                     hinge("b", "first", "second", -Eigen::Vector3d::UnitY(), {-l1, 0.0, 3.0})};
      spec.solver.timestep_s = i == 0 ? 0.004 : 0.0005;
      Running running(engine, spec);
      running.run(2.0);
      const Eigen::Vector3d upper = running.world.position(running.body("first"));
      const Eigen::Vector3d lower = running.world.position(running.body("second"));
      const Eigen::Vector3d at_upper(-l1 * std::sin(expected[0]), 0.0,
                                     3.0 - l1 * std::cos(expected[0]));
      const Eigen::Vector3d at_lower =
          at_upper + Eigen::Vector3d(-l2 * std::sin(expected[1]), 0.0, -l2 * std::cos(expected[1]));
      error[i] = (upper - at_upper).norm() + (lower - at_lower).norm();
    }
    CAPTURE(error[0]);
    CAPTURE(error[1]);
    CHECK(error[1] < 0.005);
    CHECK(error[1] < 0.5 * error[0]);
  }
}

WorldSpec door() {
  WorldSpec spec = world_of({box_body("door", {0.8, 0.04, 2.0}, {0.4, 0.0, 1.02}, 20.0)});
  spec.joints = {hinge("hinge", "", "door", Eigen::Vector3d::UnitZ(), {0.0, 0.0, 0.0})};
  return spec;
}

constexpr double kDoorInertia = 20.0 * (0.8 * 0.8 + 0.04 * 0.04) / 12.0 + 20.0 * 0.4 * 0.4;

TEST_CASE("a door turns the right way, stops at its limits and stays there") {
  for (const EngineKind engine : engines()) {
    CAPTURE(to_string(engine));
    WorldSpec spec = door();
    spec.joints.front().low_rad = -0.5;
    spec.joints.front().high_rad = 1.5;
    Running running(engine, spec);
    const HingeId id = *running.world.layout().find_hinge("hinge");
    running.world.set_hinge_motor(id, 1.0, 50.0);
    running.run(1.0);
    CHECK(running.angle("hinge") == doctest::Approx(1.0).epsilon(0.05));
    CHECK(running.world.position(running.body("door")).y() > 0.3);  // by the right hand
    running.run(2.0);
    CHECK(running.angle("hinge") == doctest::Approx(1.5).epsilon(0.01));
    running.world.set_hinge_motor(id, -1.0, 50.0);
    running.run(4.0);
    CHECK(running.angle("hinge") == doctest::Approx(-0.5).epsilon(0.01));
    CHECK(running.world.position(running.body("door")).z() == doctest::Approx(1.02).epsilon(1e-3));
  }
}

TEST_CASE("a hinge turns as often as its stops let it, and halts at each of them") {
  struct Stops {
    std::optional<double> low, high;
  };
  const double turn = 2.0 * std::numbers::pi;
  for (const EngineKind engine : engines()) {
    for (const auto& [low, high] : std::vector<Stops>{{-turn, turn},
                                                      {-0.5, 5.5},
                                                      {-0.5 * turn, 0.5 * turn},
                                                      {-8.0, 0.4},
                                                      {std::nullopt, 12.5},
                                                      {-4.0, std::nullopt}}) {
      CAPTURE(to_string(engine));
      CAPTURE(low.value_or(-99.0));
      CAPTURE(high.value_or(99.0));
      WorldSpec spec = door();
      spec.joints.front().low_rad = low;
      spec.joints.front().high_rad = high;
      Running running(engine, spec);
      const HingeId id = *running.world.layout().find_hinge("hinge");
      const double rate = 4.0, forth_s = 4.5;  // nearly three turns where nothing stops it
      const auto drive = [&](double rate_rad_s, const std::optional<double>& stop, double from,
                             double time_s) {
        running.world.set_hinge_motor(id, rate_rad_s, 500.0);
        running.run(time_s);
        const double angle = running.angle("hinge");
        if (stop) CHECK(angle == doctest::Approx(*stop).epsilon(0.01));
        if (!stop) CHECK(angle == doctest::Approx(from + rate_rad_s * time_s).epsilon(0.02));
        // The door itself turns: its middle lies at the hinge's angle.
        const Eigen::Vector3d at = running.world.position(running.body("door"));
        CHECK((at.head<2>() - 0.4 * Eigen::Vector2d(std::cos(angle), std::sin(angle))).norm() <
              1e-3);
        return angle;
      };
      // The way back is longer, so that it passes the beginning.
      drive(-rate, low, drive(rate, high, 0.0, forth_s), 2.0 * forth_s);
      // A start is at the default, however often it was turned before.
      REQUIRE_FALSE(running.world.reset(default_placements(running.world.layout()), 1).has_value());
      CHECK(std::abs(running.angle("hinge")) < 1e-9);
      drive(-rate, low, 0.0, forth_s);
    }
  }
}

TEST_CASE("dry friction at a stop holds and does not push") {
  for (const EngineKind engine : engines()) {
    CAPTURE(to_string(engine));
    for (const bool at_upper : {true, false}) {
      WorldSpec spec = door();
      spec.joints.front().low_rad = at_upper ? -1.0 : 0.0;
      spec.joints.front().high_rad = at_upper ? 0.0 : 1.0;
      spec.joints.front().max_torque_nm = 40.0;
      Running running(engine, spec);
      running.run(1.0);
      CHECK(std::abs(running.angle("hinge")) < 1e-4);
    }
  }
}

TEST_CASE("damping takes a door's speed by an exponential, dry friction in a straight line") {
  for (const EngineKind engine : engines()) {
    CAPTURE(to_string(engine));
    const double damping = 4.0, friction = 3.0, time_s = 0.6;
    for (const bool damped : {true, false}) {
      CAPTURE(damped);
      WorldSpec spec = door();
      if (damped) spec.joints.front().damping_nm_s = damping;
      Running running(engine, spec);
      const HingeId id = *running.world.layout().find_hinge("hinge");
      running.world.set_hinge_motor(id, 1.0, 1e4);
      running.run(0.3);
      const double before = running.rate("hinge");
      CHECK(before == doctest::Approx(1.0).epsilon(0.01));
      running.world.set_hinge_motor(id, 0.0, damped ? 0.0 : friction);
      running.run(time_s);
      const double expected = damped ? before * std::exp(-damping * time_s / kDoorInertia)
                                     : before - friction * time_s / kDoorInertia;
      CHECK(running.rate("hinge") == doctest::Approx(expected).epsilon(0.005));
    }
  }
}

TEST_CASE("a damper of any strength slows a slider and does not shake it") {
  for (const EngineKind engine : engines()) {
    CAPTURE(to_string(engine));
    const double mass_kg = 2.0;
    for (const double damping : {5.0, 1e6}) {
      WorldSpec spec = world_of({box_body("weight", {0.1, 0.1, 0.1}, {0.0, 0.0, 50.0}, mass_kg)});
      JointSpec rail;
      rail.name = "rail";
      rail.child = "weight";
      rail.axis_W = Eigen::Vector3d::UnitZ();
      rail.damping_n_s_m = damping;
      spec.joints = {rail};
      Running running(engine, spec);
      running.run(1.0);
      const double fall_s = mass_kg / damping, end = kGravity_m_s2 * fall_s;
      const double expected = -end * (1.0 - std::exp(-1.0 / fall_s));
      const SliderId id = *running.world.layout().find_slider("rail");
      CHECK(running.world.slider_rate_m_s(id) == doctest::Approx(expected).epsilon(0.01));
    }
  }
}

TEST_CASE("a sphere falls as far as free fall says") {
  for (const EngineKind engine : engines()) {
    CAPTURE(to_string(engine));
    WorldSpec spec =
        world_of({round_body("ball", ShapeForm::kSphere, 0.05, 0.0, {0.0, 0.0, 20.0}, 0.2)});
    spec.solver.timestep_s = 0.0005;
    Running running(engine, spec);
    running.run(1.5);
    CHECK(running.world.position(running.body("ball")).z() ==
          doctest::Approx(20.0 - 0.5 * kGravity_m_s2 * 1.5 * 1.5).epsilon(0.001));
  }
}

/// Distance that a body comes down a slope of 0.3 rad in a second from rest.
double way_down(EngineKind engine, ShapeForm form, double friction) {
  const double slope = 0.3, radius_m = 0.1;
  BodySpec ramp = box_body("ramp", {10.0, 4.0, 0.2}, {0.0, 0.0, 3.0});
  ramp.shapes.front().pitch_rad = slope;  // about y: down along +x
  const Eigen::Vector3d up(std::sin(slope), 0.0, std::cos(slope));
  const Eigen::Vector3d p = Eigen::Vector3d(0.0, 0.0, 3.0) + (0.1 + radius_m) * up;
  BodySpec thing = form == ShapeForm::kBox ? box_body("thing", {0.2, 0.2, 0.2}, p, 1.0)
                                           : round_body("thing", form, radius_m, 0.3, p, 1.0);
  if (form == ShapeForm::kBox) thing.shapes.front().pitch_rad = slope;
  if (form != ShapeForm::kBox) thing.shapes.front().roll_rad = 0.5 * std::numbers::pi;
  WorldSpec spec = world_of({ramp, thing});
  spec.friction.fallback = friction;
  spec.solver.timestep_s = 0.001;
  Running running(engine, spec);
  running.run(1.0);
  return (running.world.position(running.body("thing")) - p).norm();
}

TEST_CASE("what rolls or slides down a slope is as fast as its inertia and friction let it") {
  for (const EngineKind engine : engines()) {
    CAPTURE(to_string(engine));
    const double g_along = kGravity_m_s2 * std::sin(0.3), g_across = kGravity_m_s2 * std::cos(0.3);
    CHECK(way_down(engine, ShapeForm::kSphere, 0.8) ==
          doctest::Approx(0.5 * g_along * 5.0 / 7.0).epsilon(0.02));
    CHECK(way_down(engine, ShapeForm::kCylinder, 0.8) ==
          doctest::Approx(0.5 * g_along * 2.0 / 3.0).epsilon(0.02));
    CHECK(way_down(engine, ShapeForm::kBox, 0.1) ==
          doctest::Approx(0.5 * (g_along - 0.1 * g_across)).epsilon(0.02));
    CHECK(way_down(engine, ShapeForm::kBox, 0.5) < 0.005);
  }
}

/// How far a box of 0.1 m by 0.3 m leans after a second on a rough slope, on which it begins
/// standing [rad].
double lean_on_slope(EngineKind engine, double slope) {
  BodySpec ramp = box_body("ramp", {2.0, 2.0, 0.2}, {0.0, 0.0, 3.0});
  ramp.shapes.front().pitch_rad = slope;
  const Eigen::Vector3d up(std::sin(slope), 0.0, std::cos(slope));
  const Eigen::Vector3d p = Eigen::Vector3d(0.0, 0.0, 3.0) + (0.1 + 0.15) * up;
  BodySpec thing = box_body("thing", {0.1, 0.1, 0.3}, p, 1.0);
  thing.shapes.front().pitch_rad = slope;
  WorldSpec spec = world_of({ramp, thing});
  spec.friction.fallback = 1.0;
  spec.solver.timestep_s = 0.001;
  Running running(engine, spec);
  running.run(1.0);
  const Eigen::Matrix3d R =
      running.world.rotation(running.body("thing")) * shape_rotation(thing.shapes.front());
  return std::acos(std::clamp(R.col(2).dot(up), -1.0, 1.0));
}

TEST_CASE("a box on a slope tips where its weight passes its edge, and not before") {
  const double critical = std::atan(0.1 / 0.3);
  for (const EngineKind engine : engines()) {
    CAPTURE(to_string(engine));
    CHECK(lean_on_slope(engine, 0.95 * critical) < 0.01);
    CHECK(lean_on_slope(engine, 1.05 * critical) > 0.3);
  }
}

TEST_CASE("what stands or lies stays where it is for ten seconds") {
  for (const EngineKind engine : engines()) {
    CAPTURE(to_string(engine));
    BodySpec lying = round_body("capsule", ShapeForm::kCapsule, 0.05, 0.3, {1.0, 0.0, 0.05}, 0.4);
    lying.shapes.front().roll_rad = 0.5 * std::numbers::pi;
    WorldSpec spec = world_of(
        {round_body("ball", ShapeForm::kSphere, 0.1, 0.0, {0.0, 0.0, 0.1}, 1.0),
         round_body("can", ShapeForm::kCylinder, 0.1, 0.3, {0.0, 1.0, 0.15}, 1.0),
         round_body("upper", ShapeForm::kCylinder, 0.05, 0.1, {0.0, 1.0, 0.35}, 0.3), lying});
    Running running(engine, spec);
    running.run(10.0);
    for (const BodySpec& body : spec.bodies) {
      CAPTURE(body.name);
      CHECK((running.world.position(running.body(body.name.c_str())) - body.p_WB).norm() < 0.001);
    }
  }
}

TEST_CASE("bodies kept apart pass through each other, others do not") {
  for (const EngineKind engine : engines()) {
    CAPTURE(to_string(engine));
    for (const bool apart : {true, false}) {
      WorldSpec spec =
          world_of({box_body("shelf", {1.0, 1.0, 0.1}, {0.0, 0.0, 1.0}),
                    round_body("ball", ShapeForm::kSphere, 0.1, 0.0, {0.0, 0.0, 1.5}, 1.0)});
      if (apart) spec.bodies[0].apart = spec.bodies[1].apart = "model";
      Running running(engine, spec);
      running.run(2.0);
      const double expected = apart ? 0.1 : 1.15;
      CHECK(running.world.position(running.body("ball")).z() ==
            doctest::Approx(expected).epsilon(0.01));
    }
  }
}

TEST_CASE("bounds hold a leaning shape closely, and rays meet its surface") {
  for (const EngineKind engine : engines()) {
    CAPTURE(to_string(engine));
    BodySpec body = round_body("can", ShapeForm::kCylinder, 0.1, 1.0, {0.0, 0.0, 2.0}, 0.0);
    body.shapes.front().pitch_rad = 0.5 * std::numbers::pi;
    const auto owned = make_world(stepped_by(engine, world_of({body})));
    const PhysicsWorld& world = *owned;
    const BodyBounds bounds = world.bounds(*world.layout().find_body("can"));
    CHECK((bounds.high - Eigen::Vector3d(0.5, 0.1, 2.1)).norm() < 1e-9);
    const auto hit =
        world.ray_meets({0.0, -1.0, 2.0}, {0.0, 1.0, 2.0}, *world.layout().find_body("can"));
    REQUIRE(hit.has_value());
    CHECK(*hit == doctest::Approx(0.9));
    const Probe beside{
        {0.2, 0.2, 0.2}, {0.0, 0.19, 2.09}, Eigen::Matrix3d::Identity(), ShapeForm::kSphere};
    const BodyMask none(1, false);
    CHECK_FALSE(world.find_obstacle(beside, none, 0.0).has_value());  // boxes round both would meet
  }
}

TEST_CASE("a hinge repeats to the bit, in this world and in a fresh one") {
  for (const EngineKind engine : engines()) {
    CAPTURE(to_string(engine));
    const WorldSpec spec = pendulum(0.002);
    Running one(engine, spec), other(engine, spec);
    one.run(1.0);
    other.run(1.0);
    CHECK(one.world.digest() == other.world.digest());
    const auto first = one.world.digest();
    REQUIRE_FALSE(one.world.reset(default_placements(one.world.layout()), 1).has_value());
    one.run(1.0);
    CHECK(one.world.digest() == first);
  }
}

TEST_CASE("a hinge or an inertia that cannot be is refused by its key") {
  const auto first_of = [](const WorldSpec& spec) {
    const auto found = check_structure(spec);
    return found.empty() ? std::string() : found.front().path + " " + found.front().message;
  };
  WorldSpec spec = door();
  spec.joints.front().high_rad = 90.0;
  CHECK(first_of(spec).starts_with("joints/hinge/range_rad goes beyond 13 rad"));
  spec.joints.front().high_rad = -0.1;
  CHECK(first_of(spec).starts_with("joints/hinge/range_rad excludes 0"));
  spec = door();
  spec.joints.front().damping_nm_s = -1.0;
  CHECK(first_of(spec).starts_with("joints/hinge/damping_nm_s is negative"));
  spec = door();
  spec.joints.front().axis_W = Eigen::Vector3d::Zero();
  CHECK(first_of(spec).starts_with("joints/hinge/axis has no direction"));
  const auto with_moments = [&](const Eigen::Vector3d& moments) {
    spec = door();
    spec.bodies.front().inertia = InertiaSpec{{}, moments.asDiagonal()};
    return first_of(spec);
  };
  CHECK(with_moments({1.0, 1.0, 1.5}).empty());
  CHECK(with_moments({1.0, 1.0, 2.5}).starts_with("bodies/door/inertia is that of no body"));
  CHECK(with_moments({1.0, 1.0, -1.0}).starts_with("bodies/door/inertia has a moment"));
  CHECK(with_moments({1e30, 1e30, 1e30}).starts_with("bodies/door/inertia is that of a body of"));
  CHECK(with_moments({1.0, 1.0, std::nan("")}).starts_with("bodies/door/inertia is not a number"));
}

}  // namespace
}  // namespace parallax::harness
