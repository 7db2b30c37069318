// Tells which joints of a robot are at rest, so that they need no constraint (ode_hosts.cc).
//
// A joint comes to rest after a short time in which its command stayed the same and its child
// did not move against its parent. It is parted again, in the step that needs it, when it is
// told something else, when a contact disturbs it, or when the load that it bore in the last
// step took more than half of its force; below that its motor holds it as firmly. A touched hand
// disturbs all joints from it up to its gantry and all that they carry. The joints of an arm's
// chain are disturbed only by what strikes the arm, faster than a bound; they come to rest, and
// are solved without a bound of their torque, only while half of it is enough.
//
// Cost: linear in joints, links and new contacts for each step.

#include "harness/engine/ode_rest.h"

#include <ode/ode.h>

#include <algorithm>
#include <cmath>

#include "harness/engine/ode_vector.h"

namespace parallax::harness {
namespace {

constexpr double kCalm_s = 0.02;       // before a joint is at rest
constexpr double kCalmRate = 1e-5;     // of its motion [m/s or rad/s]
constexpr double kSameCommand = 1e-5;  // what a motor is told changes by no more
constexpr double kShareOfForce = 0.5;  // that a joint at rest may need
constexpr double kStruck_m_s = 0.01;   // what comes closer faster may stop at the force's bound

Eigen::Vector3d velocity_at(dxBody* body, const Eigen::Vector3d& p_W) {
  dVector3 v;
  dBodyGetPointVel(body, p_W.x(), p_W.y(), p_W.z(), v);
  return to_vector(v);
}

bool same(const MotorCommand& a, const MotorCommand& b) {
  return a.max_force == b.max_force && (a.rates - b.rates).cwiseAbs().maxCoeff() <= kSameCommand;
}

}  // namespace

RestingJoints::RestingJoints(OdeWorld::Engine& engine)
    : engine_(engine),
      hosts_(engine),
      watches_(hosts_.joints().size()),
      by_slider_(engine.sliders.size(), -1),
      by_hinge_(engine.hinges.size(), -1),
      by_gantry_(engine.gantries.size(), -1) {
  for (std::size_t i = 0; i < hosts_.joints().size(); ++i) {
    const RobotJoint& joint = hosts_.joints()[i];
    std::vector<int>& by = joint.kind == RobotJoint::Kind::kGantry   ? by_gantry_
                           : joint.kind == RobotJoint::Kind::kSlider ? by_slider_
                                                                     : by_hinge_;
    by[joint.index] = static_cast<int>(i);
    has_chain_ = has_chain_ || joint.in_chain;
  }
  calm_steps_needed_ = std::max<std::int64_t>(1, std::llround(kCalm_s / engine.solver.timestep_s));
}

void RestingJoints::tell(SliderId id, const MotorCommand& command) {
  if (const int joint = by_slider_[id.index()]; joint >= 0) {
    watches_[static_cast<std::size_t>(joint)].now = command;
  }
}

void RestingJoints::tell(HingeId id, const MotorCommand& command) {
  if (const int joint = by_hinge_[id.index()]; joint >= 0) {
    watches_[static_cast<std::size_t>(joint)].now = command;
  }
}

bool RestingJoints::tell(GantryId id, const MotorCommand& command) {
  const int joint = by_gantry_[id.index()];
  if (joint < 0) return false;
  watches_[static_cast<std::size_t>(joint)].now = command;
  return true;
}

void RestingJoints::reset() {
  hosts_.reset();
  for (Watch& watch : watches_) watch = Watch{};
}

bool RestingJoints::is_calm(const RobotJoint& joint, const Watch& watch) const {
  if (!joint.may_rest || !same(watch.now, watch.before)) return false;
  dxBody* const child = engine_.links[joint.child];
  Eigen::Vector3d v = to_vector(dBodyGetLinearVel(child));
  Eigen::Vector3d w = to_vector(dBodyGetAngularVel(child));
  if (joint.parent) {
    dxBody* const parent = engine_.links[*joint.parent];
    const Eigen::Vector3d turn = to_vector(dBodyGetAngularVel(parent));
    const Eigen::Vector3d arm =
        to_vector(dBodyGetPosition(child)) - to_vector(dBodyGetPosition(parent));
    v -= to_vector(dBodyGetLinearVel(parent)) + turn.cross(arm);
    w -= turn;
  }
  return v.norm() <= kCalmRate && w.norm() <= kCalmRate;
}

bool RestingJoints::is_overloaded(const RobotJoint& joint, const Watch& watch) const {
  const auto [turn, shift] = hosts_.motion_of_parent(joint);
  const Eigen::Vector3d about = joint.kind == RobotJoint::Kind::kHinge
                                    ? Eigen::Vector3d(shift + turn * joint.spec->p_WA)
                                    : to_vector(dBodyGetPosition(engine_.links[joint.child]));
  const Wrench load = hosts_.load(joint, about);
  const Eigen::Vector3d axis = turn * joint.spec->axis_W.normalized();
  const double limit = kShareOfForce * watch.now.max_force;
  switch (joint.kind) {
    case RobotJoint::Kind::kGantry: {
      const Eigen::Vector3d force = turn.transpose() * load.force;
      const double limit_n = kShareOfForce * joint.spec->max_force_n;
      return force.head<2>().cwiseAbs().maxCoeff() > limit_n ||
             (joint.parent && std::abs(force.z()) > limit_n) ||
             std::abs(load.torque.z()) > kShareOfForce * joint.spec->max_torque_nm;
    }
    case RobotJoint::Kind::kSlider:
      return std::abs(axis.dot(load.force)) > limit;
    case RobotJoint::Kind::kHinge:
      return std::abs(axis.dot(load.torque)) > limit;
  }
  return true;
}

void RestingJoints::find_struck() {
  struck_.assign(engine_.links.size(), false);
  if (!has_chain_) return;
  for (const NewContact& contact : engine_.new_contacts) {
    Eigen::Vector3d apart = Eigen::Vector3d::Zero();
    const auto &one = info_of(contact.a).link, &other = info_of(contact.b).link;
    if (one) apart += velocity_at(engine_.links[one->index()], contact.p_W);
    if (other) apart -= velocity_at(engine_.links[other->index()], contact.p_W);
    if (contact.normal_W.dot(apart) > -kStruck_m_s) continue;
    if (one) struck_[one->index()] = true;
    if (other) struck_[other->index()] = true;
  }
}

/// By joint of a chain: is something struck that it moves, or hangs at?
std::vector<bool> RestingJoints::struck_joints() const {
  const std::vector<RobotJoint>& joints = hosts_.joints();
  std::vector<bool> all(joints.size(), false);
  if (!has_chain_) return all;
  std::vector<bool> below = struck_, above = struck_;
  for (std::size_t i = joints.size(); i-- > 0;) {  // from the hands up
    if (joints[i].parent && below[joints[i].child]) below[*joints[i].parent] = true;
  }
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (joints[i].parent && above[*joints[i].parent]) above[joints[i].child] = true;
    all[i] = joints[i].in_chain && (below[joints[i].child] || above[*joints[i].parent]);
  }
  return all;
}

/// By joint: does it move something that is touched? Of a hand everything up to its gantry. Of a
/// chain only what is struck counts.
std::vector<bool> RestingJoints::disturbed(const std::vector<bool>& touched) const {
  const std::vector<RobotJoint>& joints = hosts_.joints();
  std::vector<bool> all = struck_joints();
  std::vector<bool> links = touched;
  for (std::size_t i = joints.size(); i-- > 0;) {  // from the hands up
    if (!links[joints[i].child] || joints[i].in_chain) continue;
    all[i] = true;
    if (joints[i].kind != RobotJoint::Kind::kGantry && joints[i].parent) {
      links[*joints[i].parent] = true;
    }
  }
  for (std::size_t i = 0; i < joints.size(); ++i) {  // and down to what they carry
    if (joints[i].in_chain || !joints[i].parent || !links[*joints[i].parent]) continue;
    all[i] = true;
    links[joints[i].child] = true;
  }
  return all;
}

void RestingJoints::begin_step(const std::vector<bool>& touched) {
  std::vector<RobotJoint>& joints = hosts_.joints();
  if (joints.empty()) return;
  find_struck();
  const std::vector<bool> moved = disturbed(touched);
  bool changed = false;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    Watch& watch = watches_[i];
    const bool rested = joints[i].rests;
    if (rested) {
      // `before` stays what it was told when it came to rest.
      joints[i].rests = !moved[i] && !watch.overloaded && same(watch.now, watch.before);
      if (!joints[i].rests) watch = Watch{watch.now, watch.now, 0, false};
    } else {
      const bool calm =
          !moved[i] && is_calm(joints[i], watch) && (!joints[i].in_chain || has_torque_left(i));
      watch.calm_steps = calm ? watch.calm_steps + 1 : 0;
      watch.before = watch.now;
      joints[i].rests = watch.calm_steps >= calm_steps_needed_;
    }
    changed = changed || joints[i].rests != rested;
  }
  if (changed) hosts_.regroup();
  bound_motors(moved);
  hosts_.remember_velocities();
}

bool RestingJoints::has_torque_left(std::size_t joint) const {
  const Watch& watch = watches_[joint];
  return watch.solved && watch.now.max_force > 0.0 &&
         hosts_.motor_torque_nm(joint) <= kShareOfForce * watch.now.max_force;
}

void RestingJoints::bound_motors(const std::vector<bool>& disturbed) {
  for (std::size_t i = 0; i < watches_.size(); ++i) {
    const RobotJoint& joint = hosts_.joints()[i];
    if (!joint.in_chain) continue;
    const bool bounded = disturbed[i] || !has_torque_left(i);
    const double bound = bounded ? watches_[i].now.max_force : dInfinity;
    dJointSetAMotorParam(engine_.turners[joint.index], dParamFMax, bound);
  }
}

void RestingJoints::end_step() {
  const std::vector<RobotJoint>& joints = hosts_.joints();
  for (std::size_t i = 0; i < joints.size(); ++i) watches_[i].solved = !joints[i].rests;
  const auto rests = [](const RobotJoint& joint) { return joint.rests; };
  if (std::none_of(joints.begin(), joints.end(), rests)) return;
  hosts_.follow();
  hosts_.measure_loads(engine_.solver.timestep_s);
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (!joints[i].rests) continue;
    ++resting_;
    watches_[i].overloaded = is_overloaded(joints[i], watches_[i]);
  }
}

}  // namespace parallax::harness
