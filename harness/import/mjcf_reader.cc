// MuJoCo's own reader of MJCF, a module of its own (mjcf_module.h).

#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <new>
#include <stdexcept>
#include <string_view>

#include "harness/import/mesh.h"
#include "harness/import/mjcf_module.h"

namespace parallax::harness {
namespace {

struct ModelEnd {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
};
using Model = std::unique_ptr<mjModel, ModelEnd>;

// By itself the engine would write a file, and end the process.
std::string* g_warnings = nullptr;
void keep_warning(const char* text) {
  if (g_warnings != nullptr && g_warnings->empty()) *g_warnings = text;
}
void throw_fault(const char* text) { throw std::runtime_error(text); }

std::string in_one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  std::replace(text.begin(), text.end(), '\r', ' ');
  const auto last = text.find_last_not_of(' ');
  return text.substr(0, last == text.npos ? 0 : last + 1).substr(0, 500);
}

/// "XML Error: invalid keyword: 'foo'\nElement 'geom', line 3" or "Error: ...\nObject name = z,
/// id = 1, line = 3, column = -1".
void set_fault(const std::string& said, MjcfModel& out) {
  std::string_view rest = said;
  for (const std::string_view front : {"XML ", "Error: ", "Error "}) {
    if (rest.starts_with(front)) rest.remove_prefix(front.size());
  }
  std::string_view object;
  auto end = rest.size();
  for (const std::string_view place : {"\nElement '", "\nObject name ="}) {
    const auto at = rest.rfind(place);
    if (at == rest.npos) continue;
    end = std::min(end, at);
    const auto tail = rest.substr(at);
    if (const auto line = tail.rfind("line "); line != tail.npos) {
      const auto digit = tail.find_first_of("0123456789", line);
      if (digit != tail.npos) {
        out.fault_line = std::strtoull(std::string(tail.substr(digit)).c_str(), nullptr, 10);
      }
    }
    const auto name = tail.substr(place.size());
    if (place.starts_with("\nElement")) {
      out.fault_tag = name.substr(0, name.find('\''));
    } else {
      object = name.substr(0, name.find(", id"));
      object.remove_prefix(std::min(object.size(), object.find_first_not_of(' ')));
    }
  }
  for (const char* tag : {"geom", "joint", "mesh"}) {
    if (!out.fault_tag.empty() || out.fault_line == 0) break;
    if (rest.substr(0, end).find(fmt::format(" {} '", tag)) != rest.npos) out.fault_tag = tag;
  }
  out.fault = in_one_line(std::string(rest.substr(0, end)));
  if (!object.empty() && out.fault->find(object) == std::string::npos) {
    *out.fault += in_one_line(fmt::format(" (`{}`)", object));
  }
  if (out.fault_line == 0) out.fault = "MuJoCo does not say where: " + *out.fault;
}

Model loaded(const std::vector<MjcfFile>& files, MjcfModel& out) {
  const auto system = std::make_unique<mjVFS>();
  mj_defaultVFS(system.get());
  for (const MjcfFile& file : files) {
    if (mj_makeEmptyFileVFS(system.get(), file.name.c_str(), static_cast<int>(file.bytes.size())) !=
        0) {
      out.fault = "there are too many files";
      return nullptr;
    }
    std::memcpy(system->filedata[system->nfile - 1], file.bytes.data(), file.bytes.size());
  }
  std::array<char, 2000> why{};
  Model model(mj_loadXML(files.front().name.c_str(), system.get(), why.data(),
                         static_cast<int>(why.size())));
  if (model == nullptr) {
    set_fault(why.data(), out);
  } else {
    keep_warning(why.data());
  }
  return model;
}

std::uint32_t number(int value) { return static_cast<std::uint32_t>(value); }

Eigen::Vector3d vector_at(const mjtNum* values, int i) {
  return Eigen::Map<const Eigen::Vector3d>(values + 3 * i);
}

MjcfFrame frame_at(const mjtNum* places, const mjtNum* turns, int i) {
  return {vector_at(places, i), Eigen::Map<const Eigen::Vector4d>(turns + 4 * i)};
}

// MjcfJointType and MjcfForm list joints and geoms as the engine does.
static_assert(mjJNT_FREE == static_cast<int>(MjcfJointType::kFree) &&
              mjJNT_BALL == static_cast<int>(MjcfJointType::kBall) &&
              mjJNT_SLIDE == static_cast<int>(MjcfJointType::kSlide) &&
              mjJNT_HINGE == static_cast<int>(MjcfJointType::kHinge));
static_assert(mjGEOM_PLANE == static_cast<int>(MjcfForm::kPlane) &&
              mjGEOM_HFIELD == static_cast<int>(MjcfForm::kHeightField) &&
              mjGEOM_SPHERE == static_cast<int>(MjcfForm::kSphere) &&
              mjGEOM_CAPSULE == static_cast<int>(MjcfForm::kCapsule) &&
              mjGEOM_ELLIPSOID == static_cast<int>(MjcfForm::kEllipsoid) &&
              mjGEOM_CYLINDER == static_cast<int>(MjcfForm::kCylinder) &&
              mjGEOM_BOX == static_cast<int>(MjcfForm::kBox) &&
              mjGEOM_MESH == static_cast<int>(MjcfForm::kMesh) && mjNGEOMTYPES == mjGEOM_MESH + 1);

/// Bodies, joints and geoms of a model.
class Translator {
 public:
  Translator(const mjModel& model, MjcfModel& out) : model_(model), out_(out) {}

  void run() {
    const bool falls = (model_.opt.disableflags & mjDSBL_GRAVITY) == 0;
    if (falls) out_.gravity_m_s2 = vector_at(model_.opt.gravity, 0);
    out_.filters_parents = (model_.opt.disableflags & mjDSBL_FILTERPARENT) == 0;
    out_.has_contacts = (model_.opt.disableflags & mjDSBL_CONTACT) == 0;
    for (int i = 0; i < model_.nbody; ++i) add_body(i);
    for (int i = 0; i < model_.njnt; ++i) add_joint(i);
    for (int i = 0; i < model_.ngeom; ++i) add_geom(i);
    for (int i = 0; i < model_.nmesh; ++i) add_mesh(i);
    for (int i = 0; i < model_.nexclude; ++i) {
      const auto both = static_cast<std::uint32_t>(model_.exclude_signature[i]);
      out_.excluded.emplace_back((both >> 16U) - 1U, (both & 0xFFFFU) - 1U);
    }
    add_rest();
  }

 private:
  std::string name_at(const int* addresses, int i) const { return model_.names + addresses[i]; }

  void add_body(int i) {
    MjcfBody& body = out_.bodies.emplace_back();
    body.name = name_at(model_.name_bodyadr, i);
    body.parent = number(model_.body_parentid[i]);
    body.is_static = model_.body_weldid[i] == 0;
    body.frame = frame_at(model_.body_pos, model_.body_quat, i);
    body.mass_kg = model_.body_mass[i];
    body.centre = frame_at(model_.body_ipos, model_.body_iquat, i);
    body.moments_kg_m2 = vector_at(model_.body_inertia, i);
    if (model_.body_mocapid[i] >= 0)
      add("bodies that are led (mocap), which stand", "body", body.name, number(i));
  }

  void add_joint(int i) {
    MjcfJoint& joint = out_.joints.emplace_back();
    joint.name = name_at(model_.name_jntadr, i);
    joint.body = number(model_.jnt_bodyid[i]);
    joint.type = static_cast<MjcfJointType>(model_.jnt_type[i]);
    joint.p_BJ = vector_at(model_.jnt_pos, i);
    joint.axis_B = vector_at(model_.jnt_axis, i);
    joint.is_limited = model_.jnt_limited[i] != 0;
    const mjtNum first = model_.qpos0[model_.jnt_qposadr[i]];
    joint.low = model_.jnt_range[2 * i] - first;
    joint.high = model_.jnt_range[2 * i + 1] - first;
    const int dof = model_.jnt_dofadr[i];
    joint.damping = model_.dof_damping[dof];
    joint.friction = model_.dof_frictionloss[dof];
    joint.armature = model_.dof_armature[dof];
    joint.stiffness = model_.jnt_stiffness[i];
    joint.has_margin = model_.jnt_margin[i] != 0.0;
    joint.is_soft = is_soft(model_.jnt_solref + mjNREF * i, model_.jnt_solimp + mjNIMP * i) ||
                    is_soft(model_.dof_solref + mjNREF * dof, model_.dof_solimp + mjNIMP * dof);
  }

  /// Other solver parameters than those of the format.
  static bool is_soft(const mjtNum* reference, const mjtNum* impedance) {
    mjtNum usual_reference[mjNREF], usual_impedance[mjNIMP];
    mj_defaultSolRefImp(usual_reference, usual_impedance);
    return !std::equal(reference, reference + mjNREF, usual_reference) ||
           !std::equal(impedance, impedance + mjNIMP, usual_impedance);
  }

  void add_geom(int i) {
    MjcfGeom& geom = out_.geoms.emplace_back();
    geom.name = name_at(model_.name_geomadr, i);
    geom.body = number(model_.geom_bodyid[i]);
    geom.form = static_cast<MjcfForm>(model_.geom_type[i]);
    geom.size = vector_at(model_.geom_size, i);
    geom.frame = frame_at(model_.geom_pos, model_.geom_quat, i);
    geom.mesh = number(std::max(0, model_.geom_dataid[i]));
    geom.contact_type = model_.geom_contype[i];
    geom.contact_affinity = model_.geom_conaffinity[i];
    geom.dimension = model_.geom_condim[i];
    geom.friction = model_.geom_friction[3 * i];
    geom.has_priority = model_.geom_priority[i] != 0;
    geom.has_margin = model_.geom_margin[i] != 0.0 || model_.geom_gap[i] != 0.0;
    geom.is_soft = is_soft(model_.geom_solref + mjNREF * i, model_.geom_solimp + mjNIMP * i) ||
                   model_.geom_solmix[i] != 1.0;
  }

  void add_mesh(int i) {
    MjcfMesh& mesh = out_.meshes.emplace_back();
    mesh.name = name_at(model_.name_meshadr, i);
    const bool is_met = std::any_of(out_.geoms.begin(), out_.geoms.end(), [&](const MjcfGeom& g) {
      return g.form == MjcfForm::kMesh && g.mesh == number(i) &&
             (g.contact_type != 0 || g.contact_affinity != 0);
    });
    if (!is_met || out_.fault) return;
    const int points = model_.mesh_vertnum[i], faces = model_.mesh_facenum[i];
    if (static_cast<std::size_t>(faces) > kMaxMeshFaces) {
      out_.fault = fmt::format("the mesh `{}` has more than {} faces", mesh.name, kMaxMeshFaces);
      return;
    }
    const float* point = model_.mesh_vert + 3 * model_.mesh_vertadr[i];
    const int* face = model_.mesh_face + 3 * model_.mesh_faceadr[i];
    mesh.points.assign(point, point + 3 * points);
    for (int k = 0; k < 3 * faces; ++k) mesh.faces.push_back(number(face[k]));
    answer_bytes_ += sizeof(float) * mesh.points.size() + 4 * mesh.faces.size();
    if (answer_bytes_ > kMaxMjcfAnswer / 2) out_.fault = "the meshes come to too many faces";
  }

  void add_rest() {
    add_all("equality constraints", "equality", model_.neq, model_.name_eqadr);
    add_all("tendons", "tendon", model_.ntendon, model_.name_tendonadr);
    add_all("actuators", "actuator", model_.nu, model_.name_actuatoradr);
    add_all("sensors", "sensor", model_.nsensor, model_.name_sensoradr);
    add_all("keyframes", "keyframe", model_.nkey, model_.name_keyadr);
    add_all("pairs of geoms with a contact of their own", "contact", model_.npair,
            model_.name_pairadr);
    add_all("sites", "site", model_.nsite, model_.name_siteadr);
    add_all("cameras", "camera", model_.ncam, model_.name_camadr);
    add_all("lights", "light", model_.nlight, model_.name_lightadr);
    add_all("materials", "material", model_.nmat, model_.name_matadr);
    add_all("data of the file's own (custom)", "custom", model_.nnumeric, model_.name_numericadr);
    add_all("data of the file's own (custom)", "custom", model_.ntext, model_.name_textadr);
    add_all("data of the file's own (custom)", "custom", model_.ntuple, model_.name_tupleadr);
    const mjOption& option = model_.opt;
    if (option.density != 0.0 || option.viscosity != 0.0 ||
        std::any_of(option.wind, option.wind + 3, [](mjtNum x) { return x != 0.0; })) {
      add("forces of air and water (density, viscosity, wind)", "option", "option");
    }
    add_options(option);
    add_flags(option);
  }

  /// How the engine counts, where the file says so: ours has a `solver` of its own.
  void add_options(const mjOption& own) {
    mjOption usual;
    mj_defaultOption(&usual);
    const auto note = [&](bool differs, const char* name) {
      if (differs) add("settings of MuJoCo's engine (option)", "option", name);
    };
    note(own.timestep != usual.timestep, "timestep");
    note(own.integrator != usual.integrator, "integrator");
    note(own.cone != usual.cone, "cone");
    note(own.impratio != usual.impratio, "impratio");
    note(own.solver != usual.solver, "solver");
    note(own.iterations != usual.iterations, "iterations");
    note(own.tolerance != usual.tolerance, "tolerance");
    note(own.noslip_iterations != usual.noslip_iterations, "noslip_iterations");
    note(own.noslip_tolerance != usual.noslip_tolerance, "noslip_tolerance");
    note(own.mpr_iterations != usual.mpr_iterations, "mpr_iterations");
    note(own.mpr_tolerance != usual.mpr_tolerance, "mpr_tolerance");
    note(own.jacobian != usual.jacobian, "jacobian");
    note(own.apirate != usual.apirate, "apirate");
    note(own.o_margin != usual.o_margin, "o_margin");
    note(!std::equal(own.o_solref, own.o_solref + mjNREF, usual.o_solref), "o_solref");
    note(!std::equal(own.o_solimp, own.o_solimp + mjNIMP, usual.o_solimp), "o_solimp");
    note(!std::equal(own.magnetic, own.magnetic + 3, usual.magnetic), "magnetic");
    if (own.collision != usual.collision) {
      add("the choice of which contacts there are (collision)", "option", "option");
    }
  }

  /// Flags that are not as usual, but for gravity and contacts, which are taken over.
  void add_flags(const mjOption& option) {
    struct Flag {
      int bit;
      const char* name;
    };
    for (const Flag& flag :
         {Flag{mjDSBL_CONSTRAINT, "constraint"}, Flag{mjDSBL_EQUALITY, "equality"},
          Flag{mjDSBL_FRICTIONLOSS, "frictionloss"}, Flag{mjDSBL_LIMIT, "limit"},
          Flag{mjDSBL_PASSIVE, "passive"}, Flag{mjDSBL_CLAMPCTRL, "clampctrl"},
          Flag{mjDSBL_WARMSTART, "warmstart"}, Flag{mjDSBL_ACTUATION, "actuation"},
          Flag{mjDSBL_REFSAFE, "refsafe"}, Flag{mjDSBL_SENSOR, "sensor"}}) {
      if ((option.disableflags & flag.bit) != 0)
        add("parts of the engine that are switched off", "flag", flag.name);
    }
    for (const Flag& flag : {Flag{mjENBL_OVERRIDE, "override"}, Flag{mjENBL_ENERGY, "energy"},
                             Flag{mjENBL_FWDINV, "fwdinv"}, Flag{mjENBL_SENSORNOISE, "sensornoise"},
                             Flag{mjENBL_MULTICCD, "multiccd"}}) {
      if ((option.enableflags & flag.bit) != 0)
        add("parts of the engine that are switched on", "flag", flag.name);
    }
  }

  void add_all(const char* kind, const char* tag, int count, const int* names) {
    for (int i = 0; i < count; ++i) add(kind, tag, name_at(names, i));
  }

  void add(const std::string& kind, const std::string& tag, const std::string& name,
           std::uint32_t body = 0) {
    for (MjcfRest& one : out_.rest) {
      if (one.kind != kind) continue;
      ++one.count;
      return;
    }
    out_.rest.push_back({kind, tag, 1, name.substr(0, 200), body});
  }

  const mjModel& model_;
  MjcfModel& out_;
  std::size_t answer_bytes_ = 0;
};

}  // namespace

extern "C" __attribute__((visibility("default"))) bool parallax_read_mjcf(
    const char* version, const std::vector<MjcfFile>& files, MjcfModel& model) {
  if (std::string_view(version) != PARALLAX_IMPORT_VERSION) return false;
  std::string warning;
  g_warnings = &warning;
  mju_user_error = &throw_fault;
  mju_user_warning = &keep_warning;
  try {
    const Model compiled = loaded(files, model);
    if (compiled != nullptr) Translator(*compiled, model).run();
  } catch (const std::bad_alloc&) {
    model = {};
    model.fault = "it asks for too much memory";
  } catch (const std::exception& why) {
    model = {};
    set_fault(why.what(), model);
  }
  if (!model.fault && !warning.empty()) {
    model.rest.push_back({"what MuJoCo warns of", "mujoco", 1, in_one_line(warning), 0});
  }
  g_warnings = nullptr;
  return true;
}

}  // namespace parallax::harness
