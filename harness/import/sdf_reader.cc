// The only place of libsdformat, a module of its own (sdf_module.h).

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <sdf/sdf.hh>
#include <string_view>

#include "harness/import/description.h"
#include "harness/import/sdf_includes.h"
#include "harness/import/sdf_mending.h"
#include "harness/import/sdf_module.h"
#include "harness/import/xml_census.h"

namespace parallax::harness {
namespace {

namespace fs = std::filesystem;
namespace math = ignition::math;

constexpr double kDefaultFriction = 1.0;  // of the format

Eigen::Vector3d vector_of(const math::Vector3d& v) { return {v.X(), v.Y(), v.Z()}; }

Eigen::Isometry3d isometry_of(const math::Pose3d& pose) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.translation() = vector_of(pose.Pos());
  const auto& q = pose.Rot();
  X.linear() = Eigen::Quaterniond(q.W(), q.X(), q.Y(), q.Z()).normalized().toRotationMatrix();
  return X;
}

/// The library keeps a log in the home folder and speaks on the standard error: neither is wanted.
class QuietLibrary {
 public:
  QuietLibrary() {
    if (const char* home = std::getenv("HOME")) home_ = home;
    ::setenv("HOME", "/dev/null", 1);
    sdf::Console::Instance()->SetQuiet(true);
    if (home_.empty()) {
      ::unsetenv("HOME");
    } else {
      ::setenv("HOME", home_.c_str(), 1);
    }
  }

 private:
  std::string home_;
};

constexpr std::string_view kPoseKeys = "relative_to frame degrees rotation_format";

/// Values after `=` are the format's own defaults. Names of former versions are among them.
constexpr TakenOf kTaken[] = {
    {"sdf", "version", "world model include"},
    {"world", "name", "gravity", "model include frame", "light actor plugin"},
    {"include", "merge element_id action", "uri name pose static placement_frame", "", "plugin"},
    {"model", "name canonical_link placement_frame",
     "pose static self_collide allow_auto_disable=true enable_wind=false",
     "link joint model include frame", "plugin"},
    {"frame", "name attached_to", "pose"},
    {"pose", kPoseKeys},
    {"link", "name",
     "pose inertial gravity=true enable_wind=false self_collide=false kinematic=false "
     "must_be_base_link=false",
     "collision", "visual sensor light"},
    {"inertial", "", "mass pose inertia"},
    {"inertia", "", "ixx ixy ixz iyy iyz izz"},
    {"collision", "name", "pose geometry surface max_contacts=10 laser_retro=0"},
    {"geometry", "", "box sphere cylinder capsule plane mesh", "",
     "heightmap image polyline ellipsoid empty"},
    {"box", "", "size"},
    {"sphere", "", "radius"},
    {"cylinder", "", "radius length"},
    {"capsule", "", "radius length"},
    {"plane", "", "normal size"},  // its size is of a picture: what collides has no end
    {"mesh", "", "uri scale", "", "submesh"},
    {"surface", "", "friction"},
    {"friction", "", "ode"},
    {"ode", "", "mu slip1=0 slip2=0"},
    {"joint", "name type", "parent child pose axis"},
    {"axis", "", "xyz limit dynamics use_parent_model_frame"},
    {"xyz", "expressed_in"},
    {"limit", "", "lower upper effort velocity stiffness=1e8 dissipation=1"},
    {"dynamics", "", "damping friction spring_reference=0 spring_stiffness"},
};

class SdfReader {
 public:
  SdfReader(const ImportInput& input, const XmlOutline& outline, ImportedWorld& world,
            const IncludeGate& gate)
      : input_(input),
        outline_(outline),
        places_(outline),
        world_(world),
        addresses_(gate.addresses()) {
    list_rest(outline, kTaken, {}, out_.left_out);
    for (const auto& [text, place] : gate.texts()) {
      list_rest(
          outline_of(text), kTaken, [at = place](std::size_t) { return at; }, out_.left_out);
    }
    X_WI_.translation() = input.p_WI;
    X_WI_.linear() = Eigen::AngleAxisd(input.yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  }

  void run() {
    const QuietLibrary quiet;
    sdf::ParserConfig config;
    config.SetWarningsPolicy(sdf::EnforcementPolicy::LOG);
    config.SetUnrecognizedElementsPolicy(sdf::EnforcementPolicy::LOG);
    config.SetDeprecatedElementsPolicy(sdf::EnforcementPolicy::LOG);
    for (const fs::path& folder : input_.folders) config.AddURIPath("model://", folder.string());
    for (const auto& [address, folder] : addresses_) config.AddURIPath(address, folder.string());
    // Nothing else is searched: a file that IncludeGate did not find does not exist.
    config.SetFindCallback([](const std::string&) { return std::string(); });
    sdf::Root root;
    const sdf::Errors errors = root.LoadSdfString(input_.text, config);
    if (!errors.empty() && !load_mended(root, config)) return fault(errors.front());
    if (root.WorldCount() > 1) return fault(0, "holds more than one world");
    if (root.WorldCount() == 1) {
      read_world(*root.WorldByIndex(0));
    } else if (root.Model() != nullptr) {
      const sdf::Model& model = *root.Model();
      math::Pose3d pose = model.RawPose();
      // The library gives the pose of the model, not that of its placement frame.
      if (!model.PlacementFrameName().empty()) {
        leave("placement frames of models that stand in no world", model.Name(), "model");
      }
      read_model(model, X_WI_ * isometry_of(pose), {}, model.Static(), {});
    } else {
      return fault(0, "holds neither a world nor a model");
    }
    if (!world_.fault) assemble(std::move(out_), input_, world_);
  }

 private:
  bool load_mended(sdf::Root& root, const sdf::ParserConfig& config) {
    auto mended = mended_sdf(input_.text, outline_);
    root = sdf::Root();
    if (!root.LoadSdfString(mended.text, config).empty()) return false;
    inertias_ = std::move(mended.inertias);
    if (mended.visuals > 0) leave("visuals", "unnamed", std::size_t{0}, mended.visuals);
    if (mended.sensors > 0) leave("sensors", "unnamed", std::size_t{0}, mended.sensors);
    return true;
  }

  void fault(std::size_t offset, std::string message) {
    if (!world_.fault) world_.fault = TextFault{offset, std::move(message)};
  }
  void fault(const sdf::Error& error) {
    fault(places_.of_message(error.Message()), error.Message());
  }
  bool is_fine(const sdf::Errors& errors) {
    if (!errors.empty()) fault(errors.front());
    return errors.empty();
  }

  void read_world(const sdf::World& world) {
    const math::Vector3d g = world.Gravity();
    if (g.X() != 0.0 || g.Y() != 0.0) return fault(0, "gravity does not point along z");
    world_.gravity_m_s2 = g.Z();
    for (std::uint64_t i = 0; i < world.LightCount(); ++i) {
      leave("lights", world.LightByIndex(i)->Name(), "light");
    }
    for (std::uint64_t i = 0; i < world.ActorCount(); ++i) {
      leave("actors", world.ActorByIndex(i)->Name(), "actor");
    }
    leave_children(world.Element(), "plugin", "plugins");
    for (std::uint64_t i = 0; i < world.ModelCount(); ++i) {
      const sdf::Model& model = *world.ModelByIndex(i);
      math::Pose3d pose;
      if (!is_fine(model.SemanticPose().Resolve(pose))) return;
      read_model(model, X_WI_ * isometry_of(pose), {}, model.Static(), {});
    }
  }

  /// `scope` is "outer::" of a nested model; `apart` that of the outermost.
  void read_model(const sdf::Model& model, const Eigen::Isometry3d& X_WM, const std::string& scope,
                  bool is_static, const std::string& apart) {
    const std::string whole = scope + model.Name();
    const std::string group = !apart.empty()        ? apart
                              : model.SelfCollide() ? std::string()
                                                    : plain_name(whole);
    leave_children(model.Element(), "plugin", "plugins");
    const bool alone = model.LinkCount() == 1 && model.ModelCount() == 0;
    for (std::uint64_t i = 0; i < model.LinkCount() && !world_.fault; ++i) {
      const sdf::Link& link = *model.LinkByIndex(i);
      const std::string name = link_name(whole, link.Name());
      LinkDescription one;
      one.name = alone && scope.empty() ? whole : name;
      names_[name] = one.name;
      one.offset = places_.of(alone ? "model" : "link", alone ? model.Name() : link.Name());
      one.is_static = is_static;
      one.apart = alone && scope.empty() ? std::string() : group;
      read_link(link, X_WM, one);
      if (const auto own = inertias_.find({model.Name(), link.Name()}); own != inertias_.end()) {
        one.I_C_kg_m2 = own->second;
      }
      out_.links.push_back(std::move(one));
    }
    for (std::uint64_t i = 0; i < model.ModelCount() && !world_.fault; ++i) {
      const sdf::Model& inner = *model.ModelByIndex(i);
      math::Pose3d pose;
      if (!is_fine(inner.SemanticPose().Resolve(pose))) return;
      read_model(inner, X_WM * isometry_of(pose), whole + "::", is_static || inner.Static(), group);
    }
    // Joints of types that are not taken over come last: only then is it known what others hold.
    for (const bool is_known : {true, false}) {
      for (std::uint64_t i = 0; i < model.JointCount() && !world_.fault; ++i) {
        const sdf::Joint& joint = *model.JointByIndex(i);
        if (is_taken(joint.Type()) == is_known) read_joint(joint, X_WM, whole);
      }
    }
  }

  static std::string link_name(const std::string& model, const std::string& link) {
    return model + "::" + link;
  }

  void read_link(const sdf::Link& link, const Eigen::Isometry3d& X_WM, LinkDescription& one) {
    math::Pose3d pose;
    if (!is_fine(link.SemanticPose().Resolve(pose))) return;
    one.X_WL = X_WM * isometry_of(pose);
    const math::Inertiald& inertial = link.Inertial();
    one.mass_kg = inertial.MassMatrix().Mass();
    one.X_LC = isometry_of(inertial.Pose());
    const math::Matrix3d I = inertial.MassMatrix().Moi();
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) {
        one.I_C_kg_m2(row, column) =
            I(static_cast<std::size_t>(row), static_cast<std::size_t>(column));
      }
    }
    if (link.VisualCount() > 0) leave("visuals", one.name, one.offset, link.VisualCount());
    if (link.SensorCount() > 0) leave("sensors", one.name, one.offset, link.SensorCount());
    if (link.LightCount() > 0) leave("lights", one.name, one.offset, link.LightCount());
    for (std::uint64_t i = 0; i < link.CollisionCount() && !world_.fault; ++i) {
      read_collision(*link.CollisionByIndex(i), one);
    }
  }

  void read_collision(const sdf::Collision& collision, LinkDescription& link) {
    LinkShape shape;
    math::Pose3d in_link;
    if (!is_fine(collision.SemanticPose().Resolve(in_link))) return;
    shape.X_LS = isometry_of(in_link);
    shape.friction = friction_of(collision.Element());
    const sdf::Geometry& geometry = *collision.Geom();
    if (const auto* box = geometry.BoxShape()) {
      shape.size_m = vector_of(box->Size());
    } else if (const auto* sphere = geometry.SphereShape()) {
      set_round(shape, ShapeForm::kSphere, sphere->Radius(), 0.0);
    } else if (const auto* cylinder = geometry.CylinderShape()) {
      set_round(shape, ShapeForm::kCylinder, cylinder->Radius(), cylinder->Length());
    } else if (const auto* capsule = geometry.CapsuleShape()) {
      set_round(shape, ShapeForm::kCapsule, capsule->Radius(), capsule->Length());
    } else if (const auto* plane = geometry.PlaneShape()) {
      return read_plane(vector_of(plane->Normal()), shape, link);
    } else if (const auto* mesh = geometry.MeshShape()) {
      if (!mesh->Submesh().empty()) return leave("parts of meshes", link.name, link.offset);
      return add_mesh(input_, mesh->Uri(), mesh->FilePath(), vector_of(mesh->Scale()),
                      std::move(shape), link, out_.left_out);
    } else {
      return leave("collisions of other forms", link.name, link.offset);
    }
    link.shapes.push_back(shape);
  }

  static void set_round(LinkShape& shape, ShapeForm form, double radius_m, double length_m) {
    shape.form = form;
    const double across_m = 2.0 * radius_m;
    const double along_m = form == ShapeForm::kSphere    ? across_m
                           : form == ShapeForm::kCapsule ? length_m + across_m
                                                         : length_m;
    shape.size_m = {across_m, across_m, along_m};
  }

  /// Our floor is the plane z = 0.
  void read_plane(const Eigen::Vector3d& normal, const LinkShape& shape, LinkDescription& link) {
    const Eigen::Isometry3d X_WS = link.X_WL * shape.X_LS;
    const bool level = (X_WS.linear() * normal).isApprox(Eigen::Vector3d::UnitZ(), 1e-9);
    if (!level || !link.is_static || std::abs(X_WS.translation().z()) > 1e-9) {
      return leave("planes that are not the floor", link.name, link.offset);
    }
    out_.has_floor = link.has_floor = true;
    out_.floor_friction = shape.friction;
  }

  static std::optional<double> friction_of(const sdf::ElementPtr& collision) {
    sdf::ElementPtr at = collision;
    for (const char* tag : {"surface", "friction", "ode"}) {
      if (at == nullptr || !at->HasElement(tag)) return kDefaultFriction;
      at = at->GetElement(tag);
    }
    return at->HasElement("mu") ? at->Get<double>("mu") : kDefaultFriction;
  }

  static bool is_taken(sdf::JointType type) {
    return type == sdf::JointType::REVOLUTE || type == sdf::JointType::CONTINUOUS ||
           type == sdf::JointType::PRISMATIC || type == sdf::JointType::FIXED;
  }

  void read_joint(const sdf::Joint& joint, const Eigen::Isometry3d& X_WM,
                  const std::string& model) {
    JointDescription one;
    one.name = model + "::" + joint.Name();
    one.offset = places_.of("joint", joint.Name());
    std::string parent, child;
    if (!is_fine(joint.ResolveParentLink(parent)) || !is_fine(joint.ResolveChildLink(child))) {
      return;
    }
    one.parent = parent == "world" ? std::string() : known(model, parent);
    one.child = known(model, child);
    const sdf::JointType type = joint.Type();
    if (type == sdf::JointType::REVOLUTE || type == sdf::JointType::CONTINUOUS) {
      one.type = JointType::kHinge;
    } else if (type == sdf::JointType::PRISMATIC) {
      one.type = JointType::kSlider;
    } else if (type != sdf::JointType::FIXED) {
      const auto hangs = [&](const JointDescription& other) { return other.child == one.child; };
      if (std::any_of(out_.joints.begin(), out_.joints.end(), hangs)) {
        return leave("joints of other types between links that other joints hold", one.name,
                     one.offset);
      }
      leave("joints of other types (held fast)", one.name, one.offset);
    }
    math::Pose3d pose;
    if (!is_fine(joint.SemanticPose().Resolve(pose, "__model__"))) return;
    one.p_WA = (X_WM * isometry_of(pose)).translation();
    const sdf::JointAxis* axis = joint.Axis(0);
    if (one.type != JointType::kFixed) {
      if (axis == nullptr) return fault(one.offset, "the joint has no axis");
      math::Vector3d xyz;
      if (!is_fine(axis->ResolveXyz(xyz, "__model__"))) return;
      one.axis_W = X_WM.linear() * vector_of(xyz);
      one.low = axis->Lower();
      one.high = axis->Upper();
      if (type == sdf::JointType::CONTINUOUS) {
        one.high = std::numeric_limits<double>::infinity();
        one.low = -one.high;
      }
      one.damping = axis->Damping();
      one.friction = axis->Friction();
      if (axis->SpringStiffness() != 0.0) leave("springs of joints", one.name, one.offset);
      if (std::isfinite(axis->Effort()) && axis->Effort() >= 0.0 && axis->Effort() < 1e15) {
        leave("limits of effort (nothing drives an imported joint)", one.name, one.offset);
      }
      if (std::isfinite(axis->MaxVelocity()) && axis->MaxVelocity() >= 0.0 &&
          axis->MaxVelocity() < 1e15) {
        leave("limits of velocity", one.name, one.offset);
      }
    }
    out_.joints.push_back(std::move(one));
  }

  /// The name that the link has with us.
  std::string known(const std::string& model, const std::string& link) const {
    const auto found = names_.find(link_name(model, link));
    return found == names_.end() ? link_name(model, link) : found->second;
  }

  void leave(const std::string& what, const std::string& name, std::size_t offset,
             std::uint64_t count = 1) {
    for (std::uint64_t i = 0; i < count; ++i) out_.left_out.add(what, name, offset);
  }
  void leave(const std::string& what, const std::string& name, const char* tag) {
    leave(what, name, places_.of(tag, name));
  }
  void leave_children(const sdf::ElementPtr& element, const char* tag, const char* what) {
    if (element == nullptr || !element->HasElement(tag)) return;
    for (auto one = element->GetElement(tag); one != nullptr; one = one->GetNextElement(tag)) {
      const auto name = one->HasAttribute("name") ? one->Get<std::string>("name") : std::string();
      leave(what, name, tag);
    }
  }

  const ImportInput& input_;
  const XmlOutline& outline_;
  NamePlaces places_;
  ImportedWorld& world_;
  const std::map<std::string, fs::path>& addresses_;
  std::map<std::pair<std::string, std::string>, Eigen::Matrix3d> inertias_;  // that it refuses
  Eigen::Isometry3d X_WI_ = Eigen::Isometry3d::Identity();
  Description out_;
  std::map<std::string, std::string> names_;  // of links, by scoped name
};

}  // namespace

extern "C" __attribute__((visibility("default"))) bool parallax_read_sdf(const char* version,
                                                                         const ImportInput& input,
                                                                         ImportedWorld& world) {
  if (std::string_view(version) != PARALLAX_IMPORT_VERSION) return false;
  const XmlOutline outline = outline_of(input.text);
  world.fault = outline.fault;
  if (world.fault) return true;
  IncludeGate gate(input.folders, input.packages);
  world.fault = gate.check(outline);
  world.files = gate.files();
  world.absent = gate.absent();
  if (world.fault) return true;
  SdfReader(input, outline, world, gate).run();
  return true;
}

}  // namespace parallax::harness
