#include "harness/engine/ode_world.h"

#include <ode/ode.h>
#include <ode/version.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdarg>
#include <mutex>

#include "harness/engine/ode_engine.h"
#include "harness/engine/ode_follow.h"
#include "harness/engine/ode_rest.h"
#include "harness/engine/ode_vector.h"
#include "harness/world/angles.h"
#include "harness/world/shapes.h"

namespace parallax::harness {
namespace {

/// They come from the solver of contact forces and are harmless when rare.
void count_message(int /*number*/, const char* /*text*/, va_list /*arguments*/) {
  MessageCounter::add_one();
}

struct ThreadData {
  ThreadData() { dAllocateODEDataForThread(static_cast<unsigned>(dAllocateMaskAll)); }
  ~ThreadData() { dCleanupODEAllDataForThread(); }
  ThreadData(const ThreadData&) = delete;
  ThreadData& operator=(const ThreadData&) = delete;
};

void place_at_rest(dxBody* body, const Eigen::Vector3d& p_WL, double yaw_rad, bool never_sleeps) {
  const dQuaternion q = {std::cos(0.5 * yaw_rad), 0.0, 0.0, std::sin(0.5 * yaw_rad)};
  dBodySetPosition(body, p_WL.x(), p_WL.y(), p_WL.z());
  dBodySetQuaternion(body, q);
  dBodySetLinearVel(body, 0.0, 0.0, 0.0);
  dBodySetAngularVel(body, 0.0, 0.0, 0.0);
  dBodySetForce(body, 0.0, 0.0, 0.0);
  dBodySetTorque(body, 0.0, 0.0, 0.0);
  dBodySetAutoDisableDefaults(body);  // restarts the idle timer, too
  if (never_sleeps) dBodySetAutoDisableFlag(body, 0);
  dBodyEnable(body);
}

/// The engine does not notice that a joint has changed, so sleeping bodies would stay asleep.
void wake(dxBody* body) {
  if (body != nullptr && dBodyIsEnabled(body) == 0) dBodyEnable(body);
}

/// Brings the engine up once per process and gives the calling thread its data. Cheap when done
/// already; called at the start of everything that touches the engine.
void enter_ode() {
  // A second initialisation would trip an assertion inside the engine; it is never closed, because
  // worlds of other threads may outlive any place where that could be done.
  static std::once_flag once;
  std::call_once(once, [] {
    dInitODE2(0);
    dSetMessageHandler(&count_message);
  });
  thread_local const ThreadData data;
}

}  // namespace

OdeWorld::OdeWorld(const WorldSpec& spec)
    : EngineWorld(std::make_unique<Engine>(spec)), engine_(static_cast<Engine*>(&state())) {
  enter_ode();
  OdeBuilder(*engine_).build();
}

OdeWorld::~OdeWorld() {
  enter_ode();
  dJointGroupDestroy(engine_->contact_group);
  dSpaceDestroy(engine_->movable_space);
  dSpaceDestroy(engine_->static_space);
  destroy_meshes(*engine_);
  dWorldDestroy(engine_->world);
  dThreadingFreeImplementation(engine_->threading);  // only after the world that uses it
}

EngineName OdeWorld::engine() const { return {"ode", dODE_VERSION}; }
void OdeWorld::enter_thread() const { enter_ode(); }

void OdeWorld::place(std::span<const Placement> placements, std::uint64_t seed) {
  enter_ode();
  dJointGroupEmpty(engine_->contact_group);
  // A space visits its geoms in the order in which they were last marked as moved. Once it is
  // clean, the loop below marks all of them in one order, whatever happened before.
  dSpaceClean(engine_->movable_space);
  std::size_t index = 0;
  for (const Link& link : engine_->layout.links) {
    const BodyId first = link.members.front();
    const Placement& placement = placements[first.index()];
    const Eigen::Vector3d p_BL = -engine_->in_link[first.index()].p_LB;  // same axes
    const double c = std::cos(placement.yaw_rad), s = std::sin(placement.yaw_rad);
    const Eigen::Vector3d p_BL_W(c * p_BL.x() - s * p_BL.y(), s * p_BL.x() + c * p_BL.y(),
                                 p_BL.z());
    place_at_rest(engine_->links[index], placement.p_WB + p_BL_W, placement.yaw_rad,
                  engine_->never_sleeps[index]);
    if (engine_->layout.is_free[first.index()]) {
      const double mass_kg = placement.mass_kg;
      const double specified_kg = engine_->layout.bodies[first].mass_kg;
      set_free_mass(*engine_, first, mass_kg > 0.0 ? mass_kg : specified_kg);
    }
    ++index;
  }
  engine_->resting->reset();
  for (TurnCount& turns : engine_->turn_counts) turns.whole = 0;
  move_far_stops(*engine_);
  engine_->followers->reset();
  dRandSetSeed(static_cast<unsigned long>(seed));  // one generator per process
}

bool OdeWorld::fold_state() {
  bool sane = true;
  for (dxBody* const body : engine_->links) {
    const dReal* p = dBodyGetPosition(body);
    const dReal* q = dBodyGetQuaternion(body);
    const dReal* v = dBodyGetLinearVel(body);
    const dReal* w = dBodyGetAngularVel(body);
    for (int i = 0; i < 3; ++i) {
      engine_->digest.fold(p[i]);
      engine_->digest.fold(v[i]);
      engine_->digest.fold(w[i]);
      // False for NaN, too.
      sane = sane && std::abs(p[i]) + std::abs(v[i]) + std::abs(w[i]) < kLargestSane;
    }
    for (int i = 0; i < 4; ++i) engine_->digest.fold(q[i]);
  }
  return sane;
}

std::optional<Overlap> OdeWorld::deepest_overlap() { return find_deepest_overlap(*engine_); }

bool OdeWorld::step() {
  std::int64_t complaints = 0;
  const MessageCounter counter(complaints);
  LapTimer timer(engine_->measure_times);
  find_contacts(*engine_);
  timer.add_lap_to(engine_->statistics.collide_s);
  engine_->resting->begin_step(engine_->touched);
  carry_out_orders(*this, *engine_);
  solve_step(*engine_, complaints);
  engine_->statistics.engine_messages += complaints;
  engine_->resting->end_step();
  count_turns(*engine_);
  engine_->statistics.joints_at_rest = engine_->resting->resting();
  timer.add_lap_to(engine_->statistics.solve_s);
  dJointGroupEmpty(engine_->contact_group);
  ++engine_->statistics.steps;
  return fold_state();
}

double OdeWorld::slider_position_m(SliderId id) const {
  return dJointGetSliderPosition(engine_->sliders[id.index()]);
}

double OdeWorld::slider_rate_m_s(SliderId id) const {
  return dJointGetSliderPositionRate(engine_->sliders[id.index()]);
}

void OdeWorld::set_motor(SliderId id, double velocity_m_s, double max_force_n) {
  dxJoint* const joint = engine_->sliders[id.index()];
  dJointSetSliderParam(joint, dParamVel, velocity_m_s);
  dJointSetSliderParam(joint, dParamFMax, max_force_n);
  engine_->resting->tell(id, {{velocity_m_s, 0.0, 0.0, 0.0}, max_force_n});
  if (engine_->resting->manages(id)) return;  // awake, or at rest
  for (int side = 0; side < 2; ++side) wake(dJointGetBody(joint, side));
}

double OdeWorld::hinge_angle_rad(HingeId id) const {
  const double angle = dJointGetHingeAngle(engine_->hinges[id.index()]);
  return counts_turns(engine_->layout.hinges[id]) ? angle + whole_turns_rad(*engine_, id) : angle;
}

double OdeWorld::hinge_rate_rad_s(HingeId id) const {
  return dJointGetHingeAngleRate(engine_->hinges[id.index()]);
}

void OdeWorld::set_hinge_motor(HingeId id, double rate_rad_s, double max_torque_nm) {
  dxJoint* const joint = engine_->turners[id.index()];
  dJointSetAMotorParam(joint, dParamVel, rate_rad_s);
  dJointSetAMotorParam(joint, dParamFMax, max_torque_nm);
  engine_->resting->tell(id, {{rate_rad_s, 0.0, 0.0, 0.0}, max_torque_nm});
  if (engine_->resting->manages(id)) return;
  for (int side = 0; side < 2; ++side) wake(dJointGetBody(joint, side));
}

Eigen::Vector3d OdeWorld::gantry_position_m(GantryId id) const {
  const Gantry& gantry = engine_->gantries[id.index()];
  Eigen::Vector3d p = position(gantry.child_id);
  if (gantry.parent != nullptr) {
    p = rotation(gantry.parent_id).transpose() * (p - position(gantry.parent_id));
  }
  return p - gantry.start_P;
}

double OdeWorld::gantry_yaw_rad(GantryId id) const {
  const Gantry& gantry = engine_->gantries[id.index()];
  const Eigen::Matrix3d R_PC =
      parent_rotation(*this, gantry).transpose() * rotation(gantry.child_id);
  return wrapped(heading_rad(R_PC) - gantry.start_yaw_rad);
}

void OdeWorld::set_gantry(GantryId id, const Eigen::Vector3d& velocity_m_s, double yaw_rate_rad_s) {
  engine_->gantry_orders[id.index()] = {velocity_m_s, yaw_rate_rad_s, true};
  const Eigen::Vector3d& v = velocity_m_s;
  if (engine_->resting->tell(id, {{v.x(), v.y(), v.z(), yaw_rate_rad_s}, 0.0})) return;
  wake(engine_->gantries[id.index()].child);
  wake(engine_->gantries[id.index()].parent);
}

Eigen::Vector3d OdeWorld::link_position(LinkId id) const {
  return to_vector(dBodyGetPosition(engine_->links[id.index()]));
}

Eigen::Matrix3d OdeWorld::link_rotation(LinkId id) const {
  return to_matrix(dBodyGetRotation(engine_->links[id.index()]));
}

}  // namespace parallax::harness
