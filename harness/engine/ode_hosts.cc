// Joints at rest as no constraints: one body of the engine for several links.
//
// The links that joints at rest connect share a host, a body without shapes with the sum of
// their masses, about their common centre. Their own bodies are disabled, keep the shapes, the
// poses and the digest, and follow the host after each step. Links that hang at the world by
// joints at rest have no host and stand still. Regrouping keeps poses and the linear momentum of
// the members; the host turns as its root does.
//
// The load of a joint at rest is what its links needed to move as they did: mass times
// acceleration less gravity, less the contact forces on them, plus the reactions of joints that
// moved, summed from the leaves to the root. Cost: linear in links, joints and contacts for each
// step.

#include "harness/engine/ode_hosts.h"

#include <ode/ode.h>

#include <algorithm>
#include <array>
#include <deque>
#include <utility>

#include "harness/engine/ode_follow.h"
#include "harness/engine/ode_vector.h"

namespace parallax::harness {

/// Forces in the last step: of the parts of each joint, by joint and part, and of contacts.
struct Hosts::Feedback {
  struct Contact {
    std::array<std::optional<std::uint32_t>, 2> links;  // of the robot
    dJointFeedback forces;
  };
  std::vector<std::deque<dJointFeedback>> of_parts;
  std::vector<Contact> of_contacts;  // of this many, reserved: the engine writes into them
};

Hosts::Hosts(OdeWorld::Engine& engine) : engine_(engine), feedback_(new Feedback) {
  links_.resize(engine.links.size());
  for (std::size_t i = 0; i < links_.size(); ++i) {
    dxBody* const body = engine.links[i];
    links_[i].own = links_[i].host = body;
    links_[i].p_default = to_vector(dBodyGetPosition(body));
    links_[i].R_default = to_matrix(dBodyGetRotation(body));
    dMass mass;
    dBodyGetMass(body, &mass);
    links_[i].mass_kg = mass.mass;
    links_[i].I_L = to_matrix(mass.I);
  }
  // Couplings push the parents of their joints, too, which no feedback of the engine tells.
  if (!engine.solver.resting_joints || engine.followers->any()) return;
  collect_joints();
  sort_joints();
  find_chains();
  for (std::uint32_t i = 0; i < joints_.size(); ++i) {
    const RobotJoint& joint = joints_[i];
    auto& feedback = feedback_->of_parts.emplace_back(joint.parts.size());
    for (std::size_t part = 0; part < joint.parts.size(); ++part) {
      dJointSetFeedback(joint.parts[part], &feedback[part]);
    }
    links_[joint.child].of_robot = true;
    if (joint.parent) prepare_to_share(links_[*joint.parent]);
  }
}

Hosts::~Hosts() = default;

void Hosts::prepare_to_share(LinkState& root) {
  root.of_robot = true;
  if (root.shared != nullptr) return;
  root.shared = dBodyCreate(engine_.world);
  dBodySetAutoDisableFlag(root.shared, 0);
  dBodySetGravityMode(root.shared, dBodyGetGravityMode(root.own));
  dBodyDisable(root.shared);
}

void Hosts::collect_joints() {
  const WorldLayout& layout = engine_.layout;
  const auto on_robot = [&](const JointSpec& spec) {
    const auto link = layout.link_of[layout.find_body(spec.child)->index()];
    return link && engine_.never_sleeps[link->index()];
  };
  if (!std::any_of(layout.gantries.begin(), layout.gantries.end(), on_robot)) return;
  const auto add = [&](RobotJoint::Kind kind, std::size_t index, const JointSpec& spec,
                       std::vector<dxJoint*> parts) {
    std::erase(parts, nullptr);
    if (on_robot(spec)) add_joint(kind, index, spec, std::move(parts));
  };
  for (std::size_t i = 0; i < engine_.gantries.size(); ++i) {
    const Gantry& gantry = engine_.gantries[i];
    add(RobotJoint::Kind::kGantry, i, layout.gantries[layout.gantries.id_at(i)],
        {gantry.linear, gantry.angular});
  }
  for (std::size_t i = 0; i < engine_.sliders.size(); ++i) {
    add(RobotJoint::Kind::kSlider, i, layout.sliders[layout.sliders.id_at(i)],
        {engine_.sliders[i], engine_.slider_dampers[i]});
  }
  for (std::size_t i = 0; i < engine_.hinges.size(); ++i) {
    add(RobotJoint::Kind::kHinge, i, layout.hinges[layout.hinges.id_at(i)],
        {engine_.hinges[i], engine_.turners[i], engine_.hinge_dampers[i]});
  }
}

void Hosts::add_joint(RobotJoint::Kind kind, std::size_t index, const JointSpec& spec,
                      std::vector<dxJoint*> parts) {
  const WorldLayout& layout = engine_.layout;
  RobotJoint joint;
  joint.kind = kind;
  joint.index = static_cast<std::uint32_t>(index);
  joint.spec = &spec;
  joint.child = layout.link_of[layout.find_body(spec.child)->index()]->index();
  if (!spec.parent.empty()) {
    const auto link = layout.link_of[layout.find_body(spec.parent)->index()];
    if (link) joint.parent = link->index();
  }
  joint.parts = std::move(parts);
  // One host cannot fall for one part and not for another, and what stands on springs gives way.
  joint.may_rest =
      !spec.suspension && (!joint.parent || dBodyGetGravityMode(links_[*joint.parent].own) ==
                                                dBodyGetGravityMode(links_[joint.child].own));
  joints_.push_back(std::move(joint));
}

/// Parents before children. Where links form no tree no joint ever rests.
void Hosts::sort_joints() {
  std::vector<RobotJoint> sorted;
  std::vector<bool> done(joints_.size(), false), reached(links_.size(), false);
  std::vector<int> parents(links_.size(), 0);
  for (const RobotJoint& joint : joints_) ++parents[joint.child];
  for (bool again = true; again;) {
    again = false;
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      const RobotJoint& joint = joints_[i];
      if (done[i] || (joint.parent && parents[*joint.parent] > 0 && !reached[*joint.parent]))
        continue;
      done[i] = again = true;
      reached[joint.child] = true;
      sorted.push_back(joint);
    }
  }
  const bool tree = sorted.size() == joints_.size() &&
                    std::all_of(parents.begin(), parents.end(), [](int n) { return n <= 1; });
  if (tree) {
    joints_ = std::move(sorted);
  } else {
    joints_.clear();
  }
}

void Hosts::find_chains() {
  std::vector<bool> at_base(links_.size(), false);  // with no gantry but that of the base between
  for (RobotJoint& joint : joints_) {
    const bool hangs_at_base = joint.parent && at_base[*joint.parent];
    const bool gantry = joint.kind == RobotJoint::Kind::kGantry;
    at_base[joint.child] = gantry ? !joint.parent : hangs_at_base;
    joint.in_chain = joint.kind == RobotJoint::Kind::kHinge && hangs_at_base;
  }
}

void Hosts::reset() {
  for (RobotJoint& joint : joints_) joint.rests = false;
  for (LinkState& link : links_) {
    link.host = link.own;
    if (link.shared == nullptr) continue;
    dBodyDisable(link.shared);
  }
  for (const RobotJoint& joint : joints_) {
    for (dxJoint* part : joint.parts) dJointAttach(part, nullptr, nullptr);
  }
  for (RobotJoint& joint : joints_) attach(joint);
}

void Hosts::regroup() {
  for (std::uint32_t i = 0; i < links_.size(); ++i) links_[i].root = i;
  for (const RobotJoint& joint : joints_) {
    if (!joint.rests) continue;
    links_[joint.child].root = joint.parent ? links_[*joint.parent].root : std::nullopt;
  }
  for (std::uint32_t i = 0; i < links_.size(); ++i) {
    LinkState& link = links_[i];
    if (!link.of_robot) continue;
    if (link.shared != nullptr) dBodyDisable(link.shared);
    link.host = link.root ? link.own : nullptr;
    if (link.root == i) {
      dBodyEnable(link.own);
      continue;
    }
    dBodyDisable(link.own);
    if (link.root) continue;
    dBodySetLinearVel(link.own, 0.0, 0.0, 0.0);
    dBodySetAngularVel(link.own, 0.0, 0.0, 0.0);
  }
  for (std::uint32_t i = 0; i < links_.size(); ++i) merge(i);
  for (RobotJoint& joint : joints_) attach(joint);
}

/// Gives what has this link as its root a host, if it is more than that link.
void Hosts::merge(std::uint32_t root) {
  std::vector<LinkState*> members;
  for (LinkState& link : links_) {
    if (link.root == root) members.push_back(&link);
  }
  if (members.size() < 2) return;
  double mass_kg = 0.0;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero(), velocity = Eigen::Vector3d::Zero();
  for (const LinkState* link : members) {
    mass_kg += link->mass_kg;
    middle += link->mass_kg * to_vector(dBodyGetPosition(link->own));
    velocity += link->mass_kg * to_vector(dBodyGetLinearVel(link->own));
  }
  middle /= mass_kg;
  velocity /= mass_kg;
  dxBody* const own = links_[root].own;
  dxBody* const host = links_[root].shared;
  const Eigen::Quaterniond q = to_quaternion(dBodyGetQuaternion(own));
  dMass total;
  dMassSetZero(&total);
  for (LinkState* link : members) {
    link->host = host;
    link->p_HL = q.conjugate() * (to_vector(dBodyGetPosition(link->own)) - middle);
    link->q_HL = q.conjugate() * to_quaternion(dBodyGetQuaternion(link->own));
    add_mass(*link, total);
    dBodyDisable(link->own);
  }
  std::fill_n(total.c, 3, 0.0);  // zero but for rounding
  dBodySetMass(host, &total);
  dBodySetPosition(host, middle.x(), middle.y(), middle.z());
  dBodySetQuaternion(host, dBodyGetQuaternion(own));
  dBodySetLinearVel(host, velocity.x(), velocity.y(), velocity.z());
  const dReal* const w = dBodyGetAngularVel(own);
  dBodySetAngularVel(host, w[0], w[1], w[2]);
  dBodyEnable(host);
}

/// Adds the mass of a link to that of its host.
void Hosts::add_mass(const LinkState& link, dMass& total) {
  dMass mass;
  dBodyGetMass(link.own, &mass);
  dMatrix3 R;
  copy_rotation(link.q_HL.toRotationMatrix(), R);
  dMassRotate(&mass, R);
  dMassTranslate(&mass, link.p_HL.x(), link.p_HL.y(), link.p_HL.z());
  dMassAdd(&total, &mass);
}

void Hosts::remember_velocities() {
  for (const RobotJoint& joint : joints_) {
    LinkState& link = links_[joint.child];
    link.v_before = to_vector(dBodyGetLinearVel(link.own));
    link.w_before = to_vector(dBodyGetAngularVel(link.own));
  }
}

void Hosts::follow() {
  for (const RobotJoint& joint : joints_) {
    LinkState& link = links_[joint.child];
    dxBody* const host = link.host;
    if (host == link.own || host == nullptr) continue;
    const Eigen::Vector3d w = to_vector(dBodyGetAngularVel(host));
    const Eigen::Vector3d arm = to_matrix(dBodyGetRotation(host)) * link.p_HL;
    const Eigen::Vector3d p = to_vector(dBodyGetPosition(host)) + arm;
    const Eigen::Vector3d v = to_vector(dBodyGetLinearVel(host)) + w.cross(arm);
    const Eigen::Quaterniond q = to_quaternion(dBodyGetQuaternion(host)) * link.q_HL;
    const dQuaternion wxyz = {q.w(), q.x(), q.y(), q.z()};
    dBodySetPosition(link.own, p.x(), p.y(), p.z());
    dBodySetQuaternion(link.own, wxyz);
    dBodySetLinearVel(link.own, v.x(), v.y(), v.z());
    dBodySetAngularVel(link.own, w.x(), w.y(), w.z());
  }
}

Wrench Hosts::inertial_load(const LinkState& link, double timestep_s) const {
  Eigen::Vector3d a = (to_vector(dBodyGetLinearVel(link.own)) - link.v_before) / timestep_s;
  const Eigen::Vector3d turn =
      (to_vector(dBodyGetAngularVel(link.own)) - link.w_before) / timestep_s;
  if (dBodyGetGravityMode(link.own) != 0) a.z() -= engine_.solver.gravity_m_s2;
  const Eigen::Vector3d force = link.mass_kg * a;
  Eigen::Vector3d torque = to_vector(dBodyGetPosition(link.own)).cross(force);
  if (!turn.isZero(0.0)) {
    const Eigen::Matrix3d R = to_matrix(dBodyGetRotation(link.own));
    torque += R * (link.I_L * (R.transpose() * turn));
  }
  return {force, torque};
}

void Hosts::expect_contacts(std::size_t count) {
  feedback_->of_contacts.clear();
  feedback_->of_contacts.reserve(count);
}

void Hosts::listen(dxJoint* contact, std::optional<std::uint32_t> one,
                   std::optional<std::uint32_t> other) {
  // The engine's first body is the first that there is.
  const bool moved = one && links_[*one].host != nullptr;
  const auto [first, second] = moved ? std::pair(one, other) : std::pair(other, one);
  const auto of_robot = [&](std::optional<std::uint32_t> link) {
    return link && links_[*link].of_robot && links_[*link].host != nullptr ? link : std::nullopt;
  };
  const std::array links = {of_robot(first), of_robot(second)};
  if (!links[0] && !links[1]) return;
  Feedback::Contact& heard = feedback_->of_contacts.emplace_back();
  heard.links = links;
  dJointSetFeedback(contact, &heard.forces);
}

/// Subtracts contact forces from the loads of links: joints need not bear them.
void Hosts::subtract_contacts() {
  for (const Feedback::Contact& contact : feedback_->of_contacts) {
    const dJointFeedback& forces = contact.forces;
    const std::array<std::pair<const dReal*, const dReal*>, 2> sides = {
        std::pair(forces.f1, forces.t1), std::pair(forces.f2, forces.t2)};
    for (std::size_t side = 0; side < sides.size(); ++side) {
      if (!contact.links[side]) continue;
      LinkState& link = links_[*contact.links[side]];
      const Eigen::Vector3d force = to_vector(sides[side].first);
      const Eigen::Vector3d at = to_vector(dBodyGetPosition(link.host));
      link.load.force -= force;
      link.load.torque -= to_vector(sides[side].second) + at.cross(force);
    }
  }
}

void Hosts::measure_loads(double timestep_s) {
  for (const RobotJoint& joint : joints_) {
    LinkState& child = links_[joint.child];
    child.load = joint.rests ? inertial_load(child, timestep_s) : Wrench{};
  }
  subtract_contacts();
  for (std::size_t i = joints_.size(); i-- > 0;) {  // children first
    const RobotJoint& joint = joints_[i];
    if (!joint.parent) continue;
    Wrench& parent = links_[*joint.parent].load;
    if (joint.rests) {
      parent.force += links_[joint.child].load.force;
      parent.torque += links_[joint.child].load.torque;
      continue;
    }
    // The parent bears the reaction to the joint's force on its child.
    const Eigen::Vector3d at = to_vector(dBodyGetPosition(links_[joint.child].host));
    for (const dJointFeedback& part : feedback_->of_parts[i]) {
      const Eigen::Vector3d force = to_vector(part.f1);
      parent.force += force;
      parent.torque += to_vector(part.t1) + at.cross(force);
    }
  }
}

double Hosts::motor_torque_nm(std::size_t joint) const {
  return to_vector(feedback_->of_parts[joint][1].t1).norm();
}

Wrench Hosts::load(const RobotJoint& joint, const Eigen::Vector3d& about_W) const {
  const Wrench& load = links_[joint.child].load;
  return {load.force, load.torque - about_W.cross(load.force)};
}

}  // namespace parallax::harness
