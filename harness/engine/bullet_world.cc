#include "harness/engine/bullet_world.h"

#include <LinearMath/btScalar.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "harness/engine/bullet_engine.h"
#include "harness/engine/tree_start.h"
#include "harness/world/angles.h"

namespace parallax::harness {
namespace {

using Engine = BulletWorld::Engine;

double position_of(const Engine& engine, LinkId id, int axis = 0) {
  const BulletLink& link = engine.links[id.index()];
  return link.body->getJointPos(link.first_axis + axis);
}

double rate_of(const Engine& engine, LinkId id) {
  const BulletLink& link = engine.links[id.index()];
  return link.body->getJointVel(link.first_axis);
}

void drive(JointRow& row, double speed, double most) {
  row.spec.speed = speed;
  row.spec.most = most;
}

/// Bodies touch that are in each other, or press each other: what rests lies a hair above.
void note_touches(Engine& engine) {
  std::fill(engine.touches.begin(), engine.touches.end(), Touch{});
  for (const btPersistentManifold* manifold : engine.stage->contacts()) {
    for (int i = 0; i < manifold->getNumContacts(); ++i) {
      const btManifoldPoint& point = manifold->getContactPoint(i);
      if (point.getDistance() > 0.0 && point.getAppliedImpulse() <= 0.0) continue;
      const BulletContact at = shapes_at(*manifold, point);
      ContactRules::note(*at.first->side, *at.second->side, engine.touches);
    }
  }
}

}  // namespace

BulletWorld::BulletWorld(const EngineInput& input)
    : EngineWorld(std::make_unique<Engine>(input)), engine_(static_cast<Engine*>(&state())) {
  std::vector<Placement> placements;
  for (const BodySpec& body : engine_->layout.bodies) {
    placements.push_back({body.p_WB, body.yaw_rad});
  }
  place(placements, 0);
}

BulletWorld::~BulletWorld() = default;

EngineName BulletWorld::engine() const {
  return {"bullet", fmt::format("{}.{:02}", btGetVersion() / 100, btGetVersion() % 100)};
}

void BulletWorld::place(std::span<const Placement> placements, std::uint64_t /*seed*/) {
  engine_->stage.reset();
  engine_->stage = std::make_unique<BulletStage>(*engine_, placements);
}

bool BulletWorld::fold_state() {
  bool sane = true;
  const auto fold = [&](double value) {
    engine_->digest.fold(value);
    sane = sane && std::abs(value) < kLargestSane;  // false for NaN, too
  };
  for (const auto& body : engine_->stage->bodies()) {
    if (!body->hasFixedBase()) {
      const btVector3 p = body->getBasePos();
      const btQuaternion q = body->getWorldToBaseRot();
      for (const double value : {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()}) fold(value);
    }
    for (int i = 0; i < body->getNumLinks(); ++i) fold(body->getJointPos(i));
    for (int i = 0; i < 6 + body->getNumDofs(); ++i) fold(body->getVelocityVector()[i]);
  }
  return sane;
}

bool BulletWorld::step() {
  ++engine_->statistics.steps;
  LapTimer timer(engine_->measure_times);
  engine_->stage->find_contacts();
  for (const btPersistentManifold* manifold : engine_->stage->contacts()) {
    engine_->statistics.contacts += manifold->getNumContacts();
  }
  timer.add_lap_to(engine_->statistics.collide_s);
  engine_->stage->advance();
  note_touches(*engine_);
  timer.add_lap_to(engine_->statistics.solve_s);
  return fold_state();
}

double BulletWorld::slider_position_m(SliderId id) const {
  return position_of(*engine_, engine_->slider_links[id.index()]);
}

double BulletWorld::slider_rate_m_s(SliderId id) const {
  return rate_of(*engine_, engine_->slider_links[id.index()]);
}

void BulletWorld::set_motor(SliderId id, double velocity_m_s, double max_force_n) {
  drive(*engine_->sliders[id.index()].motor, velocity_m_s, max_force_n);
}

double BulletWorld::hinge_angle_rad(HingeId id) const {
  const double angle = position_of(*engine_, engine_->hinge_links[id.index()]);
  return counts_turns(engine_->layout.hinges[id]) ? angle : wrapped(angle);
}

double BulletWorld::hinge_rate_rad_s(HingeId id) const {
  return rate_of(*engine_, engine_->hinge_links[id.index()]);
}

void BulletWorld::set_hinge_motor(HingeId id, double rate_rad_s, double max_torque_nm) {
  drive(*engine_->hinges[id.index()].motor, rate_rad_s, max_torque_nm);
}

Eigen::Vector3d BulletWorld::gantry_position_m(GantryId id) const {
  return harness::gantry_position_m(*this, engine_->tree.links[engine_->gantry_links[id.index()]]);
}

double BulletWorld::gantry_yaw_rad(GantryId id) const {
  return wrapped(position_of(*engine_, engine_->gantry_links[id.index()], 3));
}

void BulletWorld::set_gantry(GantryId id, const Eigen::Vector3d& velocity_m_s,
                             double yaw_rate_rad_s) {
  constexpr double kAnyForce_n = 1e9;
  const JointSpec& spec = engine_->layout.gantries[id];
  const BulletMotors& rows = engine_->gantries[id.index()];
  drive(*rows.motor, velocity_m_s.x(), spec.max_force_n);
  drive(*rows.side, velocity_m_s.y(), spec.max_force_n);
  drive(*rows.turn, yaw_rate_rad_s, spec.max_torque_nm);
  if (spec.suspension) {
    // The spring stands on what the child is sent to.
    rows.height->spec.rest = position_of(*engine_, engine_->gantry_links[id.index()], 2) +
                             velocity_m_s.z() * engine_->solver.timestep_s;
  } else {
    drive(*rows.height, velocity_m_s.z(), spec.parent.empty() ? kAnyForce_n : spec.max_force_n);
  }
}

Eigen::Vector3d BulletWorld::link_position(LinkId id) const {
  return engine_->links[id.index()].p_WL;
}

Eigen::Matrix3d BulletWorld::link_rotation(LinkId id) const {
  return engine_->links[id.index()].R_WL;
}

}  // namespace parallax::harness

extern "C" __attribute__((visibility("default"))) parallax::harness::PhysicsWorld*
parallax_make_bullet_world(const char* version, const parallax::harness::EngineInput& input) {
  if (std::strcmp(version, PARALLAX_ENGINE_VERSION) != 0) return nullptr;
  return new parallax::harness::BulletWorld(input);
}
