// Joints that follow others against mechanics in closed form: a coupling has no work of its own, so
// that a leader of mass m and a follower of mass M with the ratio r move as a mass m + r^2 M does.

#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include "harness/engine/physics_world.h"
#include "harness/engine/world_check.h"
#include "tests/harness/engine/engines.h"
#include "tests/harness/world/hand_made.h"

namespace parallax::harness {
namespace {

constexpr double kFall_m_s2 = 9.81;

JointSpec rail(std::string name, std::string child, const Eigen::Vector3d& axis,
               std::string parent = {}) {
  JointSpec joint;
  joint.name = std::move(name);
  joint.parent = std::move(parent);
  joint.child = std::move(child);
  joint.axis_W = axis;
  return joint;
}

JointSpec led(JointSpec joint, std::string leader, double ratio) {
  joint.follows = FollowSpec{std::move(leader), ratio};
  return joint;
}

/// Parts far from each other and from the floor.
BodySpec part(std::string name, double x_m, double mass_kg) {
  return box_body(std::move(name), Eigen::Vector3d::Constant(0.1), {x_m, 0.0, 100.0}, mass_kg);
}

struct Machine {
  Machine(EngineKind engine, const WorldSpec& spec)
      : owned(make_world(stepped_by(engine, spec))), world(*owned) {
    const auto found = check_world(stepped_by(engine, spec));
    REQUIRE_MESSAGE(found.empty(), (found.empty() ? "" : found.front().path));
    reset();
  }
  void reset() { REQUIRE_FALSE(world.reset(default_placements(world.layout()), 1).has_value()); }
  void run(double time_s) {
    const auto steps = std::lround(time_s / world.timestep_s());
    for (long i = 0; i < steps; ++i) REQUIRE(world.step());
  }
  double at(const char* name) const {
    if (const auto slider = world.layout().find_slider(name)) {
      return world.slider_position_m(*slider);
    }
    return world.hinge_angle_rad(*world.layout().find_hinge(name));
  }
  SliderId slider(const char* name) const { return *world.layout().find_slider(name); }
  std::unique_ptr<PhysicsWorld> owned;
  PhysicsWorld& world;
};

/// A weight that falls along a rail and leads another one, which slides level.
WorldSpec weights(double leader_kg, double follower_kg, double ratio) {
  WorldSpec spec = world_of({part("weight", 0.0, leader_kg), part("load", 20.0, follower_kg)});
  spec.joints = {rail("fall", "weight", -Eigen::Vector3d::UnitZ()),
                 led(rail("slide", "load", Eigen::Vector3d::UnitY()), "fall", ratio)};
  return spec;
}

TEST_CASE("a leader bears the inertia of its follower, times the square of the ratio") {
  for (const EngineKind engine : engines()) {
    for (const auto& [leader_kg, follower_kg, ratio] :
         {std::array{2.0, 3.0, -1.5}, std::array{2.0, 3.0, 1.0}, std::array{1.0, 0.01, 0.2},
          std::array{0.05, 4.0, 3.0}}) {
      CAPTURE(to_string(engine));
      CAPTURE(ratio);
      Machine machine(engine, weights(leader_kg, follower_kg, ratio));
      const double time_s = 0.8;
      for (int part = 0; part < 4; ++part) {
        machine.run(time_s / 4.0);
        CHECK(std::abs(machine.at("slide") - ratio * machine.at("fall")) < 1e-4);
      }
      const double a = kFall_m_s2 * leader_kg / (leader_kg + ratio * ratio * follower_kg);
      CHECK(machine.at("fall") == doctest::Approx(0.5 * a * time_s * time_s).epsilon(0.01));
    }
  }
}

TEST_CASE(
    "a weight that follows is held by what holds its leader, and pulls that where it is more") {
  for (const EngineKind engine : engines()) {
    CAPTURE(to_string(engine));
    const double ratio = 2.0, weight_kg = 1.5;
    WorldSpec spec = world_of({part("handle", 0.0, 1.0), part("weight", 20.0, weight_kg)});
    spec.joints = {rail("pull", "handle", Eigen::Vector3d::UnitX()),
                   led(rail("hang", "weight", -Eigen::Vector3d::UnitZ()), "pull", ratio)};
    Machine machine(engine, spec);
    const double needed_n = ratio * weight_kg * kFall_m_s2;
    machine.world.set_motor(machine.slider("pull"), 0.0, 1.05 * needed_n);
    machine.run(2.0);
    // An engine's motor gives way a little: a ten-thousandth of the way that the weight would fall.
    const double free_m = ratio * 0.5 * needed_n / (1.0 + ratio * ratio * weight_kg) * 4.0;
    CHECK(std::abs(machine.at("hang")) < 1e-4 * free_m);
    machine.reset();
    machine.world.set_motor(machine.slider("pull"), 0.0, 0.8 * needed_n);
    machine.run(1.0);
    // The motor bears 80 % of the weight; the rest accelerates both bodies.
    const double a = 0.2 * needed_n / (1.0 + ratio * ratio * weight_kg);
    CHECK(machine.at("pull") == doctest::Approx(0.5 * a).epsilon(0.01));
    // A motor moves the leader as it moves any joint, and the follower twice as far.
    machine.reset();
    machine.world.set_motor(machine.slider("pull"), -0.5, 1e4);
    machine.run(1.0);
    CHECK(machine.at("hang") == doctest::Approx(-1.0).epsilon(0.01));
  }
}

TEST_CASE("a stop of the leader stops both, and one of the follower too") {
  for (const EngineKind engine : engines()) {
    for (const bool of_leader : {true, false}) {
      CAPTURE(to_string(engine));
      CAPTURE(of_leader);
      WorldSpec spec = weights(2.0, 1.0, -3.0);
      if (of_leader) {
        spec.joints.front().high_m = 0.2;
      } else {
        spec.joints.back().low_m = -0.6;
      }
      Machine machine(engine, spec);
      machine.run(3.0);
      CHECK(machine.at("fall") == doctest::Approx(0.2).epsilon(0.01));
      CHECK(machine.at("slide") == doctest::Approx(-0.6).epsilon(0.01));
    }
  }
}

TEST_CASE("a winch winds up a weight turn by turn") {
  for (const EngineKind engine : engines()) {
    CAPTURE(to_string(engine));
    const double radius_m = 0.05, mass_kg = 3.0, moment = 0.02;
    BodySpec drum = part("drum", 0.0, 5.0);
    drum.inertia = InertiaSpec{Eigen::Vector3d::Zero(), moment * Eigen::Matrix3d::Identity()};
    WorldSpec spec = world_of({drum, part("weight", 20.0, mass_kg)});
    JointSpec axle = rail("axle", "drum", Eigen::Vector3d::UnitX());
    axle.type = JointType::kHinge;
    axle.p_WA = {0.0, 0.0, 100.0};
    axle.max_torque_nm = 0.0;
    spec.joints = {axle, led(rail("rope", "weight", -Eigen::Vector3d::UnitZ()), "axle", radius_m)};
    Machine machine(engine, spec);
    const double time_s = 2.0;
    machine.run(time_s);
    const double a =
        mass_kg * kFall_m_s2 * radius_m * radius_m / (moment + mass_kg * radius_m * radius_m);
    const double way_m = 0.5 * a * time_s * time_s;
    CHECK(way_m / radius_m > 4.0 * 3.1416);  // more than two turns
    CHECK(machine.at("rope") == doctest::Approx(way_m).epsilon(0.01));
  }
}

TEST_CASE("fingers that close against each other leave their hand where it is") {
  for (const EngineKind engine : engines()) {
    CAPTURE(to_string(engine));
    WorldSpec spec =
        world_of({part("hand", 0.0, 1.0), part("left", 20.0, 0.3), part("right", 40.0, 0.3)});
    spec.joints = {rail("track", "hand", Eigen::Vector3d::UnitY()),
                   rail("one", "left", Eigen::Vector3d::UnitY(), "hand"),
                   led(rail("other", "right", -Eigen::Vector3d::UnitY(), "hand"), "one", 1.0)};
    Machine machine(engine, spec);
    machine.world.set_motor(machine.slider("one"), 0.1, 20.0);
    machine.run(1.0);
    CHECK(machine.at("one") == doctest::Approx(0.1).epsilon(0.02));
    CHECK(machine.at("other") == doctest::Approx(machine.at("one")).epsilon(1e-3));
    CHECK(std::abs(machine.at("track")) < 1e-4);
  }
}

TEST_CASE("one joint leads several, and runs of one start are equal to the bit") {
  for (const EngineKind engine : engines()) {
    CAPTURE(to_string(engine));
    WorldSpec spec = world_of({part("weight", 0.0, 1.0), part("a", 20.0, 0.5), part("b", 40.0, 2.0),
                               part("c", 60.0, 0.1)});
    spec.joints = {rail("fall", "weight", -Eigen::Vector3d::UnitZ()),
                   led(rail("p", "a", Eigen::Vector3d::UnitX()), "fall", 1.0),
                   led(rail("q", "b", Eigen::Vector3d::UnitY()), "fall", -0.5),
                   led(rail("r", "c", Eigen::Vector3d::UnitZ()), "fall", 2.0)};
    Machine machine(engine, spec);
    machine.run(0.5);
    // The last one rises against its own weight.
    const double a = kFall_m_s2 * (1.0 - 2.0 * 0.1) / (1.0 + 0.5 + 0.25 * 2.0 + 4.0 * 0.1);
    const double way_m = 0.5 * a * 0.25;
    CHECK(machine.at("p") == doctest::Approx(way_m).epsilon(0.01));
    CHECK(machine.at("q") == doctest::Approx(-0.5 * way_m).epsilon(0.01));
    CHECK(machine.at("r") == doctest::Approx(2.0 * way_m).epsilon(0.01));
    const auto digest = machine.world.digest();
    machine.reset();
    machine.run(0.5);
    CHECK(machine.world.digest() == digest);
  }
}

TEST_CASE("a joint that cannot be followed is refused by its key") {
  const auto first_of = [](const FollowSpec& follows) {
    WorldSpec spec = weights(1.0, 1.0, 1.0);
    spec.joints.back().follows = follows;
    const auto found = check_structure(spec);
    return found.empty() ? std::string() : found.front().path + " " + found.front().message;
  };
  CHECK(first_of({"fall", -2.0}).empty());
  CHECK(first_of({"rise", 1.0}) == "joints/slide/follows/joint no joint `rise`");
  CHECK(first_of({"slide", 1.0}).ends_with("`slide` follows another joint itself"));
  CHECK(first_of({"fall", 0.0}).starts_with("joints/slide/follows/ratio is 0"));
  CHECK(first_of({"fall", std::nan("")}).starts_with("joints/slide/follows/ratio is nan"));
}

}  // namespace
}  // namespace parallax::harness
