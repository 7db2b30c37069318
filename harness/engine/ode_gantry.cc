#include <ode/ode.h>

#include <Eigen/Geometry>
#include <cmath>

#include "harness/engine/ode_engine.h"

namespace parallax::harness {
namespace {

double heading_rad(const Eigen::Matrix3d& R) { return std::atan2(R(1, 0), R(0, 0)); }

Eigen::Matrix3d parent_rotation(const OdeWorld& world, const Gantry& gantry) {
  return gantry.parent == nullptr ? Eigen::Matrix3d(Eigen::Matrix3d::Identity())
                                  : world.rotation(gantry.parent_id);
}

}  // namespace

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
  const double yaw = heading_rad(R_PC) - gantry.start_yaw_rad;
  return std::atan2(std::sin(yaw), std::cos(yaw));
}

void OdeWorld::set_gantry(GantryId id, const Eigen::Vector3d& velocity_m_s, double yaw_rate_rad_s) {
  const Gantry& gantry = engine_->gantries[id.index()];
  const JointSpec& spec = engine_->layout.gantries[id];
  Eigen::Vector3d velocity = velocity_m_s;
  if (gantry.parent != nullptr) {
    // The engine measures the velocity half way between the two centres of mass, where a turn of
    // the child counts half; what is asked for is that of the child's centre in the parent.
    const dReal* a = dBodyGetPosition(gantry.child);
    const dReal* b = dBodyGetPosition(gantry.parent);
    const Eigen::Vector3d d(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
    const Eigen::Vector3d d_P = parent_rotation(*this, gantry).transpose() * d;
    velocity -= 0.5 * yaw_rate_rad_s * Eigen::Vector3d::UnitZ().cross(d_P);
  }
  // The tilt that has crept in is taken back at the rate of the engine's own joints.
  const Eigen::Vector3d up = rotation(gantry.child_id).col(2);
  const Eigen::Vector3d back =
      up.cross(Eigen::Vector3d::UnitZ()) * (engine_->solver.erp / engine_->solver.timestep_s);
  const double rigid = dInfinity;
  const double vertical_n = gantry.parent == nullptr ? rigid : spec.max_force_n;
  dJointSetLMotorParam(gantry.linear, dParamVel1, velocity.x());
  dJointSetLMotorParam(gantry.linear, dParamVel2, velocity.y());
  dJointSetLMotorParam(gantry.linear, dParamVel3, velocity.z());
  dJointSetLMotorParam(gantry.linear, dParamFMax1, spec.max_force_n);
  dJointSetLMotorParam(gantry.linear, dParamFMax2, spec.max_force_n);
  dJointSetLMotorParam(gantry.linear, dParamFMax3, vertical_n);
  dJointSetAMotorParam(gantry.angular, dParamVel1, back.x());
  dJointSetAMotorParam(gantry.angular, dParamVel2, back.y());
  dJointSetAMotorParam(gantry.angular, dParamVel3, yaw_rate_rad_s);
  dJointSetAMotorParam(gantry.angular, dParamFMax1, rigid);
  dJointSetAMotorParam(gantry.angular, dParamFMax2, rigid);
  dJointSetAMotorParam(gantry.angular, dParamFMax3, spec.max_torque_nm);
  for (dxBody* const body : {gantry.child, gantry.parent}) {
    if (body != nullptr && dBodyIsEnabled(body) == 0) dBodyEnable(body);
  }
}

}  // namespace parallax::harness
