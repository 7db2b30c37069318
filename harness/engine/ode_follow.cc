// Couplings of two joints: the position of a follower is a multiple of that of its leader.
//
// The engine has no such joint, as a coupling acts on up to four bodies. So a force acts along the
// follower and, times the ratio and the other way round, along its leader: the work that it does on
// the one it takes from the other. The forces that a step needs are the root of a function, the
// rates by which followers lag behind at the end of the step, which is linear as long as no contact
// or stop comes or goes. Broyden's method finds it (A class of methods for solving nonlinear
// simultaneous equations, Mathematics of Computation 19, 1965): the step is taken back and solved
// again, each time with forces corrected by the inverse of the derivative, which is learned from
// the corrections. The forces of the last step are the first guess, so that steps without
// a change of acceleration are solved once. Errors of position are taken back as the engine does
// it, by the share `erp` in a step.
//
// Cost: one solution of the step for each correction, two or three where an acceleration changes.

#include "harness/engine/ode_follow.h"

#include <ode/ode.h>

#include <algorithm>
#include <cmath>

#include "harness/engine/ode_vector.h"

namespace parallax::harness {
namespace {

constexpr int kMostRounds = 12;
constexpr double kSameRate = 1e-6;       // a smaller lag counts as none [m/s or rad/s]
constexpr double kMostForce = 1e5;       // where two stops are at odds [N or Nm]
constexpr double kLeastLearned = 1e-12;  // of a correction that says something

/// The inertia of a joint's child alone, along or about the axis.
double own_inertia(dxBody* body, const JointSpec& spec) {
  dMass mass;
  dBodyGetMass(body, &mass);
  if (spec.type == JointType::kSlider) return mass.mass;
  const Eigen::Vector3d axis = spec.axis_W.normalized();
  const Eigen::Vector3d turned = to_matrix(dBodyGetRotation(body)).transpose() * axis;
  const Eigen::Vector3d arm = axis.cross(to_vector(dBodyGetPosition(body)) - spec.p_WA);
  return turned.dot(to_matrix(mass.I) * turned) + mass.mass * arm.squaredNorm();
}

}  // namespace

Followers::Followers(OdeWorld::Engine& engine) : engine_(engine) {
  const auto add = [&](const JointSpec& spec) {
    if (!spec.follows) return;
    Pair pair;
    double own = 1.0, leading = 1.0;
    pair.follower = moved(spec.name, own);
    pair.leader = moved(spec.follows->leader, leading);
    pair.ratio = spec.follows->ratio;
    pair.inertia = 1.0 / (1.0 / own + pair.ratio * pair.ratio / leading);
    pairs_.push_back(pair);
  };
  for (const JointSpec& spec : engine.layout.sliders) add(spec);
  for (const JointSpec& spec : engine.layout.hinges) add(spec);
  reset();
}

Followers::Moved Followers::moved(const std::string& name, double& inertia) const {
  const WorldLayout& layout = engine_.layout;
  const auto own = [&](const JointSpec& spec) {
    const auto link = layout.link_of[layout.find_body(spec.child)->index()];
    return link ? own_inertia(engine_.links[link->index()], spec) : 1.0;
  };
  if (const auto slider = layout.find_slider(name)) {
    inertia = own(layout.sliders[*slider]);
    return {engine_.sliders[slider->index()], true, {}};
  }
  const HingeId hinge = *layout.find_hinge(name);
  inertia = own(layout.hinges[hinge]);
  return {engine_.hinges[hinge.index()], false, hinge};
}

void Followers::forget_compliance() {
  const auto count = static_cast<Eigen::Index>(pairs_.size());
  force_for_lag_ = Eigen::MatrixXd::Zero(count, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    force_for_lag_(i, i) = pairs_[static_cast<std::size_t>(i)].inertia / engine_.solver.timestep_s;
  }
}

void Followers::reset() {
  forces_ = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(pairs_.size()));
  forget_compliance();
  // The engine puts bodies to sleep one by one, and would not wake one by a force.
  for (const Pair& pair : pairs_) {
    for (dxJoint* joint : {pair.leader.joint, pair.follower.joint}) {
      for (int side = 0; side < 2; ++side) {
        dxBody* const body = dJointGetBody(joint, side);
        if (body != nullptr) dBodySetAutoDisableFlag(body, 0);
      }
    }
  }
}

double Followers::position(const Moved& moved) const {
  if (moved.slides) return dJointGetSliderPosition(moved.joint);
  return dJointGetHingeAngle(moved.joint) + whole_turns_rad(engine_, moved.hinge);
}

double Followers::rate(const Moved& moved) {
  return moved.slides ? dJointGetSliderPositionRate(moved.joint)
                      : dJointGetHingeAngleRate(moved.joint);
}

void Followers::add_force(const Moved& moved, double force) {
  if (moved.slides) {
    dJointAddSliderForce(moved.joint, force);
  } else {
    dJointAddHingeTorque(moved.joint, force);
  }
}

void Followers::begin_step() {
  round_ = 0;
  const double share_per_s = engine_.solver.erp / engine_.solver.timestep_s;
  for (Pair& pair : pairs_) {
    pair.wanted_rate =
        -share_per_s * (position(pair.follower) - pair.ratio * position(pair.leader));
  }
}

void Followers::push() {
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    const double force = forces_(static_cast<Eigen::Index>(i));
    add_force(pairs_[i].follower, force);
    add_force(pairs_[i].leader, -pairs_[i].ratio * force);
  }
}

bool Followers::correct() {
  if (pairs_.empty()) return false;
  Eigen::VectorXd lags(forces_.size());
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    const Pair& pair = pairs_[i];
    lags(static_cast<Eigen::Index>(i)) =
        rate(pair.follower) - pair.ratio * rate(pair.leader) - pair.wanted_rate;
  }
  if (round_ > 0) {
    // Broyden's update of the inverse, by the formula of Sherman and Morrison.
    const Eigen::VectorXd push = forces_ - forces_before_;
    const Eigen::VectorXd told = force_for_lag_ * (lags - lags_before_);
    const double scale = push.dot(told);
    if (std::abs(scale) > kLeastLearned * push.squaredNorm()) {
      force_for_lag_ += (push - told) * (push.transpose() * force_for_lag_) / scale;
    }
  }
  if (lags.cwiseAbs().maxCoeff() < kSameRate) return false;
  if (++round_ > kMostRounds) {
    forget_compliance();
    return false;
  }
  forces_before_ = forces_;
  lags_before_ = lags;
  forces_ = (forces_ - force_for_lag_ * lags).cwiseMax(-kMostForce).cwiseMin(kMostForce);
  return true;
}

}  // namespace parallax::harness
