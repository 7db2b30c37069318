#include <ode/ode.h>

#include <algorithm>

#include "harness/engine/ode_engine.h"
#include "harness/engine/ode_follow.h"
#include "harness/engine/ode_rest.h"
#include "harness/world/shapes.h"

namespace parallax::harness {
namespace {

double total_volume_m3(const BodySpec& body) {
  double sum = 0.0;
  for (const BodyShape& shape : body.shapes) sum += volume_m3(shape);
  return sum;
}

Eigen::Vector3d centre_of_mass_B(const BodySpec& body) {
  if (body.inertia) return body.inertia->p_BC;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const BodyShape& shape : body.shapes) sum += volume_m3(shape) * centroid_B(shape);
  return sum / total_volume_m3(body);
}

/// About its centre of mass, along its own axes.
dMass mass_of(const BodyShape& shape, double mass_kg) {
  constexpr int kAlongZ = 3;
  const Eigen::Vector3d& size_m = shape.size_m;
  const double radius_m = 0.5 * size_m.x();
  dMass mass;
  switch (shape.form) {
    case ShapeForm::kBox:
      dMassSetBoxTotal(&mass, mass_kg, size_m.x(), size_m.y(), size_m.z());
      break;
    case ShapeForm::kSphere:
      dMassSetSphereTotal(&mass, mass_kg, radius_m);
      break;
    case ShapeForm::kCylinder:
      dMassSetCylinderTotal(&mass, mass_kg, kAlongZ, radius_m, size_m.z());
      break;
    case ShapeForm::kCapsule:
      dMassSetCapsuleTotal(&mass, mass_kg, kAlongZ, radius_m, size_m.z() - size_m.x());
      break;
    case ShapeForm::kHull: {
      const Eigen::Matrix3d I = mass_kg * shape.hull->moments_m2;
      dMassSetParameters(&mass, mass_kg, 0.0, 0.0, 0.0, I(0, 0), I(1, 1), I(2, 2), I(0, 1), I(0, 2),
                         I(1, 2));
      break;
    }
  }
  return mass;
}

void put(dMass& mass, const Eigen::Matrix3d& R, const Eigen::Vector3d& p) {
  dMatrix3 rotation_in_rows;
  copy_rotation(R, rotation_in_rows);
  dMassRotate(&mass, rotation_in_rows);
  dMassTranslate(&mass, p.x(), p.y(), p.z());
}

/// Mass of a body whose frame is placed in the link as `place` says.
dMass mass_in_link(const BodySpec& body, const PoseInLink& place) {
  dMass total;
  if (body.inertia) {
    const Eigen::Matrix3d& I = body.inertia->I_C_kg_m2;
    dMassSetParameters(&total, body.mass_kg, 0.0, 0.0, 0.0, I(0, 0), I(1, 1), I(2, 2), I(0, 1),
                       I(0, 2), I(1, 2));
    put(total, place.R_LB, place.p_LB + place.R_LB * body.inertia->p_BC);
    return total;
  }
  dMassSetZero(&total);
  for (const BodyShape& shape : body.shapes) {
    dMass part = mass_of(shape, body.mass_kg * volume_m3(shape) / total_volume_m3(body));
    put(part, place.R_LB * shape_rotation(shape), place.p_LB + place.R_LB * centroid_B(shape));
    dMassAdd(&total, &part);
  }
  return total;
}

}  // namespace

void copy_rotation(const Eigen::Matrix3d& R, double (&out)[12]) {
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) out[4 * row + column] = R(row, column);
    out[4 * row + 3] = 0.0;
  }
}

OdeWorld::Engine::Engine(const WorldSpec& spec) : EngineState(spec, lay_out(spec)) {}

OdeWorld::Engine::~Engine() = default;

OdeBuilder::OdeBuilder(OdeWorld::Engine& engine) : engine_(engine) {}

void OdeBuilder::build() {
  create_world();
  create_links();
  create_geoms();
  create_sliders();
  create_gantries();
  create_hinges();
  engine_.gantry_orders.resize(engine_.gantries.size());
  engine_.touched.resize(engine_.links.size());
  engine_.followers = std::make_unique<Followers>(engine_);
  engine_.resting = std::make_unique<RestingJoints>(engine_);
}

void OdeBuilder::create_world() {
  engine_.world = dWorldCreate();
  // The engine's default stepping object is shared by all worlds of the process and not locked.
  engine_.threading = dThreadingAllocateSelfThreadedImplementation();
  dWorldSetStepThreadingImplementation(
      engine_.world, dThreadingImplementationGetFunctions(engine_.threading), engine_.threading);
  engine_.static_space = dSimpleSpaceCreate(nullptr);
  engine_.movable_space = dSimpleSpaceCreate(nullptr);
  engine_.contact_group = dJointGroupCreate(0);

  const SolverSpec& solver = engine_.solver;
  dWorldSetGravity(engine_.world, 0.0, 0.0, solver.gravity_m_s2);
  dWorldSetERP(engine_.world, solver.erp);
  dWorldSetCFM(engine_.world, solver.cfm);
  dWorldSetContactSurfaceLayer(engine_.world, solver.surface_layer_m);
  dWorldSetContactMaxCorrectingVel(engine_.world, solver.max_correcting_velocity_m_s);
  dWorldSetAutoDisableFlag(engine_.world, 1);
  dWorldSetAutoDisableLinearThreshold(engine_.world, solver.sleep_linear_m_s);
  dWorldSetAutoDisableAngularThreshold(engine_.world, solver.sleep_angular_rad_s);
  dWorldSetAutoDisableSteps(engine_.world, 0);
  dWorldSetAutoDisableTime(engine_.world, solver.sleep_after_s);
}

void OdeBuilder::create_links() {
  const WorldLayout& layout = engine_.layout;
  engine_.in_link.resize(layout.bodies.size());
  for (const Link& link : layout.links) {
    const BodySpec& first = layout.bodies[link.members.front()];
    // The engine wants the centre of mass at the origin of its body.
    Eigen::Vector3d weighted = Eigen::Vector3d::Zero();
    double mass_kg = 0.0;
    for (const BodyId id : link.members) {
      const BodySpec& body = layout.bodies[id];
      weighted +=
          body.mass_kg * (body.p_WB + rotation_about_z(body.yaw_rad) * centre_of_mass_B(body));
      mass_kg += body.mass_kg;
    }
    const Eigen::Vector3d p_WL = weighted / mass_kg;
    const Eigen::Matrix3d R_LW = rotation_about_z(-first.yaw_rad);
    dMass mass;
    dMassSetZero(&mass);
    bool gravity = false;
    for (const BodyId id : link.members) {
      const BodySpec& body = layout.bodies[id];
      PoseInLink& place = engine_.in_link[id.index()];
      place.p_LB = R_LW * (body.p_WB - p_WL);
      place.R_LB = rotation_about_z(body.yaw_rad - first.yaw_rad);
      const dMass part = mass_in_link(body, place);
      dMassAdd(&mass, &part);
      gravity = gravity || body.gravity;
    }
    std::fill_n(mass.c, 3, 0.0);  // zero but for rounding

    dxBody* body = dBodyCreate(engine_.world);
    dBodySetMass(body, &mass);
    dBodySetGravityMode(body, gravity ? 1 : 0);
    dBodySetPosition(body, p_WL.x(), p_WL.y(), p_WL.z());
    dMatrix3 R;
    copy_rotation(R_LW.transpose(), R);
    dBodySetRotation(body, R);
    engine_.links.push_back(body);
    engine_.masses_kg.push_back(mass_kg);
    engine_.never_sleeps.push_back(engine_.rules.is_robot(engine_.rules.of(link.members.front())));
  }
}

void OdeBuilder::create_geoms() {
  std::size_t count = 1;
  for (const BodySpec& body : engine_.layout.bodies) count += body.shapes.size();
  engine_.geoms.reserve(count);
  create_link_spaces();

  GeomInfo& floor = engine_.geoms.emplace_back();
  floor.side = engine_.rules.floor();
  dGeomSetData(dCreatePlane(engine_.static_space, 0.0, 0.0, 1.0, 0.0), &floor);
  for (std::size_t i = 0; i < engine_.layout.bodies.size(); ++i) {
    const BodyId id = engine_.layout.bodies.id_at(i);
    const BodySpec& body = engine_.layout.bodies[id];
    if (!engine_.layout.link_of[i]) {
      engine_.in_link[i] = PoseInLink{body.p_WB, rotation_about_z(body.yaw_rad)};
    }
    if (!body.collides) continue;
    for (const BodyShape& shape : body.shapes) {
      create_shape(
          shape, id,
          engine_.geoms.emplace_back(GeomInfo{engine_.rules.of(id), engine_.layout.link_of[i]}));
    }
  }
  dSpaceClean(engine_.static_space);
}

/// Creates the collision spaces of links. Each space is tested as a whole against each shape of the
/// world; a link with many shapes has one of its own.
void OdeBuilder::create_link_spaces() {
  constexpr std::size_t kManyShapes = 5;
  for (const Link& link : engine_.layout.links) {
    std::size_t count = 0;
    for (const BodyId id : link.members) count += engine_.layout.bodies[id].shapes.size();
    engine_.link_spaces.push_back(count < kManyShapes ? engine_.movable_space
                                                      : dSimpleSpaceCreate(engine_.movable_space));
  }
}

void OdeBuilder::create_shape(const BodyShape& shape, BodyId id, GeomInfo& info) {
  const std::optional<LinkId> link = engine_.layout.link_of[id.index()];
  const PoseInLink& place = engine_.in_link[id.index()];
  const Eigen::Vector3d p = place.p_LB + place.R_LB * shape.p_BS;
  dxGeom* geom =
      create_geom(engine_, link ? engine_.link_spaces[link->index()] : engine_.static_space,
                  {shape.form, shape.size_m, shape.hull});
  info.hull = shape.hull.get();
  dGeomSetData(geom, &info);
  dMatrix3 R;
  const Eigen::Matrix3d R_LS = place.R_LB * shape_rotation(shape);
  copy_rotation(R_LS, R);
  if (!link) {
    dGeomSetPosition(geom, p.x(), p.y(), p.z());
    dGeomSetRotation(geom, R);
    return;
  }
  dGeomSetBody(geom, engine_.links[link->index()]);
  // A geom with an offset costs a little more in each step.
  if (p.isZero(0.0) && R_LS.isIdentity(0.0)) return;
  dGeomSetOffsetPosition(geom, p.x(), p.y(), p.z());
  dGeomSetOffsetRotation(geom, R);
}

dxBody* OdeBuilder::body_of(const std::string& name) const {
  if (name.empty()) return nullptr;
  const auto link = engine_.layout.link_of[engine_.layout.find_body(name)->index()];
  return link ? engine_.links[link->index()] : nullptr;
}

void OdeBuilder::create_sliders() {
  for (const JointSpec& spec : engine_.layout.sliders) {
    dxJoint* joint = dJointCreateSlider(engine_.world, nullptr);
    dJointAttach(joint, body_of(spec.child), body_of(spec.parent));
    const Eigen::Vector3d axis = spec.axis_W.normalized();
    dJointSetSliderAxis(joint, axis.x(), axis.y(), axis.z());
    if (spec.low_m) dJointSetSliderParam(joint, dParamLoStop, *spec.low_m);
    if (spec.high_m) dJointSetSliderParam(joint, dParamHiStop, *spec.high_m);
    engine_.sliders.push_back(joint);
    engine_.slider_dampers.push_back(spec.damping_n_s_m > 0.0 ? damper_of(spec) : nullptr);
  }
}

// A motor at rest that may exert any force, but gives: the force is that of a damper, taken at the
// end of the step, so that no damping is too much for the length of a step.
dxJoint* OdeBuilder::damper_of(const JointSpec& spec) {
  dxJoint* motor = dJointCreateLMotor(engine_.world, nullptr);
  dJointAttach(motor, body_of(spec.child), body_of(spec.parent));
  dJointSetLMotorNumAxes(motor, 1);
  const Eigen::Vector3d axis = spec.axis_W.normalized();
  dJointSetLMotorAxis(motor, 0, 1, axis.x(), axis.y(), axis.z());
  dJointSetLMotorParam(motor, dParamFMax, dInfinity);
  dJointSetLMotorParam(motor, dParamCFM, 1.0 / spec.damping_n_s_m);
  return motor;
}

dxJoint* OdeBuilder::turner_of(const JointSpec& spec) {
  dxJoint* motor = dJointCreateAMotor(engine_.world, nullptr);
  dJointAttach(motor, body_of(spec.child), body_of(spec.parent));
  dJointSetAMotorMode(motor, dAMotorUser);
  dJointSetAMotorNumAxes(motor, 1);
  const Eigen::Vector3d axis = spec.axis_W.normalized();
  dJointSetAMotorAxis(motor, 0, 1, axis.x(), axis.y(), axis.z());
  return motor;
}

void OdeBuilder::create_hinges() {
  for (const JointSpec& spec : engine_.layout.hinges) {
    dxJoint* joint = dJointCreateHinge(engine_.world, nullptr);
    dJointAttach(joint, body_of(spec.child), body_of(spec.parent));
    const Eigen::Vector3d axis = spec.axis_W.normalized();
    dJointSetHingeAnchor(joint, spec.p_WA.x(), spec.p_WA.y(), spec.p_WA.z());
    dJointSetHingeAxis(joint, axis.x(), axis.y(), axis.z());
    if (spec.low_rad) dJointSetHingeParam(joint, dParamLoStop, *spec.low_rad);
    if (spec.high_rad) dJointSetHingeParam(joint, dParamHiStop, *spec.high_rad);
    if (counts_turns(spec) || spec.follows || engine_.layout.leads(spec.name)) {
      engine_.turn_counts.push_back({engine_.layout.hinges.id_at(engine_.hinges.size())});
    }
    engine_.hinges.push_back(joint);
    // At a stop the motor of the hinge itself would push with all its force, also one at rest.
    engine_.turners.push_back(turner_of(spec));
    engine_.hinge_dampers.push_back(nullptr);
    if (spec.damping_nm_s == 0.0) continue;
    dxJoint* damper = turner_of(spec);
    engine_.hinge_dampers.back() = damper;
    dJointSetAMotorParam(damper, dParamFMax, dInfinity);
    dJointSetAMotorParam(damper, dParamCFM, 1.0 / spec.damping_nm_s);
  }
}

void OdeBuilder::create_gantries() {
  for (const JointSpec& spec : engine_.layout.gantries) {
    Gantry gantry;
    gantry.child = body_of(spec.child);
    gantry.parent = body_of(spec.parent);
    gantry.child_id = *engine_.layout.find_body(spec.child);
    const BodySpec& child = engine_.layout.bodies[gantry.child_id];
    Eigen::Matrix3d R_PW = Eigen::Matrix3d::Identity();
    Eigen::Vector3d p_WP = Eigen::Vector3d::Zero();
    gantry.start_yaw_rad = child.yaw_rad;
    if (!spec.parent.empty()) {
      gantry.parent_id = *engine_.layout.find_body(spec.parent);
      const BodySpec& parent = engine_.layout.bodies[gantry.parent_id];
      R_PW = rotation_about_z(-parent.yaw_rad);
      p_WP = parent.p_WB;
      gantry.start_yaw_rad -= parent.yaw_rad;
    }
    gantry.start_P = R_PW * (child.p_WB - p_WP);
    gantry.linear = dJointCreateLMotor(engine_.world, nullptr);
    dJointAttach(gantry.linear, gantry.child, gantry.parent);
    dJointSetLMotorNumAxes(gantry.linear, 3);
    gantry.angular = dJointCreateAMotor(engine_.world, nullptr);
    dJointAttach(gantry.angular, gantry.child, gantry.parent);
    dJointSetAMotorMode(gantry.angular, dAMotorUser);
    dJointSetAMotorNumAxes(gantry.angular, 3);
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d linear = R_PW.transpose().col(axis);
      const Eigen::Vector3d angular = Eigen::Vector3d::Unit(axis);
      dJointSetLMotorAxis(gantry.linear, axis, gantry.parent == nullptr ? 0 : 2, linear.x(),
                          linear.y(), linear.z());
      dJointSetAMotorAxis(gantry.angular, axis, 0, angular.x(), angular.y(), angular.z());
    }
    if (spec.suspension) suspend(*spec.suspension, gantry);
    engine_.gantries.push_back(gantry);
  }
}

namespace {

/// A spring and a damper taken at the end of the step: user guide, section 3.8.2.
struct Softness {
  double share, cfm;
  Softness(double stiffness, double damping, double timestep_s)
      : share(timestep_s * stiffness / (timestep_s * stiffness + damping)),
        cfm(1.0 / (timestep_s * stiffness + damping)) {}
};

}  // namespace

void OdeBuilder::suspend(const SuspensionSpec& springs, Gantry& gantry) const {
  const double step_s = engine_.solver.timestep_s;
  const Softness height(springs.stiffness_n_m, springs.damping_n_s_m, step_s);
  const Softness tilt(springs.stiffness_nm_rad, springs.damping_nm_s, step_s);
  gantry.vertical_share = height.share;
  gantry.tilt_share = tilt.share;
  dJointSetLMotorParam(gantry.linear, dParamCFM3, height.cfm);
  dJointSetAMotorParam(gantry.angular, dParamCFM1, tilt.cfm);
  dJointSetAMotorParam(gantry.angular, dParamCFM2, tilt.cfm);
  const WorldLayout& layout = engine_.layout;
  double weight_n = 0.0;
  for (std::size_t i = 0; i < layout.links.size(); ++i) {
    const BodyId member = layout.links[layout.links.id_at(i)].members.front();
    const bool carried =
        layout.assembly_of[member.index()] == layout.assembly_of[gantry.child_id.index()];
    if (!carried || dBodyGetGravityMode(engine_.links[i]) == 0) continue;
    weight_n -= engine_.masses_kg[i] * engine_.solver.gravity_m_s2;
  }
  gantry.preload_m_s = weight_n * height.cfm;
}

void set_free_mass(OdeWorld::Engine& engine, BodyId id, double mass_kg) {
  const std::optional<LinkId> link = engine.layout.link_of[id.index()];
  BodySpec body = engine.layout.bodies[id];
  if (body.inertia) body.inertia->I_C_kg_m2 *= mass_kg / body.mass_kg;
  body.mass_kg = mass_kg;
  // From scratch each time, so that no rounding of earlier resets is left.
  dMass mass = mass_in_link(body, engine.in_link[id.index()]);
  std::fill_n(mass.c, 3, 0.0);
  dBodySetMass(engine.links[link->index()], &mass);
  engine.masses_kg[link->index()] = mass_kg;
}

}  // namespace parallax::harness
