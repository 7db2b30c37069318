#include <ode/ode.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "harness/engine/ode_engine.h"
#include "harness/engine/ode_follow.h"
#include "harness/engine/ode_rest.h"

// The pivoting solver of ODE gives up where contacts are redundant and rounding decides which of
// them press: corners of the walls of a ring that lie on one another, or the many corners of a hull
// on a pad. It then reports "LCP internal error" and sets every force that it has not found yet to
// zero. Friction comes last, so a load is let go for a step, however hard it is gripped; with some
// tens of such steps it slips out of the hand. More compliance (CFM) makes the matrix of the
// problem better conditioned. So the step is taken back and solved again with softer contacts, ten
// times as soft in each attempt. Only steps that fail cost more.

namespace parallax::harness {
namespace {

constexpr int kMostAttempts = 5;
constexpr double kSofter = 10.0;  // of each attempt against the one before

/// Position and velocity of all bodies that are solved.
class Before {
 public:
  explicit Before(const OdeWorld::Engine& engine) {
    const auto add = [&](dxBody* body) {
      if (body == nullptr) return;
      State& state = states_.emplace_back();
      state.body = body;
      state.enabled = dBodyIsEnabled(body) != 0;
      std::copy_n(dBodyGetPosition(body), 3, state.p);
      std::copy_n(dBodyGetQuaternion(body), 4, state.q);
      std::copy_n(dBodyGetLinearVel(body), 3, state.v);
      std::copy_n(dBodyGetAngularVel(body), 3, state.w);
    };
    // Links that rest on one another have one host; it is kept as often.
    for (std::uint32_t link = 0; link < engine.links.size(); ++link) {
      add(engine.resting->host(link));
    }
  }

  void restore() const {
    for (const State& state : states_) {
      // A body that is asleep has not moved.
      if (!state.enabled || dBodyIsEnabled(state.body) == 0) continue;
      dBodySetPosition(state.body, state.p[0], state.p[1], state.p[2]);
      dBodySetQuaternion(state.body, state.q);
      dBodySetLinearVel(state.body, state.v[0], state.v[1], state.v[2]);
      dBodySetAngularVel(state.body, state.w[0], state.w[1], state.w[2]);
    }
  }

 private:
  struct State {
    dxBody* body = nullptr;
    bool enabled = false;
    dReal p[3] = {}, v[3] = {}, w[3] = {};
    dQuaternion q = {};
  };
  std::vector<State> states_;
};

}  // namespace

void solve_step(OdeWorld::Engine& engine, std::int64_t& complaints) {
  const Before before(engine);
  engine.followers->begin_step();
  double softening = 1.0;
  for (int attempt = 1;;) {
    complaints = 0;
    attach_contacts(engine, softening);
    engine.followers->push();
    dWorldStep(engine.world, engine.solver.timestep_s);
    const bool gave_up = complaints > 0 && attempt < kMostAttempts;
    if (!gave_up && !engine.followers->correct()) break;
    if (gave_up) {
      if (attempt++ == 1) ++engine.statistics.solved_again;
      softening *= kSofter;
    }
    before.restore();
    dJointGroupEmpty(engine.contact_group);
  }
}

}  // namespace parallax::harness
