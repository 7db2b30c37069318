// Worlds in MJCF: vetted here, read in a process of its own, taken over here.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>

#include "harness/import/description.h"
#include "harness/import/mesh.h"
#include "harness/import/mjcf_apart.h"
#include "harness/import/mjcf_module.h"
#include "harness/import/mjcf_places.h"
#include "harness/import/mjcf_text.h"

namespace parallax::harness {
namespace {

Eigen::Isometry3d isometry_from(const MjcfFrame& frame) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.translation() = frame.p;
  const auto& q = frame.wxyz;
  X.linear() = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
  return X;
}

bool is_met(const MjcfGeom& geom) { return geom.contact_type != 0 || geom.contact_affinity != 0; }

/// Corners of a hull that touches an ellipsoid from inside, at the ends of its axes among others.
std::vector<Eigen::Vector3d> ellipsoid_corners(const Eigen::Vector3d& radii) {
  constexpr int kRings = 5, kPerRing = 12;
  std::vector<Eigen::Vector3d> out = {{0.0, 0.0, radii.z()}, {0.0, 0.0, -radii.z()}};
  for (int ring = 1; ring <= kRings; ++ring) {
    const double polar = std::numbers::pi * ring / (kRings + 1);
    for (int i = 0; i < kPerRing; ++i) {
      const double turn = 2.0 * std::numbers::pi * i / kPerRing;
      out.push_back(radii.cwiseProduct(Eigen::Vector3d(
          std::sin(polar) * std::cos(turn), std::sin(polar) * std::sin(turn), std::cos(polar))));
    }
  }
  return out;
}

/// The triangles of a mesh in STL's binary form, which keeps single numbers as they are.
std::string stl_of(const MjcfMesh& mesh) {
  std::string out(80, ' ');
  const auto put = [&](const void* data, std::size_t size) {
    out.append(static_cast<const char*>(data), size);
  };
  const auto count = static_cast<std::uint32_t>(mesh.faces.size() / 3);
  put(&count, sizeof(count));
  const float no_normal[3] = {0.0F, 0.0F, 0.0F};
  const std::uint16_t no_colour = 0;
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    if (i % 3 == 0) put(no_normal, sizeof(no_normal));
    put(&mesh.points[3 * mesh.faces[i]], 3 * sizeof(float));
    if (i % 3 == 2) put(&no_colour, sizeof(no_colour));
  }
  return out;
}

class MjcfImporter {
 public:
  MjcfImporter(const ImportInput& input, const MjcfText& text, const MjcfModel& model,
               ImportedWorld& world)
      : input_(input), text_(text), model_(model), places_(text), world_(world) {}

  void run() {
    if (model_.fault) {
      const std::string said = text_.in_names_given(*model_.fault);
      const bool is_of_mesh = model_.fault_tag.empty() && said != *model_.fault;
      const auto place = places_.line(model_.fault_line, is_of_mesh ? "mesh" : model_.fault_tag);
      return fault(place.offset, place.inside + said);
    }
    set_gravity();
    count_parts();
    name_links();
    stand_on_floor();
    for (std::uint32_t i = 0; i < model_.bodies.size() && !world_.fault; ++i) add_body(i);
    for (std::uint32_t i = 1; i < model_.bodies.size() && !world_.fault; ++i) add_joints(i);
    if (world_.fault) return;
    set_apart(model_, sides_, floors_, out_.links, out_.left_out);
    note_rest();
    assemble(std::move(out_), input_, world_);
  }

 private:
  void fault(std::size_t offset, std::string message) {
    if (!world_.fault) world_.fault = TextFault{offset, std::move(message)};
  }
  void leave(const std::string& what, const std::string& name, std::size_t offset) {
    out_.left_out.add(what, name.empty() ? "unnamed" : name, offset);
  }

  void set_gravity() {
    const Eigen::Vector3d& g = model_.gravity_m_s2;
    // Some files have a trace of it aside, to break a symmetry.
    constexpr double kTrace = 1e-3;
    const double aside = std::hypot(g.x(), g.y());
    if (!(aside <= kTrace * std::abs(g.z())) || !std::isfinite(g.z())) {
      return fault(places_.first("option"), "gravity does not point along z");
    }
    if (aside > 0.0) {
      leave("gravity along x and y", fmt::format("{:g} m/s2", aside), places_.first("option"));
    }
    world_.gravity_m_s2 = g.z();
  }

  void count_parts() {
    parts_.resize(model_.bodies.size());
    for (std::size_t i = 0; i < model_.joints.size(); ++i) {
      parts_[model_.joints[i].body].joints.push_back(i);
    }
    for (std::size_t i = 0; i < model_.geoms.size(); ++i) {
      parts_[model_.geoms[i].body].geoms.push_back(i);
    }
    if (model_.bodies.size() + model_.joints.size() + parts_[0].geoms.size() > kMaxImportParts) {
      fault(0, fmt::format("there are more than {} bodies, joints and geoms of the world",
                           kMaxImportParts));
    }
  }

  /// Appends underscores to a name until nothing else has it.
  std::string unused(std::string name) {
    while (!taken_.insert(plain_name(name)).second) name += "_";
    return name;
  }

  void name_links() {
    const std::set<std::string> ours = {"floor", "world"};
    taken_ = ours;
    for (const MjcfBody& body : model_.bodies) taken_.insert(plain_name(body.name));
    for (std::size_t i = 0; i < model_.bodies.size(); ++i) {
      const MjcfBody& body = model_.bodies[i];
      const bool is_named = !body.name.empty() && !ours.contains(plain_name(body.name));
      names_.push_back(is_named            ? body.name
                       : body.name.empty() ? unused(fmt::format("body_{}", i))
                                           : unused(body.name));
      X_WB_.push_back(i == 0 ? origin() : X_WB_[body.parent] * isometry_from(body.frame));
    }
  }

  bool is_level(const MjcfGeom& geom, const Eigen::Isometry3d& X_WS) const {
    return geom.form == MjcfForm::kPlane && is_met(geom) && model_.bodies[geom.body].is_static &&
           X_WS.linear().col(2).isApprox(Eigen::Vector3d::UnitZ(), 1e-9);
  }

  /// The highest level plane is the floor: where no plane lies at 0 and nobody has placed the
  /// world, all of it moves until that does.
  void stand_on_floor() {
    std::optional<double> height_m;
    for (const MjcfGeom& geom : model_.geoms) {
      const Eigen::Isometry3d X_WS = X_WB_[geom.body] * isometry_from(geom.frame);
      if (!is_level(geom, X_WS)) continue;
      const double z = X_WS.translation().z();
      if (std::abs(z) <= 1e-9) return;
      height_m = std::max(height_m.value_or(z), z);
    }
    if (!height_m || !std::isfinite(*height_m) || input_.p_WI.z() != 0.0) return;
    for (Eigen::Isometry3d& X : X_WB_) X.translation().z() -= *height_m;
    leave("heights of a floor that is not at 0 (the world is moved until it is)",
          fmt::format("{:g} m", *height_m), 0);
  }

  Eigen::Isometry3d origin() const {
    Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
    X.translation() = input_.p_WI;
    X.linear() = Eigen::AngleAxisd(input_.yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    return X;
  }

  void add_body(std::uint32_t i) {
    const MjcfBody& body = model_.bodies[i];
    const std::size_t offset = i == 0 ? 0 : places_.body(i);
    if (!has_numbers(body)) {
      return fault(offset, fmt::format("something of the body `{}` is no number", names_[i]));
    }
    LinkDescription link;
    link.name = names_[i];
    link.offset = offset;
    link.X_WL = X_WB_[i];
    link.is_static = body.is_static;
    if (!body.is_static) {
      link.mass_kg = body.mass_kg;
      link.X_LC = isometry_from(body.centre);
      link.I_C_kg_m2 = body.moments_kg_m2.asDiagonal();
    }
    MjcfSide side;
    side.body = i;
    for (std::size_t k = 0; k < parts_[i].geoms.size() && !world_.fault; ++k) {
      const MjcfGeom& geom = model_.geoms[parts_[i].geoms[k]];
      if (i != 0) {
        add_geom(geom, places_.geom(i, k), link, side);
        continue;
      }
      // A geom of the world becomes a body of its own, with its own friction.
      LinkDescription one = link;
      MjcfSide own = side;
      one.name = unused(geom.name.empty() ? fmt::format("static_{}", k) : geom.name);
      one.offset = places_.geom(i, k);
      add_geom(geom, one.offset, one, own);
      if (!one.shapes.empty() || one.has_floor) add_link(std::move(one), std::move(own));
    }
    if (i == 0) return;
    const bool is_bare = body.is_static && link.shapes.empty();  // holds others in their places
    if (is_bare) {
      bare_.insert(i);
    } else {
      add_link(std::move(link), std::move(side));
    }
  }

  void add_link(LinkDescription link, MjcfSide side) {
    side.link = out_.links.size();
    if (!side.masks.empty()) sides_.push_back(std::move(side));
    out_.links.push_back(std::move(link));
  }

  void add_geom(const MjcfGeom& geom, std::size_t offset, LinkDescription& link, MjcfSide& side) {
    const std::string& name = geom.name.empty() ? link.name : geom.name;
    if (!has_numbers(geom)) {
      return fault(offset, fmt::format("something of the geom of `{}` is no number", link.name));
    }
    if (!is_met(geom)) return leave("visuals", name, offset);
    LinkShape shape;
    shape.X_LS = isometry_from(geom.frame);
    shape.friction = geom.friction;
    note_contact(geom, name, offset);
    if (geom.form == MjcfForm::kPlane) return add_plane(geom, name, offset, shape, link, side);
    if (!set_form(geom, name, offset, shape)) return;
    link.shapes.push_back(std::move(shape));
    side.masks.emplace_back(geom.contact_type, geom.contact_affinity);
  }

  /// False, and it is said, for what has no shape here.
  bool set_form(const MjcfGeom& geom, const std::string& name, std::size_t offset,
                LinkShape& shape) {
    const double radius_m = geom.size.x(), half_m = geom.size.y();
    switch (geom.form) {
      case MjcfForm::kPlane:
      case MjcfForm::kHeightField:
        leave("height fields", name, offset);
        return false;
      case MjcfForm::kSphere:
        set_round(shape, ShapeForm::kSphere, radius_m, 2.0 * radius_m);
        return true;
      case MjcfForm::kCapsule:
        set_round(shape, ShapeForm::kCapsule, radius_m, 2.0 * (half_m + radius_m));
        return true;
      case MjcfForm::kCylinder:
        set_round(shape, ShapeForm::kCylinder, radius_m, 2.0 * half_m);
        return true;
      case MjcfForm::kBox:
        shape.size_m = 2.0 * geom.size;
        return true;
      case MjcfForm::kEllipsoid:
      case MjcfForm::kMesh:
        break;
    }
    if (!reads_meshes()) {
      leave("meshes that are not to be had", name, offset);
      return false;
    }
    shape.form = ShapeForm::kHull;
    if (geom.form == MjcfForm::kMesh) {
      shape.corners = corners_of(geom.mesh, offset);
    } else {
      shape.corners = ellipsoid_corners(geom.size);
      leave(fmt::format("roundings of ellipsoids, which become hulls of {} corners",
                        shape.corners.size()),
            name, offset);
    }
    return true;
  }

  static void set_round(LinkShape& shape, ShapeForm form, double radius_m, double length_m) {
    shape.form = form;
    shape.size_m = {2.0 * radius_m, 2.0 * radius_m, length_m};
  }

  /// Our floor is the plane z = 0.
  void add_plane(const MjcfGeom& geom, const std::string& name, std::size_t offset,
                 const LinkShape& shape, LinkDescription& link, const MjcfSide& side) {
    const Eigen::Isometry3d X_WS = link.X_WL * shape.X_LS;
    if (!is_level(geom, X_WS) || std::abs(X_WS.translation().z()) > 1e-9) {
      return leave("planes that are not the floor", name, offset);
    }
    link.has_floor = out_.has_floor = true;
    out_.floor_friction = std::max(out_.floor_friction.value_or(0.0), geom.friction);
    MjcfSide floor = side;
    floor.masks = {{geom.contact_type, geom.contact_affinity}};
    floors_.push_back(std::move(floor));
  }

  void note_contact(const MjcfGeom& geom, const std::string& name, std::size_t offset) {
    if (geom.is_soft) leave("softness of contacts (solref, solimp)", name, offset);
    if (geom.has_margin) leave("margins of contacts", name, offset);
    if (geom.has_priority) leave("priorities of contacts", name, offset);
    if (geom.dimension == 1) leave("contacts without friction (condim 1)", name, offset);
    if (geom.dimension > 3) leave("friction against turning and rolling (condim)", name, offset);
  }

  /// Made once for each mesh, by the reader of meshes.
  std::vector<Eigen::Vector3d> corners_of(std::uint32_t mesh, std::size_t offset) {
    const auto found = hulls_.find(mesh);
    if (found != hulls_.end()) return found->second;
    const MjcfMesh& read = model_.meshes[mesh];
    const std::string& name = read.name;
    const MeshCorners made =
        mesh_corners(stl_of(read), "stl", Eigen::Vector3d::Ones(), input_.stop);
    if (made.fault) fault(offset, fmt::format("the mesh `{}` {}", name, *made.fault));
    for (const MeshLoss& loss : losses_of(made, name)) leave(loss.what, loss.of, offset);
    return hulls_.emplace(mesh, made.corners).first->second;
  }

  /// Adds what holds a body: its joint, or a weld if it has none. A free joint adds nothing.
  void add_joints(std::uint32_t i) {
    const MjcfBody& body = model_.bodies[i];
    if (body.is_static) return;
    const std::vector<std::size_t>& joints = parts_[i].joints;
    JointDescription one;
    one.parent = bare_.contains(body.parent) || body.parent == 0 ? "" : names_[body.parent];
    one.child = names_[i];
    one.offset = places_.body(i);
    if (joints.empty()) {
      one.name = unused_joint(names_[i] + "_weld");
    } else if (model_.joints[joints.front()].type == MjcfJointType::kFree) {
      const MjcfJoint& free = model_.joints[joints.front()];
      const std::string name = free.name.empty() ? names_[i] : free.name;
      if (free.damping != 0.0 || free.friction != 0.0) {
        leave("damping and friction of free joints", name, places_.joint(i, 0));
      }
      return note_joint(free, name, places_.joint(i, 0));
    } else {
      return add_chain(i, one);
    }
    out_.joints.push_back(std::move(one));
  }

  /// Joints move a body in their order: each but the last has a link of its own, without mass.
  void add_chain(std::uint32_t i, JointDescription one) {
    const std::vector<std::size_t>& joints = parts_[i].joints;
    for (std::size_t k = 0; k < joints.size(); ++k) {
      JointDescription next = one;
      next.child = names_[i];
      set_joint(model_.joints[joints[k]], i, k, next);
      if (k + 1 < joints.size()) {
        LinkDescription between;
        between.name = unused(fmt::format("{}_moved_by_{}", names_[i], next.name));
        between.offset = next.offset;
        between.X_WL = X_WB_[i];
        next.child = between.name;
        out_.links.push_back(std::move(between));
      }
      one.parent = next.child;
      out_.joints.push_back(std::move(next));
    }
  }

  /// Appends underscores to a name until no joint in the file has it.
  std::string unused_joint(std::string name) const {
    const auto is_taken = [&](const MjcfJoint& joint) {
      return plain_name(joint.name) == plain_name(name);
    };
    while (std::any_of(model_.joints.begin(), model_.joints.end(), is_taken)) name += "_";
    return name;
  }

  void set_joint(const MjcfJoint& joint, std::uint32_t body, std::size_t number,
                 JointDescription& one) {
    one.offset = places_.joint(body, number);
    if (joint.name.empty()) {
      one.name = unused_joint(number == 0 ? names_[body] + "_joint"
                                          : fmt::format("{}_joint_{}", names_[body], number + 1));
    } else {
      one.name = joint.name;
    }
    if (!has_numbers(joint)) {
      return fault(one.offset, fmt::format("something of the joint `{}` is no number", one.name));
    }
    if (joint.type == MjcfJointType::kBall) {
      return leave("joints of other types (held fast)", one.name, one.offset);
    }
    one.type = joint.type == MjcfJointType::kHinge ? JointType::kHinge : JointType::kSlider;
    one.axis_W = X_WB_[body].linear() * joint.axis_B;
    one.p_WA = X_WB_[body] * joint.p_BJ;
    constexpr double kNone = std::numeric_limits<double>::infinity();
    one.low = joint.is_limited ? joint.low : -kNone;
    one.high = joint.is_limited ? joint.high : kNone;
    one.damping = joint.damping;
    one.friction = joint.friction;
    note_joint(joint, one.name, one.offset);
  }

  void note_joint(const MjcfJoint& joint, const std::string& name, std::size_t offset) {
    if (joint.stiffness != 0.0) leave("springs of joints", name, offset);
    if (joint.armature != 0.0) leave("inertia of what drives joints (armature)", name, offset);
    if (joint.is_soft) leave("softness of joints (solref, solimp)", name, offset);
    if (joint.has_margin) leave("margins of stops", name, offset);
  }

  void note_rest() {
    for (const MjcfRest& one : model_.rest) {
      const auto offset = one.tag == "body" ? places_.body(one.body) : places_.first(one.tag);
      const std::string first = one.first.empty() ? "unnamed" : text_.in_names_given(one.first);
      for (std::size_t i = 0; i < one.count; ++i) out_.left_out.add(one.kind, first, offset);
    }
  }

  struct Parts {
    std::vector<std::size_t> joints, geoms;
  };
  const ImportInput& input_;
  const MjcfText& text_;
  const MjcfModel& model_;
  MjcfPlaces places_;
  ImportedWorld& world_;
  Description out_;
  std::vector<Parts> parts_;  // by body, as the next two
  std::vector<std::string> names_;
  std::vector<Eigen::Isometry3d> X_WB_;
  std::set<std::string> taken_;
  std::set<std::uint32_t> bare_;
  std::vector<MjcfSide> sides_, floors_;
  std::map<std::uint32_t, std::vector<Eigen::Vector3d>> hulls_;
};

}  // namespace

ImportedWorld import_mjcf(const ImportInput& input) {
  ImportedWorld world;
  if (!reads_mjcf()) {
    world.fault = TextFault{0, "this build reads no MJCF"};
    return world;
  }
  MjcfText text = vetted_mjcf(input);
  world.files = text.read;
  world.absent = text.absent;
  world.fault = text.fault;
  if (world.fault) return world;
  const MjcfModel model = read_mjcf(text.files, input.stop);
  MjcfImporter(input, text, model, world).run();
  if (!world.fault) {
    world.left_out.insert(world.left_out.end(), text.left_out.begin(), text.left_out.end());
  }
  return world;
}

}  // namespace parallax::harness
