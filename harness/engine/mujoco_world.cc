#include "harness/engine/mujoco_world.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <mutex>

#include "compiler/base/contract.h"
#include "harness/engine/mujoco_engine.h"
#include "harness/engine/mujoco_errors.h"
#include "harness/engine/tree_start.h"
#include "harness/world/angles.h"

namespace parallax::harness {
namespace {

using Engine = MujocoWorld::Engine;

/// By itself the engine would write to a file in the current folder.
void count_warning(const char* /*text*/) { MessageCounter::add_one(); }

void set_hooks() {
  static std::once_flag once;
  std::call_once(once, [] {
    mju_user_error = &leave_engine;  // by itself the engine would end the process
    mju_user_warning = &count_warning;
    replace_collisions();
  });
}

void set_joint(Engine& engine, LinkId id, std::span<const Placement> placements) {
  const TreeLink& link = engine.tree.links[id];
  const LinkStart start = start_of(engine.layout, engine.tree, id, placements);
  mjtNum* const q = engine.data->qpos + engine.joints[id.index()].q;
  switch (link.joint) {
    case LinkJoint::kFree:
      std::copy_n(start.p_WL.data(), 3, q);
      q[3] = std::cos(0.5 * start.yaw_rad);
      q[4] = q[5] = 0.0;
      q[6] = std::sin(0.5 * start.yaw_rad);
      return;
    case LinkJoint::kGantry:
      std::copy_n(start.shift_P.data(), 3, q);
      q[3] = start.turn_rad;
      return;
    case LinkJoint::kSlider:
      q[0] = start.slide_m;
      return;
    case LinkJoint::kHinge:
      return;
  }
}

/// Every mass from what is specified, so that no rounding of earlier resets is left.
void set_masses(Engine& engine, std::span<const Placement> placements) {
  mjModel& model = *engine.model;
  bool changed = false;
  for (std::size_t i = 0; i < engine.tree.links.size(); ++i) {
    const TreeLink& link = engine.tree.links[engine.tree.links.id_at(i)];
    if (!engine.layout.is_free[link.frame.index()]) continue;
    const double wanted_kg = placements[link.frame.index()].mass_kg;
    const double mass_kg = wanted_kg > 0.0 ? wanted_kg : link.mass_kg;
    if (mass_kg == engine.masses_kg[i]) continue;
    const int body = engine.bodies[i];
    const double share = mass_kg / link.mass_kg;
    model.body_mass[body] = mass_kg;
    Eigen::Map<Eigen::Vector3d>(model.body_inertia + 3 * body) = share * engine.moments_kg_m2[i];
    engine.masses_kg[i] = mass_kg;
    changed = true;
  }
  if (changed) ask_engine([&] { mj_setConst(&model, engine.data.get()); });
}

/// Bodies that do not fall are carried by a force at their centre.
void carry_weightless(Engine& engine) {
  for (std::size_t i = 0; i < engine.tree.links.size(); ++i) {
    if (engine.tree.links[engine.tree.links.id_at(i)].gravity) continue;
    engine.data->xfrc_applied[6 * engine.bodies[i] + 2] =
        -engine.masses_kg[i] * engine.solver.gravity_m_s2;
  }
}

/// Where everything is, from the joints.
void update_places(Engine& engine) {
  ask_engine([&] {
    mj_kinematics(engine.model.get(), engine.data.get());
    mj_comPos(engine.model.get(), engine.data.get());
  });
}

/// A motor is the engine's dry friction against a rail that moves: what it takes is bounded, and it
/// brings the joint to the speed of the rail.
void aim_motors(Engine& engine) {
  mjData& data = *engine.data;
  constexpr int kNumbersOfRow = 4, kDamping = 1;
  for (int row = data.ne; row < data.ne + data.nf; ++row) {
    if (data.efc_type[row] != mjCNSTR_FRICTION_DOF) continue;
    const double target = engine.targets[static_cast<std::size_t>(data.efc_id[row])];
    data.efc_aref[row] += data.efc_KBIP[kNumbersOfRow * row + kDamping] * target;
  }
}

/// The stages of mj_step, with a look between them.
void step_once(Engine& engine) {
  const mjModel* const model = engine.model.get();
  mjData* const data = engine.data.get();
  LapTimer timer(engine.measure_times);
  find_contacts(engine);
  note_touches(engine);
  engine.statistics.contacts += data->ncon;
  timer.add_lap_to(engine.statistics.collide_s);
  ask_engine([&] {
    mj_crb(model, data);
    mj_factorM(model, data);
    mj_makeConstraint(model, data);
    mj_transmission(model, data);
    mj_projectConstraint(model, data);
    mj_fwdVelocity(model, data);
    aim_motors(engine);
    mj_fwdActuation(model, data);
    mj_fwdAcceleration(model, data);
  });
  solve_friction(engine);
  ask_engine([&] { mj_Euler(model, data); });
  update_places(engine);
  timer.add_lap_to(engine.statistics.solve_s);
}

/// Contacts or constraints that found no room would be missing.
bool has_overflowed(const mjData& data) {
  return data.warning[mjWARN_CONTACTFULL].number + data.warning[mjWARN_CNSTRFULL].number > 0;
}

void drive(Engine& engine, int dof, double velocity, double most) {
  engine.model->dof_frictionloss[dof] = most;
  engine.targets[static_cast<std::size_t>(dof)] = velocity;
}

}  // namespace

void ModelDeleter::operator()(mjModel* model) const { mj_deleteModel(model); }
void DataDeleter::operator()(mjData* data) const { mj_deleteData(data); }

MujocoWorld::MujocoWorld(const EngineInput& input)
    : EngineWorld(std::make_unique<Engine>(input)), engine_(static_cast<Engine*>(&state())) {
  set_hooks();
  build_engine(*engine_, input);
  update_places(*engine_);
}

MujocoWorld::~MujocoWorld() = default;

EngineName MujocoWorld::engine() const { return {"mujoco", mj_versionString()}; }
void MujocoWorld::enter_thread() const {}

void MujocoWorld::place(std::span<const Placement> placements, std::uint64_t /*seed*/) {
  const MessageCounter counter(engine_->statistics.engine_messages);
  engine_->is_broken = false;
  set_masses(*engine_, placements);
  mj_resetData(engine_->model.get(), engine_->data.get());
  for (const LinkId id : engine_->tree.order) set_joint(*engine_, id, placements);
  carry_weightless(*engine_);
  update_places(*engine_);
}

bool MujocoWorld::fold_state() {
  const mjModel& model = *engine_->model;
  const mjData& data = *engine_->data;
  bool sane = true;
  const auto fold = [&](const mjtNum* values, int count) {
    for (int i = 0; i < count; ++i) {
      engine_->digest.fold(values[i]);
      sane = sane && std::abs(values[i]) < kLargestSane;  // false for NaN, too
    }
  };
  fold(data.qpos, model.nq);
  fold(data.qvel, model.nv);
  return sane;
}

std::optional<Overlap> MujocoWorld::deepest_overlap() {
  const MessageCounter counter(engine_->statistics.engine_messages);
  find_contacts(*engine_);
  return deepest_contact(*engine_);
}

bool MujocoWorld::step() {
  if (engine_->is_broken) return false;
  const MessageCounter counter(engine_->statistics.engine_messages);
  ++engine_->statistics.steps;
  try {
    step_once(*engine_);
  } catch (const EngineFault&) {
    ++engine_->statistics.engine_messages;
    engine_->is_broken = true;
    return false;
  }
  return fold_state() && !has_overflowed(*engine_->data);
}

double MujocoWorld::slider_position_m(SliderId id) const {
  return engine_->data->qpos[engine_->joints[engine_->sliders[id.index()].index()].q];
}

double MujocoWorld::slider_rate_m_s(SliderId id) const {
  return engine_->data->qvel[engine_->joints[engine_->sliders[id.index()].index()].v];
}

void MujocoWorld::set_motor(SliderId id, double velocity_m_s, double max_force_n) {
  drive(*engine_, engine_->joints[engine_->sliders[id.index()].index()].v, velocity_m_s,
        max_force_n);
}

double MujocoWorld::hinge_angle_rad(HingeId id) const {
  const double angle = engine_->data->qpos[engine_->joints[engine_->hinges[id.index()].index()].q];
  return counts_turns(engine_->layout.hinges[id]) ? angle : wrapped(angle);
}

double MujocoWorld::hinge_rate_rad_s(HingeId id) const {
  return engine_->data->qvel[engine_->joints[engine_->hinges[id.index()].index()].v];
}

void MujocoWorld::set_hinge_motor(HingeId id, double rate_rad_s, double max_torque_nm) {
  drive(*engine_, engine_->joints[engine_->hinges[id.index()].index()].v, rate_rad_s,
        max_torque_nm);
}

Eigen::Vector3d MujocoWorld::gantry_position_m(GantryId id) const {
  return harness::gantry_position_m(*this, engine_->tree.links[engine_->gantries[id.index()]]);
}

double MujocoWorld::gantry_yaw_rad(GantryId id) const {
  return wrapped(engine_->data->qpos[engine_->joints[engine_->gantries[id.index()].index()].q + 3]);
}

void MujocoWorld::set_gantry(GantryId id, const Eigen::Vector3d& velocity_m_s,
                             double yaw_rate_rad_s) {
  constexpr double kAnyForce_n = 1e9;
  const JointSpec& spec = engine_->layout.gantries[id];
  const auto [q, dof] = engine_->joints[engine_->gantries[id.index()].index()];
  drive(*engine_, dof, velocity_m_s.x(), spec.max_force_n);
  drive(*engine_, dof + 1, velocity_m_s.y(), spec.max_force_n);
  if (spec.suspension) {
    // The spring stands on what the child is sent to.
    engine_->model->qpos_spring[q + 2] = engine_->data->qpos[q + 2] +
                                         velocity_m_s.z() * engine_->solver.timestep_s +
                                         engine_->preloads_m[id.index()];
  } else {
    drive(*engine_, dof + 2, velocity_m_s.z(),
          spec.parent.empty() ? kAnyForce_n : spec.max_force_n);
  }
  drive(*engine_, dof + 3, yaw_rate_rad_s, spec.max_torque_nm);
}

Eigen::Vector3d MujocoWorld::link_position(LinkId id) const {
  return Eigen::Map<const Eigen::Vector3d>(engine_->data->xpos + 3 * engine_->bodies[id.index()]);
}

Eigen::Matrix3d MujocoWorld::link_rotation(LinkId id) const {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(
      engine_->data->xmat + 9 * engine_->bodies[id.index()]);
}

}  // namespace parallax::harness

extern "C" __attribute__((visibility("default"))) parallax::harness::PhysicsWorld*
parallax_make_mujoco_world(const char* version, const parallax::harness::EngineInput& input) {
  if (std::strcmp(version, PARALLAX_ENGINE_VERSION) != 0) return nullptr;
  return new parallax::harness::MujocoWorld(input);
}
