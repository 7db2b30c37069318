#include <ode/ode.h>

#include <algorithm>
#include <utility>

#include "harness/engine/ode_engine.h"
#include "harness/engine/ode_vector.h"

// The motors of gantries.

namespace parallax::harness {
namespace {

/// How fast the child can turn at the end of the step: as fast as it is told to, if the motor has
/// the torque. A turn that does not happen must not be allowed for.
double reachable_yaw_rate(dxBody* child, dxBody* parent, const JointSpec& spec,
                          const GantryOrder& order, double timestep_s) {
  dMass mass;
  dBodyGetMass(child, &mass);
  const double change = spec.max_torque_nm / mass.I[10] * timestep_s;
  double now = dBodyGetAngularVel(child)[2];
  if (parent != nullptr) now -= dBodyGetAngularVel(parent)[2];
  return std::clamp(order.yaw_rate_rad_s, now - change, now + change);
}

/// Tells the motors of a gantry what they were to be told; which bodies they move is known now.
void carry_out(const OdeWorld& world, const OdeWorld::Engine& engine, GantryId id,
               const GantryOrder& order) {
  const Gantry& gantry = engine.gantries[id.index()];
  const JointSpec& spec = engine.layout.gantries[id];
  dxBody* const child = dJointGetBody(gantry.linear, 0);
  dxBody* const parent = dJointGetBody(gantry.linear, 1);
  const Eigen::Matrix3d R_WP = parent_rotation(world, gantry);
  // The engine measures the velocity at the middle of the child's host, or half way to the middle
  // of the parent's; what is asked for is that of the child's centre in the parent.
  Eigen::Vector3d measured = to_vector(dBodyGetPosition(child));
  if (parent != nullptr) measured = 0.5 * (measured + to_vector(dBodyGetPosition(parent)));
  const Eigen::Vector3d centre = to_vector(dBodyGetPosition(gantry.child));
  const Eigen::Vector3d arm_P = R_WP.transpose() * (measured - centre);
  const double turning = reachable_yaw_rate(child, parent, spec, order, engine.solver.timestep_s);
  Eigen::Vector3d velocity = order.velocity_m_s + turning * Eigen::Vector3d::UnitZ().cross(arm_P);
  velocity.z() = gantry.vertical_share * velocity.z() + gantry.preload_m_s;
  // The tilt that has crept in is taken back at the rate of the engine's own joints.
  const Eigen::Vector3d up = world.rotation(gantry.child_id).col(2);
  const double tilt_share = spec.suspension ? gantry.tilt_share : engine.solver.erp;
  const Eigen::Vector3d back =
      up.cross(Eigen::Vector3d::UnitZ()) * (tilt_share / engine.solver.timestep_s);
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
  dJointSetAMotorParam(gantry.angular, dParamVel3, order.yaw_rate_rad_s);
  dJointSetAMotorParam(gantry.angular, dParamFMax1, rigid);
  dJointSetAMotorParam(gantry.angular, dParamFMax2, rigid);
  dJointSetAMotorParam(gantry.angular, dParamFMax3, spec.max_torque_nm);
}

}  // namespace

Eigen::Matrix3d parent_rotation(const OdeWorld& world, const Gantry& gantry) {
  return gantry.parent == nullptr ? Eigen::Matrix3d(Eigen::Matrix3d::Identity())
                                  : world.rotation(gantry.parent_id);
}

void carry_out_orders(const OdeWorld& world, OdeWorld::Engine& engine) {
  for (std::size_t i = 0; i < engine.gantries.size(); ++i) {
    GantryOrder& order = engine.gantry_orders[i];
    if (!std::exchange(order.waiting, false)) continue;
    if (dJointIsEnabled(engine.gantries[i].linear) == 0) continue;
    carry_out(world, engine, engine.layout.gantries.id_at(i), order);
  }
}

}  // namespace parallax::harness
