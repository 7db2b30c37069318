#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <map>

#include "compiler/base/word_table.h"
#include "harness/engine/mujoco_engine.h"
#include "harness/world/shapes.h"

namespace parallax::harness {
namespace {

/// MuJoCo's impedance of contacts and stops, shallow and deep, and the depth at which it is deep
/// [m].
constexpr double kShallow = 0.95, kDeep = 0.99, kDeepFrom_m = 0.001;
/// The stiffness of friction in a contact relative to that of pressure: held bodies creep the less.
constexpr double kFrictionStiffness = 100.0;
/// Motors are as rigid as the engine allows.
constexpr double kRigid = 0.9999;

std::string numbers(const Eigen::Vector3d& v) {
  return fmt::format("{:.17g} {:.17g} {:.17g}", v.x(), v.y(), v.z());
}

std::string quaternion(const Eigen::Matrix3d& R) {
  const Eigen::Quaterniond q(R);
  return fmt::format("{:.17g} {:.17g} {:.17g} {:.17g}", q.w(), q.x(), q.y(), q.z());
}

constexpr auto kShapeFormWords =
    base::word_table<ShapeForm>("box", "sphere", "cylinder", "capsule", "mesh");

class TextWriter {
 public:
  explicit TextWriter(const EngineInput& input)
      : input_(input), layout_(input.layout), tree_(input.tree) {
    children_.resize(tree_.links.size() + 1);
    for (const LinkId id : tree_.order) {
      const auto& parent = tree_.links[id].parent;
      children_[parent ? parent->index() + 1 : 0].push_back(id);
    }
    for (const BodySpec& body : layout_.bodies) {
      for (const BodyShape& shape : body.shapes) {
        if (shape.hull && !hull_number(shape.hull.get())) hulls_.push_back(shape.hull);
      }
    }
  }

  WorldText write() {
    write_options();
    write_hulls();
    out_ += "<worldbody>\n";
    out_ += fmt::format("<geom name='{}' type='plane' size='0 0 1'/>\n", kFloorName);
    for (const ShapeForm form :
         {ShapeForm::kBox, ShapeForm::kSphere, ShapeForm::kCylinder, ShapeForm::kCapsule}) {
      out_ += fmt::format("<geom name='{}' type='{}' size='1 1 1' contype='0' conaffinity='0'/>\n",
                          probe_name(form), kShapeFormWords.of(form));
    }
    for (std::size_t i = 0; i < hulls_.size(); ++i) {
      out_ += fmt::format("<geom name='{0}' type='mesh' mesh='{0}' contype='0' conaffinity='0'/>\n",
                          hull_name(i));
    }
    for (std::size_t i = 0; i < layout_.bodies.size(); ++i) {
      if (!layout_.link_of[i]) write_geoms(layout_.bodies.id_at(i));
    }
    for (const LinkId child : children_[0]) write_link(child);
    out_ += "</worldbody>\n";
    write_exclusions();
    write_followers();
    out_ += "</mujoco>\n";
    return {std::move(out_), std::move(geom_bodies_), std::move(geom_hulls_), std::move(hulls_)};
  }

 private:
  std::optional<std::size_t> hull_number(const ConvexHull* hull) const {
    for (std::size_t i = 0; i < hulls_.size(); ++i) {
      if (hulls_[i].get() == hull) return i;
    }
    return std::nullopt;
  }

  /// The engine makes their faces itself.
  void write_hulls() {
    out_ += "<asset>\n";
    for (std::size_t i = 0; i < hulls_.size(); ++i) {
      out_ += fmt::format("<mesh name='{}' vertex='", hull_name(i));
      for (const Eigen::Vector3d& vertex : hulls_[i]->vertices) out_ += numbers(vertex) + " ";
      out_ += "'/>\n";
    }
    out_ += "</asset>\n";
  }

  void write_options() {
    const SolverSpec& solver = input_.spec.solver;
    const std::string impedance = fmt::format("{} {} {} 0.5 2", kShallow, kDeep, kDeepFrom_m);
    out_ += fmt::format(
        "<mujoco model='world'>\n"
        "<compiler angle='radian' inertiafromgeom='false' boundmass='0' boundinertia='0'/>\n"
        "<option timestep='{:.17g}' gravity='0 0 {:.17g}' integrator='Euler' cone='elliptic' "
        "solver='Newton' iterations='100' tolerance='1e-10' impratio='{}'>\n"
        "<flag multiccd='enable' filterparent='disable'/></option>\n",
        solver.timestep_s, solver.gravity_m_s2, kFrictionStiffness);
    const std::size_t contacts = most_contacts();
    out_ += fmt::format("<size nconmax='{}' njmax='{}'/>\n", contacts,
                        3 * contacts + 20 * tree_.links.size());
    out_ += fmt::format(
        "<default><geom solimp='{0}'/><joint solimplimit='{0}' "
        "solreflimit='{1:.17g} 1' solreffriction='{2:.17g} 1' "
        "solimpfriction='{3} {3} 1 0.5 2'/></default>\n",
        impedance, solver.timestep_s / solver.erp, 2.0 * solver.timestep_s, kRigid);
  }

  /// Room for all shapes that move to lie on several others.
  std::size_t most_contacts() const {
    std::size_t moving = 0;
    for (std::size_t i = 0; i < layout_.bodies.size(); ++i) {
      const BodySpec& body = layout_.bodies[layout_.bodies.id_at(i)];
      if (layout_.link_of[i] && body.collides) moving += body.shapes.size();
    }
    return std::min<std::size_t>(64 + 8 * moving, 512);
  }

  void write_link(LinkId id) {
    const TreeLink& link = tree_.links[id];
    const Pose at = pose_in_parent(link);
    out_ += fmt::format("<body name='{}' pos='{}' quat='{}'>\n", link_name(id.index()),
                        numbers(at.p), quaternion(at.R));
    const Eigen::Matrix3d& I = link.I_C_kg_m2;
    out_ += fmt::format(
        "<inertial pos='{}' mass='{:.17g}' fullinertia='{} {:.17g} {:.17g} {:.17g}'/>\n",
        numbers(link.p_LC), link.mass_kg, numbers(I.diagonal()), I(0, 1), I(0, 2), I(1, 2));
    write_joint(id, link, at.R);
    for (const BodyId body : layout_.links[id].members) write_geoms(body);
    for (const LinkId child : children_[id.index() + 1]) write_link(child);
    out_ += "</body>\n";
  }

  struct Pose {
    Eigen::Vector3d p = Eigen::Vector3d::Zero();
    Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  };
  Pose in_world(const TreeLink& link) const {
    const BodySpec& body = layout_.bodies[link.frame];
    return {body.p_WB,
            Eigen::AngleAxisd(body.yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix()};
  }
  Pose pose_in_parent(const TreeLink& link) const {
    const Pose child = in_world(link);
    if (!link.parent) return child;
    const Pose parent = in_world(tree_.links[*link.parent]);
    return {parent.R.transpose() * (child.p - parent.p), parent.R.transpose() * child.R};
  }

  void write_joint(LinkId id, const TreeLink& link, const Eigen::Matrix3d& R_PL) {
    switch (link.joint) {
      case LinkJoint::kFree:
        out_ += fmt::format("<freejoint name='{}'/>\n", joint_name(id.index(), 0));
        return;
      case LinkJoint::kSlider: {
        const JointSpec& spec = layout_.sliders[layout_.sliders.id_at(link.joint_index)];
        write_axis(id, 0, "slide", axis_in_link(link, spec), Eigen::Vector3d::Zero(), spec.low_m,
                   spec.high_m, spec.damping_n_s_m);
        return;
      }
      case LinkJoint::kHinge: {
        const JointSpec& spec = layout_.hinges[layout_.hinges.id_at(link.joint_index)];
        const Pose at = in_world(link);
        write_axis(id, 0, "hinge", axis_in_link(link, spec), at.R.transpose() * (spec.p_WA - at.p),
                   spec.low_rad, spec.high_rad, spec.damping_nm_s);
        return;
      }
      case LinkJoint::kGantry:
        write_gantry(id, link, R_PL);
        return;
    }
  }

  /// It slides along the parent's axes and turns about its centre of mass; if it has springs, its
  /// height and its lean are theirs.
  void write_gantry(LinkId id, const TreeLink& link, const Eigen::Matrix3d& R_PL) {
    const auto& springs = layout_.gantries[layout_.gantries.id_at(link.joint_index)].suspension;
    for (int axis = 0; axis < 3; ++axis) {
      const bool sprung = springs && axis == 2;
      write_axis(id, axis, "slide", R_PL.transpose().col(axis), Eigen::Vector3d::Zero(), {}, {},
                 sprung ? springs->damping_n_s_m : 0.0, sprung ? springs->stiffness_n_m : 0.0);
    }
    write_axis(id, 3, "hinge", Eigen::Vector3d::UnitZ(), link.p_LC, {}, {}, 0.0);
    if (!springs) return;
    for (const int part : {4, 5}) {
      write_axis(id, part, "hinge", part == 4 ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitX(),
                 link.p_LC, {}, {}, springs->damping_nm_s, springs->stiffness_nm_rad);
    }
  }

  Eigen::Vector3d axis_in_link(const TreeLink& link, const JointSpec& spec) const {
    return in_world(link).R.transpose() * spec.axis_W.normalized();
  }

  /// The engine takes dampers at the end of a step and springs at its beginning; what the first
  /// adds to the second is the force at the end of the step, too, so that stiff springs do not
  /// swing up.
  void write_axis(LinkId id, int part, const char* type, const Eigen::Vector3d& axis,
                  const Eigen::Vector3d& at, const std::optional<double>& low,
                  const std::optional<double>& high, double damping, double stiffness = 0.0) {
    constexpr double kNever = 1e6;  // a stop that is not there
    out_ += fmt::format(
        "<joint name='{}' type='{}' axis='{}' pos='{}' damping='{:.17g}' stiffness='{:.17g}'",
        joint_name(id.index(), part), type, numbers(axis), numbers(at),
        damping + input_.spec.solver.timestep_s * stiffness, stiffness);
    if (low || high) {
      out_ += fmt::format(" limited='true' range='{:.17g} {:.17g}'", low.value_or(-kNever),
                          high.value_or(kNever));
    }
    out_ += "/>\n";
  }

  void write_followers() {
    std::map<std::string, std::string> names;  // of the engine, by our own
    for (std::size_t i = 0; i < tree_.links.size(); ++i) {
      names[tree_.links[tree_.links.id_at(i)].joint_name] = joint_name(i, 0);
    }
    out_ += "<equality>\n";
    const auto write = [&](const JointSpec& spec) {
      if (!spec.follows) return;
      out_ += fmt::format(
          "<joint joint1='{0}' joint2='{1}' polycoef='0 {2:.17g} 0 0 0' solref='{3:.17g} 1' "
          "solimp='{4} {4} 1 0.5 2'/>\n",
          names.at(spec.name), names.at(spec.follows->leader), spec.follows->ratio,
          2.0 * input_.spec.solver.timestep_s, kRigid);
    };
    for (const JointSpec& spec : layout_.sliders) write(spec);
    for (const JointSpec& spec : layout_.hinges) write(spec);
    out_ += "</equality>\n";
  }

  /// Excludes pairs of links that hang together from collision altogether. Other pairs that never
  /// touch are left out among the contacts (find_contacts).
  void write_exclusions() {
    out_ += "<contact>\n";
    const auto assembly = [&](std::size_t link) {
      return layout_.assembly_of[tree_.links[tree_.links.id_at(link)].frame.index()];
    };
    for (std::size_t a = 0; a < tree_.links.size(); ++a) {
      for (std::size_t b = a + 1; b < tree_.links.size(); ++b) {
        if (assembly(a) == 0 || assembly(a) != assembly(b)) continue;
        out_ += fmt::format("<exclude body1='{}' body2='{}'/>\n", link_name(a), link_name(b));
      }
    }
    out_ += "</contact>\n";
  }

  void write_geoms(BodyId id) {
    const BodySpec& body = layout_.bodies[id];
    if (!body.collides) return;
    const PoseInLink& place = tree_.in_link[id.index()];
    for (const BodyShape& shape : body.shapes) {
      geom_bodies_.push_back(id);
      geom_hulls_.push_back(hull_number(shape.hull.get()));
      const std::string form =
          shape.hull ? fmt::format("mesh='{}'", hull_name(*geom_hulls_.back()))
                     : fmt::format("size='{}'", numbers(engine_size_m(shape.form, shape.size_m)));
      out_ += fmt::format("<geom name='{}' type='{}' {} pos='{}' quat='{}'/>\n",
                          geom_name(geom_bodies_.size()), kShapeFormWords.of(shape.form), form,
                          numbers(place.p_LB + place.R_LB * shape.p_BS),
                          quaternion(place.R_LB * shape_rotation(shape)));
    }
  }

  const EngineInput& input_;
  const WorldLayout& layout_;
  const LinkTree& tree_;
  std::vector<std::vector<LinkId>> children_;  // of the world, then by LinkId
  std::string out_;
  std::vector<BodyId> geom_bodies_;
  std::vector<std::optional<std::size_t>> geom_hulls_;
  std::vector<std::shared_ptr<const ConvexHull>> hulls_;
};

}  // namespace

std::string link_name(std::size_t link) { return fmt::format("link{}", link); }
std::string joint_name(std::size_t link, int part) { return fmt::format("joint{}.{}", link, part); }
std::string geom_name(std::size_t geom) { return fmt::format("geom{}", geom); }
std::string hull_name(std::size_t hull) { return fmt::format("hull{}", hull); }
std::string probe_name(ShapeForm form) { return fmt::format("probe-{}", kShapeFormWords.of(form)); }

Eigen::Vector3d engine_size_m(ShapeForm form, const Eigen::Vector3d& size_m) {
  const double radius_m = 0.5 * size_m.x();
  switch (form) {
    case ShapeForm::kBox:
    case ShapeForm::kHull:
      break;
    case ShapeForm::kSphere:
      return {radius_m, radius_m, radius_m};
    case ShapeForm::kCylinder:
      return {radius_m, 0.5 * size_m.z(), radius_m};
    case ShapeForm::kCapsule:
      // A hair of a rod is left to one that is all caps: the engine knows none without.
      return {radius_m, std::max(0.5 * (size_m.z() - size_m.x()), 1e-9), radius_m};
  }
  return 0.5 * size_m;
}

WorldText write_mjcf(const EngineInput& input) { return TextWriter(input).write(); }

}  // namespace parallax::harness
