#include "harness/engine/ode_world.h"

#include <ode/ode.h>

#include <Eigen/Geometry>
#include <bit>
#include <chrono>
#include <cmath>

#include "compiler/base/contract.h"
#include "compiler/base/hash.h"
#include "harness/engine/ode_engine.h"
#include "harness/engine/ode_process.h"

namespace parallax::harness {
namespace {

void mix(std::uint64_t& hash, double value) {
  hash = base::fnv1a64_word(hash, std::bit_cast<std::uint64_t>(value));
}

Eigen::Vector3d to_vector(const dReal* v) { return {v[0], v[1], v[2]}; }

Eigen::Matrix3d to_matrix(const dReal* R) {
  Eigen::Matrix3d out;
  out << R[0], R[1], R[2], R[4], R[5], R[6], R[8], R[9], R[10];
  return out;
}

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

/// No scene comes near this, in m, m/s or rad/s. Beyond it the state is on its way to infinity,
/// where the engine would abort the process on an assertion of its own.
constexpr double kLargestSane = 1e6;

/// Folds the state of all moving bodies into the digest; false if it is not sane.
bool fold_state(OdeWorld::Engine& engine) {
  bool sane = true;
  for (dxBody* const body : engine.links) {
    const dReal* p = dBodyGetPosition(body);
    const dReal* q = dBodyGetQuaternion(body);
    const dReal* v = dBodyGetLinearVel(body);
    const dReal* w = dBodyGetAngularVel(body);
    for (int i = 0; i < 3; ++i) {
      mix(engine.digest, p[i]);
      mix(engine.digest, v[i]);
      mix(engine.digest, w[i]);
      // False for NaN, too.
      sane = sane && std::abs(p[i]) + std::abs(v[i]) + std::abs(w[i]) < kLargestSane;
    }
    for (int i = 0; i < 4; ++i) mix(engine.digest, q[i]);
  }
  return sane;
}

class Stopwatch {
 public:
  explicit Stopwatch(bool on) : on_(on) {
    if (on_) start_ = Clock::now();
  }
  void add_lap_to(double& seconds) {
    if (!on_) return;
    const Clock::time_point now = Clock::now();
    seconds += std::chrono::duration<double>(now - start_).count();
    start_ = now;
  }

 private:
  using Clock = std::chrono::steady_clock;
  bool on_;
  Clock::time_point start_;
};

}  // namespace

OdeWorld::OdeWorld(const WorldSpec& spec) : engine_(std::make_unique<Engine>()) {
  enter_ode();
  OdeBuilder(spec, *engine_).build();
}

OdeWorld::~OdeWorld() {
  enter_ode();
  dJointGroupDestroy(engine_->contact_group);
  dSpaceDestroy(engine_->movable_space);
  dSpaceDestroy(engine_->static_space);
  dWorldDestroy(engine_->world);
  dThreadingFreeImplementation(engine_->threading);  // only after the world that uses it
}

const WorldLayout& OdeWorld::layout() const { return engine_->layout; }
double OdeWorld::timestep_s() const { return engine_->solver.timestep_s; }
std::uint64_t OdeWorld::digest() const { return engine_->digest; }
const StepStatistics& OdeWorld::statistics() const { return engine_->statistics; }
void OdeWorld::measure_times(bool on) { engine_->measure_times = on; }

std::optional<Overlap> OdeWorld::reset(std::span<const Placement> placements, std::uint64_t seed) {
  PARALLAX_REQUIRE(placements.size() == engine_->layout.bodies.size(), "one placement per body");
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
  for (std::size_t i = 0; i < engine_->sliders.size(); ++i) {
    const SliderId id = engine_->layout.sliders.id_at(i);
    set_motor(id, 0.0, engine_->layout.sliders[id].max_force_n);
  }
  for (std::size_t i = 0; i < engine_->gantries.size(); ++i) {
    set_gantry(engine_->layout.gantries.id_at(i), Eigen::Vector3d::Zero(), 0.0);
  }
  std::fill(engine_->touches.begin(), engine_->touches.end(), Touch{});
  seed_ode(seed);
  engine_->digest = base::kFnvStart;
  fold_state(*engine_);

  const std::optional<Overlap> overlap = find_deepest_overlap(*engine_);
  if (overlap && overlap->depth_m > engine_->solver.start_penetration_m) return overlap;
  return std::nullopt;
}

bool OdeWorld::step() {
  const MessageCounter counter(engine_->statistics.engine_messages);
  Stopwatch stopwatch(engine_->measure_times);
  make_contacts(*engine_);
  stopwatch.add_lap_to(engine_->statistics.collide_s);
  dWorldStep(engine_->world, engine_->solver.timestep_s);
  stopwatch.add_lap_to(engine_->statistics.solve_s);
  dJointGroupEmpty(engine_->contact_group);
  ++engine_->statistics.steps;
  return fold_state(*engine_);
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
  // The engine does not notice a changed joint, so sleeping bodies would stay asleep.
  for (int side = 0; side < 2; ++side) {
    dxBody* const body = dJointGetBody(joint, side);
    if (body != nullptr && dBodyIsEnabled(body) == 0) dBodyEnable(body);
  }
}

double OdeWorld::mass_kg(BodyId id) const {
  const std::optional<LinkId> link = engine_->layout.link_of[id.index()];
  return link ? engine_->masses_kg[link->index()] : 0.0;
}

Eigen::Vector3d OdeWorld::position(BodyId id) const {
  const BodyInLink& place = engine_->in_link[id.index()];
  const std::optional<LinkId> link = engine_->layout.link_of[id.index()];
  if (!link) return place.p_LB;
  dxBody* const body = engine_->links[link->index()];
  return to_vector(dBodyGetPosition(body)) + to_matrix(dBodyGetRotation(body)) * place.p_LB;
}

Eigen::Matrix3d OdeWorld::rotation(BodyId id) const {
  const BodyInLink& place = engine_->in_link[id.index()];
  const std::optional<LinkId> link = engine_->layout.link_of[id.index()];
  if (!link) return place.R_LB;
  return to_matrix(dBodyGetRotation(engine_->links[link->index()])) * place.R_LB;
}

Bounds OdeWorld::bounds(BodyId id, const BoxShape& shape) const {
  const Eigen::Matrix3d R_WB = rotation(id);
  const Eigen::Vector3d centre = position(id) + R_WB * shape.p_BS;
  const Eigen::Matrix3d R_WS = R_WB * Eigen::AngleAxisd(shape.yaw_rad, Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d half = 0.5 * (R_WS.cwiseAbs() * shape.size_m);
  return Bounds{centre - half, centre + half};
}

Bounds OdeWorld::bounds(BodyId id) const {
  const std::vector<BoxShape>& shapes = engine_->layout.bodies[id].shapes;
  Bounds all = bounds(id, shapes.front());
  for (const BoxShape& shape : shapes) {
    const Bounds one = bounds(id, shape);
    all.low = all.low.cwiseMin(one.low);
    all.high = all.high.cwiseMax(one.high);
  }
  return all;
}

const Touch& OdeWorld::touch(BodyId id) const { return engine_->touches[id.index()]; }

}  // namespace parallax::harness
