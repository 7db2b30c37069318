// Worlds in MJCF, compared with MuJoCo's own reading of the same files.

#include <mujoco/mujoco.h>

#include <Eigen/Geometry>
#include <iostream>
#include <memory>
#include <numbers>

#include "harness/engine/engine_module.h"
#include "harness/import/import.h"
#include "harness/import/mesh.h"
#include "harness/world/shapes.h"
#include "tests/harness/config/imported_world.h"

namespace parallax::harness::test {
namespace {

bool no_mjcf() {
  if (reads_mjcf()) return false;
  std::cout << "SKIPPED: this build reads no MJCF\n";
  return true;
}

/// The model of a file, as MuJoCo stands it up by default.
struct Oracle {
  explicit Oracle(const std::filesystem::path& file) {
    char why[500] = {};
    model = mj_loadXML(file.c_str(), nullptr, why, sizeof(why));
    REQUIRE_MESSAGE(model != nullptr, why);
    data = mj_makeData(model);
    mj_kinematics(model, data);
    mj_comPos(model, data);
  }
  Oracle(const Oracle&) = delete;
  Oracle& operator=(const Oracle&) = delete;
  ~Oracle() {
    mj_deleteData(data);
    mj_deleteModel(model);
  }

  std::string name(const int* addresses, int i) const { return model->names + addresses[i]; }
  static Eigen::Vector3d vector(const mjtNum* all, int i) {
    return Eigen::Map<const Eigen::Vector3d>(all + 3 * i);
  }
  static Eigen::Matrix3d matrix(const mjtNum* all, int i) {
    return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(all + 9 * i);
  }

  mjModel* model = nullptr;
  mjData* data = nullptr;
};

struct Placed {
  Eigen::Matrix3d R;
  Eigen::Vector3d p;
};
Placed placed(const BodySpec& body) {
  return {Eigen::AngleAxisd(body.yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix(), body.p_WB};
}

/// Masses, centres, inertias and joints, of everything that moves and has a name in the file.
int compare_bodies(const WorldSpec& world, const Oracle& oracle, const Placed& at) {
  int compared = 0;
  for (int i = 1; i < oracle.model->nbody; ++i) {
    if (oracle.model->body_weldid[i] == 0) continue;
    const std::string name = oracle.name(oracle.model->name_bodyadr, i);
    CAPTURE(name);
    const BodySpec& made = body(world, name);
    const Placed here = placed(made);
    CHECK(made.mass_kg == doctest::Approx(oracle.model->body_mass[i]));
    REQUIRE(made.inertia.has_value());
    const Eigen::Vector3d centre = here.p + here.R * made.inertia->p_BC;
    CHECK((centre - at.p - at.R * Oracle::vector(oracle.data->xipos, i)).norm() < 1e-6);
    const Eigen::Matrix3d turn = at.R * Oracle::matrix(oracle.data->ximat, i);
    const Eigen::Matrix3d expected =
        turn * Oracle::vector(oracle.model->body_inertia, i).asDiagonal() * turn.transpose();
    const Eigen::Matrix3d inertia = here.R * made.inertia->I_C_kg_m2 * here.R.transpose();
    CHECK((inertia - expected).norm() < 1e-6 * expected.norm());
    ++compared;
  }
  return compared;
}

void compare_joints(const WorldSpec& world, const Oracle& oracle, const Placed& at) {
  const mjModel& model = *oracle.model;
  for (int i = 0; i < model.njnt; ++i) {
    if (model.jnt_type[i] != mjJNT_HINGE && model.jnt_type[i] != mjJNT_SLIDE) continue;
    const std::string name = oracle.name(model.name_jntadr, i);
    CAPTURE(name);
    const JointSpec& made = joint(world, name);
    const bool turns = model.jnt_type[i] == mjJNT_HINGE;
    CHECK((made.type == JointType::kHinge) == turns);
    CHECK(made.child == oracle.name(model.name_bodyadr, model.jnt_bodyid[i]));
    CHECK((made.axis_W - at.R * Oracle::vector(oracle.data->xaxis, i)).norm() < 1e-6);
    const int dof = model.jnt_dofadr[i];
    if (turns) {
      CHECK((made.p_WA - at.p - at.R * Oracle::vector(oracle.data->xanchor, i)).norm() < 1e-6);
      CHECK(made.damping_nm_s == doctest::Approx(model.dof_damping[dof]));
      CHECK(made.max_torque_nm == doctest::Approx(model.dof_frictionloss[dof]));
    } else {
      CHECK(made.damping_n_s_m == doctest::Approx(model.dof_damping[dof]));
      CHECK(made.max_force_n == doctest::Approx(model.dof_frictionloss[dof]));
    }
    const auto& low = turns ? made.low_rad : made.low_m;
    const auto& high = turns ? made.high_rad : made.high_m;
    REQUIRE(low.has_value() == (model.jnt_limited[i] != 0));
    if (!low) continue;
    const double first = model.qpos0[model.jnt_qposadr[i]];
    CHECK(*low == doctest::Approx(model.jnt_range[2 * i] - first));
    CHECK(*high == doctest::Approx(model.jnt_range[2 * i + 1] - first));
  }
}

/// Is there a shape of this form and size at this place? Turns that show nothing are let be.
bool has_shape(const WorldSpec& world, ShapeForm form, const Eigen::Vector3d& size_m,
               const Eigen::Vector3d& p_W, const Eigen::Matrix3d& R_W) {
  for (const BodySpec& body : world.bodies) {
    const Placed here = placed(body);
    for (const BodyShape& shape : body.shapes) {
      if (shape.form != form || (shape.size_m - size_m).norm() > 1e-6) continue;
      if ((here.p + here.R * shape.p_BS - p_W).norm() > 1e-6) continue;
      const Eigen::Matrix3d R = here.R * shape_rotation(shape);
      const bool is_same = form == ShapeForm::kSphere || (R - R_W).norm() < 1e-6 ||
                           (form != ShapeForm::kBox && (R - R_W).col(2).norm() < 1e-6);
      if (is_same) return true;
    }
  }
  return false;
}

/// Every geom that something collides with has its shape, and there are no others.
void compare_shapes(const WorldSpec& world, const Oracle& oracle, const Placed& at,
                    std::size_t others) {
  const mjModel& model = *oracle.model;
  std::size_t count = 0, made = 0;
  for (int i = 0; i < model.ngeom; ++i) {
    if (model.geom_contype[i] == 0 && model.geom_conaffinity[i] == 0) continue;
    const Eigen::Vector3d size = Oracle::vector(model.geom_size, i);
    const double r = size.x(), half = size.y();
    ShapeForm form = ShapeForm::kBox;
    Eigen::Vector3d size_m = 2.0 * size;
    switch (model.geom_type[i]) {
      case mjGEOM_BOX:
        break;
      case mjGEOM_SPHERE:
        form = ShapeForm::kSphere;
        size_m = Eigen::Vector3d::Constant(2.0 * r);
        break;
      case mjGEOM_CYLINDER:
        form = ShapeForm::kCylinder;
        size_m = {2.0 * r, 2.0 * r, 2.0 * half};
        break;
      case mjGEOM_CAPSULE:
        form = ShapeForm::kCapsule;
        size_m = {2.0 * r, 2.0 * r, 2.0 * (half + r)};
        break;
      case mjGEOM_MESH:
        ++count;
        continue;  // compared by corners
      default:
        continue;
    }
    ++count;
    CAPTURE(i);
    CAPTURE(oracle.name(model.name_geomadr, i));
    CHECK(has_shape(world, form, size_m, at.p + at.R * Oracle::vector(oracle.data->geom_xpos, i),
                    at.R * Oracle::matrix(oracle.data->geom_xmat, i)));
  }
  for (const BodySpec& body : world.bodies) made += body.shapes.size();
  CHECK(made == count + others);
}

/// The corners of the first hull of the body are those of the mesh, where MuJoCo has them.
void compare_hull(const BodySpec& body, const Oracle& oracle, int geom, const Placed& at) {
  const mjModel& model = *oracle.model;
  REQUIRE(model.geom_type[geom] == mjGEOM_MESH);
  const auto shape = std::find_if(body.shapes.begin(), body.shapes.end(), [](const BodyShape& one) {
    return one.form == ShapeForm::kHull;
  });
  REQUIRE(shape != body.shapes.end());
  const Placed here = placed(body);
  std::vector<Eigen::Vector3d> ours, theirs;
  for (const auto& corner : shape->hull->vertices) {
    ours.push_back(here.p + here.R * (shape->p_BS + shape_rotation(*shape) * corner));
  }
  const int mesh = model.geom_dataid[geom];
  for (int i = 0; i < model.mesh_vertnum[mesh]; ++i) {
    const float* v = model.mesh_vert + 3 * (model.mesh_vertadr[mesh] + i);
    theirs.push_back(at.p + at.R * (Oracle::vector(oracle.data->geom_xpos, geom) +
                                    Oracle::matrix(oracle.data->geom_xmat, geom) *
                                        Eigen::Vector3d(v[0], v[1], v[2])));
  }
  const auto nearest = [](const Eigen::Vector3d& p, const std::vector<Eigen::Vector3d>& all) {
    double least = 1e9;
    for (const auto& one : all) least = std::min(least, (one - p).norm());
    return least;
  };
  REQUIRE(ours.size() >= 8);
  for (const auto& p : ours) CHECK(nearest(p, theirs) < 1e-6);
  for (const auto& p : theirs) CHECK(nearest(p, ours) < 1e-6);
}

int geom_named(const Oracle& oracle, const char* name) {
  const int geom = mj_name2id(oracle.model, mjOBJ_GEOM, name);
  REQUIRE(geom >= 0);
  return geom;
}

const Placed kOrigin = {Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero()};
constexpr std::size_t kCups = 1;

struct Shop {
  Shop() {
    file_in_scenarios(workspace, "worlds/workshop.xml");
    file_in_scenarios(workspace, "worlds/workshop");
  }
  std::optional<Scenario> load(const std::string& rest = kCup) {
    return workspace.load(scenario_with("  mjcf: workshop.xml\n" + rest));
  }
  Workspace workspace;
};

TEST_CASE("a workshop in MJCF: an included file, defaults, a mesh, and what is left out is said") {
  if (no_mjcf() || !reads_meshes()) return;
  Shop shop;
  const auto scenario = shop.load(
      "  bodies: {varnish: {settable: [x, y]}, cup: {size_m: [0.1, 0.1, 0.1], mass_kg: 0.2, "
      "position_m: [5, 5, 0.05]}}\n");
  REQUIRE(scenario.has_value());
  CHECK(
      shop.workspace.reports() ==
      std::vector<std::string>{
          "W5144 at 6:3: not taken over, 1 of them: elements <statistic> of <mujoco>; the first is "
          "`mujoco`",
          "W5144 at 19:5: not taken over, 1 of them: pictures (textures); the first is `grain`",
          "W5144 at 21:5: not taken over, 1 of them: materials; the first is `beech`",
          "W5144 at 26:5: not taken over, 1 of them: lights; the first is `lamp`",
          "W5144 at 27:5: not taken over, 1 of them: cameras; the first is `door`",
          "W5144 at 35:7: not taken over, 1 of them: sites; the first is `vice`",
          "W5144 at 65:7: not taken over, 1 of them: visuals; the first is `label`",
          "W5144 at 65:7: not taken over, 1 of them: attributes `rgba` of <geom>; the first is "
          "`label`",
          "W5144 at 71:5: not taken over, 2 of them: sensors; the first is `drawer_opening`"});
  const WorldSpec& world = scenario->world;
  const Oracle oracle(kShipped / "worlds/workshop.xml");
  CHECK(compare_bodies(world, oracle, kOrigin) == 4);
  compare_joints(world, oracle, kOrigin);
  compare_shapes(world, oracle, kOrigin, kCups);
  compare_hull(body(world, "plane_tool"), oracle, geom_named(oracle, "plane_body"), kOrigin);
  CHECK(body(world, "varnish").settable == std::vector<std::string>{"x", "y"});
  CHECK(body(world, "plane_tool").yaw_rad == doctest::Approx(std::numbers::pi / 6.0));
  CHECK(world.floor_material == "mu0.8");
  CHECK(world.friction.pairs.at({"mu0.5", "mu0.8"}) == 0.5);
  CHECK(joint(world, "cupboard_hinge").parent == "cupboard");
  check_still(world, 0.001);
}

TEST_CASE("its drawer and its door go as far as their stops") {
  if (no_mjcf() || !reads_meshes()) return;
  Shop shop;
  const auto scenario = shop.load();
  REQUIRE(scenario.has_value());
  OdeWorld world(scenario->world);
  REQUIRE_FALSE(world.reset(default_placements(world.layout()), 1).has_value());
  const SliderId drawer = *world.layout().find_slider("drawer_slide");
  const HingeId door = *world.layout().find_hinge("cupboard_hinge");
  world.set_motor(drawer, 0.3, 100.0);
  world.set_hinge_motor(door, -1.0, 30.0);
  for (int i = 0; i < 1500; ++i) REQUIRE(world.step());
  CHECK(world.slider_position_m(drawer) == doctest::Approx(0.35).epsilon(0.01));
  CHECK(world.hinge_angle_rad(door) ==
        doctest::Approx(-110.0 / 180.0 * std::numbers::pi).epsilon(0.01));
}

TEST_CASE("an arm in MJCF, put elsewhere and turned, is MuJoCo's own and stands still") {
  if (no_mjcf()) return;
  Workspace workspace;
  file_in_scenarios(workspace, "robots/column_arm.xml");
  const auto scenario = workspace.load(
      scenario_with("  mjcf: {file: column_arm.xml, at_m: [1, -2, 0], yaw_rad: 0.7}\n" + kCup));
  REQUIRE(scenario.has_value());
  const Oracle oracle(kShipped / "robots/column_arm.xml");
  const Placed at = {Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()).toRotationMatrix(),
                     {1.0, -2.0, 0.0}};
  CHECK(compare_bodies(scenario->world, oracle, at) == 7);
  compare_joints(scenario->world, oracle, at);
  compare_shapes(scenario->world, oracle, at, kCups);
  check_still(scenario->world, 0.002);
}

TEST_CASE("what is shipped stands still in MuJoCo's own engine too") {
  if (no_mjcf() || !has_engine(EngineKind::kMujoco)) return;
  for (const bool is_arm : {true, false}) {
    CAPTURE(is_arm);
    Workspace workspace;
    file_in_scenarios(workspace, is_arm ? "robots/column_arm.xml" : "worlds/workshop.xml");
    if (!is_arm) file_in_scenarios(workspace, "worlds/workshop");
    if (!is_arm && !reads_meshes()) continue;
    const auto scenario = workspace.load(scenario_with(
        std::string("  mjcf: ") + (is_arm ? "column_arm.xml\n" : "workshop.xml\n") + kCup));
    for (const auto& one : workspace.reports()) CHECK_MESSAGE(one.starts_with("W5144"), one);
    REQUIRE(scenario.has_value());
    WorldSpec spec = scenario->world;
    spec.engine = EngineKind::kMujoco;
    const auto world = make_world(spec);
    check_still(*world, 0.001);
  }
}

/// All the ways in which a place can be said, and joints that do not stand at 0.
constexpr const char* kCrooked = R"(<mujoco>
  <compiler angle="degree" eulerseq="zyx" inertiafromgeom="auto"/>
  <default><joint damping="0.25"/><default class="stiff"><joint damping="3"/></default></default>
  <asset>
    <mesh name="wedge" vertex="0 0 0  0.3 0 0  0 0.2 0  0 0 0.1  0.3 0 0.1  0 0.2 0.15  0.3 0.2 0
      0.3 0.2 0.12" refpos="0.05 0 0" scale="1 1.5 1"/>
  </asset>
  <worldbody>
    <geom type="plane" size="0 0 1"/>
    <body name="crate" pos="0 0 1" euler="10 20 30">
      <freejoint/>
      <geom type="box" size="0.1 0.2 0.15" pos="0.02 0 0" axisangle="1 1 0 35" mass="2"/>
      <geom type="cylinder" size="0.05 0.1" pos="0 0.1 0.2" zaxis="1 2 3" density="700"/>
      <body name="lid" pos="0 0 0.4" quat="0.9 0.1 -0.2 0.3">
        <geom type="sphere" size="0.08" pos="0.01 0.02 0.03"/>
      </body>
    </body>
    <body name="arm" pos="2 1 1.5" xyaxes="0 1 0 -1 0.5 1">
      <joint name="shoulder" pos="0.1 0 -0.05" axis="1 2 2" ref="30" limited="true" range="-40 100"/>
      <geom type="capsule" fromto="0 0 0 0.3 0.1 0.2" size="0.03" mass="1.5"/>
      <body name="fore" pos="0.3 0.1 0.2" euler="-15 40 5">
        <joint name="reach" type="slide" class="stiff" axis="0 -1 1" frictionloss="4" ref="0.1"
               limited="true" range="-0.1 0.4"/>
        <inertial pos="0.01 -0.02 0.03" mass="0.8" euler="20 0 45"
                  diaginertia="0.004 0.006 0.007"/>
        <geom type="box" size="0.02 0.03 0.1" euler="0 0 25"/>
      </body>
    </body>
    <body name="doorstop" pos="-2 0 0.5" euler="0 35 70">
      <freejoint/>
      <geom name="stop" type="mesh" mesh="wedge" pos="0.1 0.2 0.3" euler="5 6 7" density="900"/>
    </body>
  </worldbody>
</mujoco>
)";

TEST_CASE("crooked places, given inertias and joints with a reference are as MuJoCo has them") {
  if (no_mjcf() || !reads_meshes()) return;
  Workspace workspace;
  const auto file = workspace.write("crooked.xml", kCrooked);
  const Oracle oracle(file);
  for (const bool is_moved : {false, true}) {
    const std::string where = is_moved ? ", at_m: [3, 4, 0.5], yaw_rad: -2.2" : "";
    const auto scenario =
        workspace.load(scenario_with("  mjcf: {file: crooked.xml" + where + "}\n" + kCup));
    for (const auto& one : workspace.reports()) CAPTURE(one);
    REQUIRE(scenario.has_value());
    Placed at = kOrigin;
    if (is_moved) {
      at = {Eigen::AngleAxisd(-2.2, Eigen::Vector3d::UnitZ()).toRotationMatrix(), {3.0, 4.0, 0.5}};
    }
    CHECK(compare_bodies(scenario->world, oracle, at) == 5);
    compare_joints(scenario->world, oracle, at);
    compare_shapes(scenario->world, oracle, at, kCups);
    compare_hull(body(scenario->world, "doorstop"), oracle, geom_named(oracle, "stop"), at);
  }
}

/// Angles of the only joint while MuJoCo steps the file finely, every `every_s`.
std::vector<double> positions_of(const std::filesystem::path& file, double every_s,
                                 std::size_t count) {
  const Oracle oracle(file);
  oracle.model->opt.timestep = 1e-4;
  oracle.model->opt.integrator = mjINT_RK4;
  std::vector<double> out;
  const auto steps = std::lround(every_s / oracle.model->opt.timestep);
  for (std::size_t i = 0; i < count; ++i) {
    for (long k = 0; k < steps; ++k) mj_step(oracle.model, oracle.data);
    out.push_back(oracle.data->qpos[0]);
  }
  return out;
}

TEST_CASE("a pendulum and a slide in MJCF move in ODE as they do in MuJoCo") {
  if (no_mjcf()) return;
  constexpr double kEvery_s = 0.1;
  constexpr std::size_t kCount = 30;
  const auto with = [](const std::string& inside) {
    return "<mujoco><worldbody><body name='bob' pos='0 0 4'>" + inside +
           "<geom type='capsule' fromto='0 0 0 0.6 0 0' size='0.03' mass='1.2'/>"
           "<geom type='sphere' pos='0.7 0 0' size='0.08' mass='2'/>"
           "</body></worldbody></mujoco>";
  };
  for (const std::string inside :
       {"<joint name='j' axis='0 1 0'/>", "<joint name='j' axis='0 1 0' damping='0.8'/>",
        "<joint name='j' axis='0 1 0.4' pos='0.1 0 0.02' damping='0.3'/>",
        "<joint name='j' type='slide' axis='1 0 -1' damping='25'/>"}) {
    CAPTURE(inside);
    Workspace workspace;
    const auto file = workspace.write("bob.xml", with(inside));
    const auto expected = positions_of(file, kEvery_s, kCount);
    const auto scenario = workspace.load(scenario_with("  mjcf: bob.xml\n" + kCup));
    REQUIRE(scenario.has_value());
    OdeWorld world(scenario->world);
    REQUIRE_FALSE(world.reset(default_placements(world.layout()), 1).has_value());
    const auto slider = world.layout().find_slider("j");
    const auto hinge = world.layout().find_hinge("j");
    double widest = 0.0;
    for (const double there : expected) {
      places_after(world, kEvery_s);
      const double here = slider ? world.slider_position_m(*slider) : world.hinge_angle_rad(*hinge);
      CHECK(std::remainder(here - there, 2.0 * std::numbers::pi) ==
            doctest::Approx(0.0).epsilon(0.01).scale(1.0));
      widest = std::max(widest, std::abs(there));
    }
    CHECK(widest > 1.0);  // it moves at all
  }
}

}  // namespace
}  // namespace parallax::harness::test
