#include <ode/ode.h>

#include "harness/engine/ode_hosts.h"
#include "harness/engine/ode_vector.h"

// Attaches the joints of the robot to the bodies that host their links.

namespace parallax::harness {

void Hosts::attach(RobotJoint& joint) {
  LinkState& child = links_[joint.child];
  // At rest it measures what its own links do, and connects nothing.
  dxBody* const child_host = joint.rests ? child.own : child.host;
  dxBody* parent_host = nullptr;
  if (joint.parent) {
    parent_host = joint.rests ? links_[*joint.parent].own : links_[*joint.parent].host;
  }
  // The middle of a shared host is elsewhere whenever it carries something else.
  const bool shared = child_host != child.own ||
                      (parent_host != nullptr && parent_host != links_[*joint.parent].own);
  if (shared || dJointGetBody(joint.parts.front(), 0) != child_host ||
      dJointGetBody(joint.parts.front(), 1) != parent_host) {
    if (joint.kind == RobotJoint::Kind::kGantry) {
      attach_gantry(joint, child_host, parent_host);
    } else {
      attach_in_reference(joint, child_host, parent_host);
    }
  }
  for (dxJoint* part : joint.parts) joint.rests ? dJointDisable(part) : dJointEnable(part);
}

void Hosts::attach_gantry(RobotJoint& joint, dxBody* child, dxBody* parent) {
  const Gantry& gantry = engine_.gantries[joint.index];
  for (dxJoint* part : joint.parts) dJointAttach(part, child, parent);
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  // of the parent by default
  if (!joint.spec->parent.empty()) axes = engine_.in_link[gantry.parent_id.index()].R_LB;
  if (joint.parent) axes = to_matrix(dBodyGetRotation(links_[*joint.parent].own)) * axes;
  for (int axis = 0; axis < 3; ++axis) {
    dJointSetLMotorAxis(gantry.linear, axis, parent == nullptr ? 0 : 2, axes(0, axis),
                        axes(1, axis), axes(2, axis));
  }
}

Hosts::Motion Hosts::motion_of_parent(const RobotJoint& joint) const {
  Motion motion;
  if (!joint.parent) return motion;
  const LinkState& parent = links_[*joint.parent];
  motion.turn = to_matrix(dBodyGetRotation(parent.own)) * parent.R_default.transpose();
  motion.shift = to_vector(dBodyGetPosition(parent.own)) - motion.turn * parent.p_default;
  return motion;
}

/// The engine measures sliders and hinges from where their bodies are when it attaches them. So the
/// child is for this moment where it is by default, seen from its parent.
void Hosts::attach_in_reference(RobotJoint& joint, dxBody* child, dxBody* parent) {
  const LinkState& link = links_[joint.child];
  const auto [turn, shift] = motion_of_parent(joint);
  Eigen::Matrix3d R_LH = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p_LH = Eigen::Vector3d::Zero();
  if (child != link.own) {
    R_LH = link.q_HL.toRotationMatrix().transpose();
    p_LH = -(R_LH * link.p_HL);
  }
  const Eigen::Vector3d p_now = to_vector(dBodyGetPosition(child));
  const Eigen::Quaterniond q_now = to_quaternion(dBodyGetQuaternion(child));
  const Eigen::Vector3d p = shift + turn * (link.p_default + link.R_default * p_LH);
  dMatrix3 R;
  copy_rotation(turn * link.R_default * R_LH, R);
  dBodySetPosition(child, p.x(), p.y(), p.z());
  dBodySetRotation(child, R);

  const Eigen::Vector3d axis = turn * joint.spec->axis_W.normalized();
  for (dxJoint* part : joint.parts) dJointAttach(part, child, parent);
  if (joint.kind == RobotJoint::Kind::kSlider) {
    dJointSetSliderAxis(joint.parts[0], axis.x(), axis.y(), axis.z());
    for (std::size_t i = 1; i < joint.parts.size(); ++i) {
      dJointSetLMotorAxis(joint.parts[i], 0, 1, axis.x(), axis.y(), axis.z());
    }
  } else {
    const Eigen::Vector3d anchor = shift + turn * joint.spec->p_WA;
    dJointSetHingeAnchor(joint.parts[0], anchor.x(), anchor.y(), anchor.z());
    dJointSetHingeAxis(joint.parts[0], axis.x(), axis.y(), axis.z());
    for (std::size_t i = 1; i < joint.parts.size(); ++i) {
      dJointSetAMotorAxis(joint.parts[i], 0, 1, axis.x(), axis.y(), axis.z());
    }
  }
  dBodySetPosition(child, p_now.x(), p_now.y(), p_now.z());
  const dQuaternion q = {q_now.w(), q_now.x(), q_now.y(), q_now.z()};
  dBodySetQuaternion(child, q);
}

}  // namespace parallax::harness
