// Stops of hinges beyond half a turn.
//
// The engine knows the angle of a hinge up to whole turns only, between minus and plus pi, and
// compares that with the stops. So the turns of a hinge with a far stop are counted: a step that
// changes the angle by more than pi has passed the seam. The engine then gets both stops less the
// whole turns made. Stops that are out of its range stay there until the hinge is in the turn in
// which it meets them. A hinge that turns by more than pi in one step is miscounted, at 1500 rad/s.
//
// Cost: one angle for each such hinge and step.

#include <ode/ode.h>

#include <cmath>
#include <numbers>

#include "harness/engine/ode_engine.h"

namespace parallax::harness {
namespace {

constexpr double kTurn_rad = 2.0 * std::numbers::pi;

}  // namespace

void move_far_stops(OdeWorld::Engine& engine) {
  for (TurnCount& turns : engine.turn_counts) {
    dxJoint* const joint = engine.hinges[turns.hinge.index()];
    const JointSpec& spec = engine.layout.hinges[turns.hinge];
    const double made = kTurn_rad * turns.whole;
    if (spec.low_rad) dJointSetHingeParam(joint, dParamLoStop, *spec.low_rad - made);
    if (spec.high_rad) dJointSetHingeParam(joint, dParamHiStop, *spec.high_rad - made);
    turns.last_rad = dJointGetHingeAngle(joint);
  }
}

void count_turns(OdeWorld::Engine& engine) {
  bool passed = false;
  for (TurnCount& turns : engine.turn_counts) {
    const double now = dJointGetHingeAngle(engine.hinges[turns.hinge.index()]);
    const double change = now - turns.last_rad;
    turns.last_rad = now;
    if (std::abs(change) <= std::numbers::pi) continue;
    turns.whole += change < 0.0 ? 1 : -1;
    passed = true;
  }
  if (passed) move_far_stops(engine);
}

double whole_turns_rad(const OdeWorld::Engine& engine, HingeId id) {
  for (const TurnCount& turns : engine.turn_counts) {
    if (turns.hinge == id) return kTurn_rad * turns.whole;
  }
  return 0.0;
}

}  // namespace parallax::harness
