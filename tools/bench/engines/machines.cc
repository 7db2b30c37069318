#include "tools/bench/engines/machines.h"

#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <optional>
#include <utility>

#include "compiler/base/contract.h"
#include "harness/world/shapes.h"
#include "tools/bench/engines/grips.h"

namespace parallax::tools {
namespace {

using Eigen::Vector3d;
using harness::BodySpec;
using harness::EngineKind;
using harness::JointSpec;
using harness::ShapeForm;
using harness::WorldSpec;

constexpr double kGravity_m_s2 = 9.81;

BodySpec body_of(std::string name, ShapeForm form, const Vector3d& size_m, const Vector3d& p_WB,
                 double mass_kg) {
  BodySpec body;
  body.name = std::move(name);
  harness::BodyShape shape;
  shape.form = form;
  shape.size_m = size_m;
  body.shapes = {shape};
  body.p_WB = p_WB;
  body.mass_kg = mass_kg;
  return body;
}

JointSpec hinge_at(std::string name, std::string parent, std::string child, const Vector3d& axis,
                   const Vector3d& p_WA) {
  JointSpec joint;
  joint.name = std::move(name);
  joint.type = harness::JointType::kHinge;
  joint.parent = std::move(parent);
  joint.child = std::move(child);
  joint.axis_W = axis;
  joint.p_WA = p_WA;
  joint.max_torque_nm = 0.0;
  return joint;
}

/// A world at its start.
class Run {
 public:
  Run(WorldSpec spec, EngineKind engine, double timestep_s) {
    spec.engine = engine;
    spec.solver.timestep_s = timestep_s;
    world_ = harness::make_world(spec);
    std::vector<harness::Placement> start;
    for (const auto& body : world_->layout().bodies) start.push_back({body.p_WB, body.yaw_rad, 0});
    PARALLAX_REQUIRE(!world_->reset(start, 1), "bodies that do not overlap");
  }
  void go_on(double time_s) {
    const auto steps = std::lround(time_s / world_->timestep_s());
    for (long i = 0; i < steps; ++i) {
      PARALLAX_REQUIRE(world_->step(), "a world that stays sane");
    }
  }
  Vector3d place(const char* body) const {
    return world_->position(*world_->layout().find_body(body));
  }
  harness::PhysicsWorld& world() { return *world_; }
  harness::HingeId hinge(const char* name) const { return *world_->layout().find_hinge(name); }
  harness::SliderId slider(const char* name) const { return *world_->layout().find_slider(name); }

 private:
  std::unique_ptr<harness::PhysicsWorld> world_;
};

using Angles = std::array<double, 4>;  // two angles and their rates

/// The fourth-order Runge-Kutta method.
Angles solved(Angles state, double time_s, const std::function<Angles(const Angles&)>& change) {
  constexpr int kSteps = 20000;
  const double h = time_s / kSteps;
  const auto ahead = [](Angles at, const Angles& slope, double way) {
    for (std::size_t i = 0; i < at.size(); ++i) at[i] += way * slope[i];
    return at;
  };
  for (int step = 0; step < kSteps; ++step) {
    const Angles a = change(state), b = change(ahead(state, a, 0.5 * h)),
                 c = change(ahead(state, b, 0.5 * h)), d = change(ahead(state, c, h));
    for (std::size_t i = 0; i < state.size(); ++i) {
      state[i] += h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]);
    }
  }
  return state;
}

constexpr double kBall_m = 0.1;

double ball_inertia(double mass_kg) { return 0.4 * mass_kg * kBall_m * kBall_m; }

BodySpec ball(std::string name, const Vector3d& p_WB, double mass_kg) {
  return body_of(std::move(name), ShapeForm::kSphere, Vector3d::Constant(2.0 * kBall_m), p_WB,
                 mass_kg);
}

/// A ball beside a hinge, let go with its rod level.
double pendulum(EngineKind engine, double timestep_s) {
  constexpr double kRod_m = 0.8, kTime_s = 2.0;
  WorldSpec spec;
  spec.bodies = {ball("ball", {kRod_m, 0.0, 2.0}, 1.5)};
  spec.joints = {hinge_at("pivot", "", "ball", Vector3d::UnitY(), {0.0, 0.0, 2.0})};
  Run run(spec, engine, timestep_s);
  run.go_on(kTime_s);
  const double inertia_m2 = kRod_m * kRod_m + ball_inertia(1.0);
  const Angles end = solved({}, kTime_s, [&](const Angles& at) {
    return Angles{at[2], 0.0, kGravity_m_s2 * kRod_m * std::cos(at[0]) / inertia_m2, 0.0};
  });
  return std::abs(run.world().hinge_angle_rad(run.hinge("pivot")) - end[0]);
}

/// Two balls below each other, let go with the upper rod level.
double double_pendulum(EngineKind engine, double timestep_s) {
  constexpr double m1 = 1.0, m2 = 0.7, l1 = 0.6, l2 = 0.5, g = kGravity_m_s2, kTime_s = 2.0;
  WorldSpec spec;
  spec.bodies = {ball("first", {-l1, 0.0, 3.0}, m1), ball("second", {-l1, 0.0, 3.0 - l2}, m2)};
  spec.joints = {hinge_at("a", "", "first", -Vector3d::UnitY(), {0.0, 0.0, 3.0}),
                 hinge_at("b", "first", "second", -Vector3d::UnitY(), {-l1, 0.0, 3.0})};
  Run run(spec, engine, timestep_s);
  run.go_on(kTime_s);
  const double j1 = ball_inertia(m1), j2 = ball_inertia(m2);
  // Angles from straight down, as Lagrange has them.
  const Angles end =
      solved({0.5 * std::numbers::pi, 0.0, 0.0, 0.0}, kTime_s, [&](const Angles& at) {
        const double d = at[0] - at[1];
        const double a = (m1 + m2) * l1 * l1 + j1, b = m2 * l1 * l2 * std::cos(d),
                     c = m2 * l2 * l2 + j2;
        const double e =
            -m2 * l1 * l2 * std::sin(d) * at[3] * at[3] - (m1 + m2) * g * l1 * std::sin(at[0]);
        const double f = m2 * l1 * l2 * std::sin(d) * at[2] * at[2] - m2 * g * l2 * std::sin(at[1]);
        const double determinant = a * c - b * b;
        return Angles{at[2], at[3], (e * c - b * f) / determinant, (a * f - b * e) / determinant};
      });
  const Vector3d upper(-l1 * std::sin(end[0]), 0.0, 3.0 - l1 * std::cos(end[0]));
  const Vector3d lower = upper + Vector3d(-l2 * std::sin(end[1]), 0.0, -l2 * std::cos(end[1]));
  return (run.place("first") - upper).norm() + (run.place("second") - lower).norm();
}

/// A block on a slope of 0.3 rad, friction 0.1.
double sliding_block(EngineKind engine, double timestep_s) {
  constexpr double kSlope_rad = 0.3, kFriction = 0.1, kTime_s = 1.0;
  BodySpec ramp = body_of("ramp", ShapeForm::kBox, {10.0, 4.0, 0.2}, {0.0, 0.0, 3.0}, 0.0);
  ramp.shapes.front().pitch_rad = kSlope_rad;  // about y: down along +x
  const Vector3d up(std::sin(kSlope_rad), 0.0, std::cos(kSlope_rad));
  const Vector3d start = Vector3d(0.0, 0.0, 3.0) + 0.2 * up;
  BodySpec block = body_of("block", ShapeForm::kBox, Vector3d::Constant(0.2), start, 1.0);
  block.shapes.front().pitch_rad = kSlope_rad;
  WorldSpec spec;
  spec.bodies = {ramp, block};
  spec.friction.fallback = kFriction;
  Run run(spec, engine, timestep_s);
  run.go_on(kTime_s);
  const Vector3d along(std::cos(kSlope_rad), 0.0, -std::sin(kSlope_rad));
  const double pull = kGravity_m_s2 * (std::sin(kSlope_rad) - kFriction * std::cos(kSlope_rad));
  return std::abs((run.place("block") - start).dot(along) - 0.5 * pull * kTime_s * kTime_s);
}

/// A door that was brought to 1 rad/s and turns on against its damper: its rate.
double hinged_door(EngineKind engine, double timestep_s) {
  constexpr double kDamping_nm_s = 4.0, kTime_s = 0.6, kAnyTorque_nm = 1e4;
  WorldSpec spec;
  spec.bodies = {body_of("door", ShapeForm::kBox, {0.8, 0.04, 2.0}, {0.4, 0.0, 1.02}, 20.0)};
  spec.joints = {hinge_at("hinge", "", "door", Vector3d::UnitZ(), Vector3d::Zero())};
  spec.joints.front().damping_nm_s = kDamping_nm_s;
  Run run(spec, engine, timestep_s);
  const auto id = run.hinge("hinge");
  run.world().set_hinge_motor(id, 1.0, kAnyTorque_nm);
  run.go_on(0.3);
  const double before = run.world().hinge_rate_rad_s(id);
  run.world().set_hinge_motor(id, 0.0, 0.0);
  run.go_on(kTime_s);
  const double inertia = 20.0 * (0.8 * 0.8 + 0.04 * 0.04) / 12.0 + 20.0 * 0.4 * 0.4;
  return std::abs(run.world().hinge_rate_rad_s(id) -
                  before * std::exp(-kDamping_nm_s * kTime_s / inertia));
}

/// A sphere in the corner of a tray that is driven up at a slant and stops. Its flight is compared
/// with the parabola from its state when it first touches nothing.
double thrown_sphere(EngineKind engine, double timestep_s) {
  constexpr double kSpeed_m_s = 4.0, kTime_s = 0.6, kSide_m = 0.3;
  BodySpec tray = body_of("tray", ShapeForm::kBox, {kSide_m, kSide_m, 0.04}, {0.0, 0.0, 1.0}, 5.0);
  harness::BodyShape back;
  back.size_m = {0.04, kSide_m, kSide_m};
  back.p_BS = {-0.5 * kSide_m, 0.0, 0.5 * kSide_m};
  tray.shapes.push_back(back);
  WorldSpec spec;
  spec.bodies = {tray, ball("sphere", {-0.5 * kSide_m + 0.02 + kBall_m, 0.0, 1.02 + kBall_m}, 0.5)};
  JointSpec rail;
  rail.name = "rail";
  rail.child = "tray";
  rail.axis_W = {1.0, 0.0, 1.0};
  spec.joints = {rail};
  Run run(spec, engine, timestep_s);
  run.world().set_motor(run.slider("rail"), kSpeed_m_s, 200.0);
  run.go_on(0.5);
  run.world().set_motor(run.slider("rail"), 0.0, 1e5);
  run.go_on(0.1);
  const Vector3d before = run.place("sphere");
  run.go_on(timestep_s);
  const Vector3d p = run.place("sphere");
  run.go_on(timestep_s);
  const Vector3d v = (run.place("sphere") - before) / (2.0 * timestep_s);
  PARALLAX_REQUIRE(v.x() > 1.0 && v.z() > 0.5, "a sphere that flies");
  run.go_on(kTime_s - timestep_s);
  const Vector3d expected =
      p + kTime_s * v - 0.5 * kGravity_m_s2 * kTime_s * kTime_s * Vector3d::UnitZ();
  return (run.place("sphere") - expected).norm();
}

}  // namespace

const std::vector<Machine>& machines() {
  constexpr double kRounding = 1e-9;
  static const std::vector<Machine> kMachines = {
      {"a pendulum, 2 s", "its equation of motion", "rad", &pendulum, 0.003, kRounding},
      {"a double pendulum, 2 s", "Lagrange's equations", "m", &double_pendulum, 0.03, kRounding},
      {"a block that slides down 0.3 rad, 1 s", "Coulomb's law", "m", &sliding_block, 0.004,
       kRounding},
      {"a door against its damper, 0.6 s", "an exponential", "rad/s", &hinged_door, 0.001,
       kRounding},
      {"a sphere that is thrown, 0.6 s", "a parabola", "m", &thrown_sphere, 1e-9, kRounding},
      {"a load in pads that are shaken, 1 s", "Coulomb's law", "m", &shaken_load, 0.0005, 1e-4}};
  return kMachines;
}

}  // namespace parallax::tools
