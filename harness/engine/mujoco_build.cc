#include <mujoco/mujoco.h>

#include <array>
#include <cstring>
#include <mutex>

#include "harness/engine/mujoco_engine.h"
#include "harness/engine/mujoco_errors.h"
#include "harness/engine/tree_start.h"

// The world is handed over as text in the engine's own language, the only way in that its library
// has; the text never is a file.

namespace parallax::harness {
namespace {

/// Reads a text; the reader of the library keeps a copy of its own and is not made for threads. It
/// catches errors of the engine itself.
mjModel* read_model(const std::string& text) {
  static std::mutex mutex;
  const std::lock_guard<std::mutex> lock(mutex);
  const auto files = std::make_unique<mjVFS>();
  mj_defaultVFS(files.get());
  constexpr const char* kFile = "world.xml";
  std::array<char, 1000> why{};
  mjModel* model = nullptr;
  if (mj_makeEmptyFileVFS(files.get(), kFile, static_cast<int>(text.size())) == 0) {
    std::memcpy(files->filedata[files->nfile - 1], text.data(), text.size());
    model = mj_loadXML(kFile, files.get(), why.data(), static_cast<int>(why.size()));
  }
  mj_deleteVFS(files.get());
  mj_freeLastXML();
  if (model == nullptr) throw EngineFault(std::string("MuJoCo refuses the world: ") + why.data());
  return model;
}

int number_of(const mjModel& model, mjtObj kind, const std::string& name) {
  const int number = mj_name2id(&model, kind, name.c_str());
  if (number < 0) throw EngineFault("MuJoCo lost `" + name + "`");
  return number;
}

void find_joints(MujocoWorld::Engine& engine) {
  const mjModel& model = *engine.model;
  engine.sliders.resize(engine.layout.sliders.size());
  engine.hinges.resize(engine.layout.hinges.size());
  engine.gantries.resize(engine.layout.gantries.size());
  for (std::size_t i = 0; i < engine.tree.links.size(); ++i) {
    const LinkId id = engine.tree.links.id_at(i);
    const TreeLink& link = engine.tree.links[id];
    engine.bodies.push_back(number_of(model, mjOBJ_BODY, link_name(i)));
    const int joint = number_of(model, mjOBJ_JOINT, joint_name(i, 0));
    engine.joints.push_back({model.jnt_qposadr[joint], model.jnt_dofadr[joint]});
    engine.masses_kg.push_back(link.mass_kg);
    engine.moments_kg_m2.emplace_back(
        Eigen::Map<const Eigen::Vector3d>(model.body_inertia + 3 * engine.bodies.back()));
    if (link.joint == LinkJoint::kSlider) engine.sliders[link.joint_index] = id;
    if (link.joint == LinkJoint::kHinge) engine.hinges[link.joint_index] = id;
    if (link.joint == LinkJoint::kGantry) engine.gantries[link.joint_index] = id;
  }
  engine.targets.assign(static_cast<std::size_t>(model.nv), 0.0);
}

/// How far the springs of gantries are pressed in by what they carry as specified.
void preload(MujocoWorld::Engine& engine) {
  for (std::size_t i = 0; i < engine.gantries.size(); ++i) {
    const auto& springs = engine.layout.gantries[engine.layout.gantries.id_at(i)].suspension;
    double& preload_m = engine.preloads_m.emplace_back(0.0);
    if (!springs) continue;
    preload_m = carried_weight_n(engine.layout, engine.tree, engine.gantries[i],
                                 engine.solver.gravity_m_s2) /
                springs->stiffness_n_m;
  }
}

void find_geoms(MujocoWorld::Engine& engine, const std::vector<BodyId>& bodies) {
  const mjModel& model = *engine.model;
  engine.sides.assign(static_cast<std::size_t>(model.ngeom), nullptr);
  const auto side_at = [&](const std::string& name) -> const ContactSide*& {
    return engine.sides[static_cast<std::size_t>(number_of(model, mjOBJ_GEOM, name))];
  };
  side_at(kFloorName) = &engine.rules.floor();
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    side_at(geom_name(i + 1)) = &engine.rules.of(bodies[i]);
  }
  for (const ShapeForm form :
       {ShapeForm::kBox, ShapeForm::kSphere, ShapeForm::kCylinder, ShapeForm::kCapsule}) {
    engine.probes.push_back(number_of(model, mjOBJ_GEOM, probe_name(form)));
  }
}

void find_hulls(MujocoWorld::Engine& engine, WorldText& world) {
  const mjModel& model = *engine.model;
  for (std::size_t i = 0; i < world.hulls.size(); ++i) {
    MeshHull& mesh = engine.hulls.emplace_back();
    mesh.hull = std::move(world.hulls[i]);
    mesh.probe = number_of(model, mjOBJ_GEOM, hull_name(i));
    mesh.p_HG = Eigen::Map<const Eigen::Vector3d>(model.geom_pos + 3 * mesh.probe);
    Eigen::Matrix<double, 3, 3, Eigen::RowMajor> R;
    mju_quat2Mat(R.data(), model.geom_quat + 4 * mesh.probe);
    mesh.R_HG = R;
  }
  engine.hull_of.assign(static_cast<std::size_t>(model.ngeom), nullptr);
  for (const MeshHull& mesh : engine.hulls) {
    engine.hull_of[static_cast<std::size_t>(mesh.probe)] = &mesh;
  }
  for (std::size_t i = 0; i < world.geom_hulls.size(); ++i) {
    if (!world.geom_hulls[i]) continue;
    const int geom = number_of(model, mjOBJ_GEOM, geom_name(i + 1));
    engine.hull_of[static_cast<std::size_t>(geom)] = &engine.hulls[*world.geom_hulls[i]];
  }
}

}  // namespace

void build_engine(MujocoWorld::Engine& engine, const EngineInput& input) {
  WorldText world = write_mjcf(input);
  engine.model.reset(read_model(world.text));
  ask_engine([&] { engine.data.reset(mj_makeData(engine.model.get())); });
  if (engine.data == nullptr) throw EngineFault("MuJoCo has no memory for the world");
  find_joints(engine);
  preload(engine);
  find_geoms(engine, world.geom_bodies);
  find_hulls(engine, world);
}

}  // namespace parallax::harness
