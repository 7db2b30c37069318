// The only place of liburdfdom.

#include "harness/import/description.h"

#ifndef PARALLAX_HAS_URDFDOM

namespace parallax::harness {

bool reads_urdf() { return false; }
ImportedWorld import_urdf(const ImportInput& /*input*/) {
  ImportedWorld world;
  world.fault = TextFault{0, "this build reads no URDF"};
  return world;
}

}  // namespace parallax::harness

#else

#include <console_bridge/console.h>
#include <fmt/format.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <limits>

#include "harness/import/urdf_tree.h"
#include "harness/import/xml_census.h"

namespace parallax::harness {
namespace {

/// Keeps what the library says; the first of it is why a file is refused.
class KeptMessages : public console_bridge::OutputHandler {
 public:
  KeptMessages() { console_bridge::useOutputHandler(this); }
  ~KeptMessages() override { console_bridge::restorePreviousOutputHandler(); }
  KeptMessages(const KeptMessages&) = delete;
  KeptMessages& operator=(const KeptMessages&) = delete;

  void log(const std::string& text, console_bridge::LogLevel level, const char* /*file*/,
           int /*line*/) override {
    if (level == console_bridge::CONSOLE_BRIDGE_LOG_ERROR && first_.empty()) first_ = text;
  }
  const std::string& first() const { return first_; }

 private:
  std::string first_;
};

Eigen::Isometry3d isometry_from(const urdf::Pose& pose) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.translation() = Eigen::Vector3d(pose.position.x, pose.position.y, pose.position.z);
  const auto& q = pose.rotation;
  X.linear() = Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized().toRotationMatrix();
  return X;
}

constexpr TakenOf kTaken[] = {
    {"robot", "name version", "", "link joint", "material"},
    {"link", "name", "inertial", "collision", "visual"},
    {"inertial", "", "origin mass inertia"},
    {"origin", "xyz rpy"},
    {"mass", "value"},
    {"inertia", "ixx ixy ixz iyy iyz izz"},
    {"collision", "name", "origin geometry"},
    {"geometry", "", "box sphere cylinder mesh"},
    {"box", "size"},
    {"sphere", "radius"},
    {"cylinder", "radius length"},
    {"mesh", "filename scale"},
    {"joint", "name type", "parent child origin axis limit dynamics mimic"},
    {"mimic", "joint multiplier offset"},
    {"parent", "link"},
    {"child", "link"},
    {"axis", "xyz"},
    {"limit", "lower upper effort velocity"},
    {"dynamics", "damping friction"},
};

class UrdfReader {
 public:
  UrdfReader(const ImportInput& input, const XmlOutline& outline, ImportedWorld& world)
      : input_(input), outline_(outline), places_(outline), world_(world) {}

  void run() {
    urdf::ModelInterfaceSharedPtr model;
    std::string message;
    {
      const KeptMessages messages;
      model = urdf::parseURDF(input_.text);
      message = messages.first();
    }
    if (model == nullptr || !model->getRoot()) {
      std::replace(message.begin(), message.end(), '\n', ' ');
      world_.fault = TextFault{places_.of_message(message),
                               message.empty() ? "is no robot description" : message};
      return;
    }
    Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
    X.translation() = input_.p_WI;
    X.linear() = Eigen::AngleAxisd(input_.yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    const urdf::Link& root = *model->getRoot();
    read_link(root, X, plain_name(model->getName()));
    if (!is_world(root) && input_.fixed) fix(root.name);
    note_rest();
    assemble(std::move(out_), input_, world_);
  }

 private:
  /// A root of this name and nothing in it stands for the world.
  static bool is_world(const urdf::Link& link) {
    return link.name == "world" && !link.inertial && link.collision_array.empty();
  }

  void fix(const std::string& link) {
    JointDescription joint;
    joint.name = "fixed_to_world";
    joint.child = link;
    out_.joints.push_back(std::move(joint));
  }

  // A tree no deeper than it is wide: as many links as the text has elements.
  void read_link(const urdf::Link& root, const Eigen::Isometry3d& X_root,
                 const std::string& robot) {
    struct Open {
      const urdf::Link* link;
      Eigen::Isometry3d X_WL;
    };
    std::vector<Open> open = {{&root, X_root}};
    while (!open.empty()) {
      const Open at = open.back();
      open.pop_back();
      const bool world = at.link == &root && is_world(root);
      if (!world) add_link(*at.link, at.X_WL, robot);
      for (const auto& joint : at.link->child_joints) {
        const auto found =
            std::find_if(at.link->child_links.begin(), at.link->child_links.end(),
                         [&](const auto& child) { return child->name == joint->child_link_name; });
        if (found == at.link->child_links.end()) continue;
        const Eigen::Isometry3d X_WC =
            at.X_WL * isometry_from(joint->parent_to_joint_origin_transform);
        add_joint(*joint, world ? std::string() : at.link->name, X_WC);
        open.push_back({found->get(), X_WC});
      }
    }
  }

  void add_link(const urdf::Link& link, const Eigen::Isometry3d& X_WL, const std::string& robot) {
    LinkDescription one;
    one.name = link.name;
    one.offset = places_.of("link", link.name);
    one.X_WL = X_WL;
    one.apart = robot.empty() ? "robot_description" : robot;
    if (link.inertial) {
      const urdf::Inertial& inertial = *link.inertial;
      one.mass_kg = inertial.mass;
      one.X_LC = isometry_from(inertial.origin);
      one.I_C_kg_m2 << inertial.ixx, inertial.ixy, inertial.ixz, inertial.ixy, inertial.iyy,
          inertial.iyz, inertial.ixz, inertial.iyz, inertial.izz;
    }
    for (std::size_t i = 0; i < link.visual_array.size(); ++i) {
      out_.left_out.add("visuals", link.name, one.offset);
    }
    for (const auto& collision : link.collision_array) add_shape(*collision, one);
    out_.links.push_back(std::move(one));
  }

  void add_shape(const urdf::Collision& collision, LinkDescription& link) {
    LinkShape shape;
    shape.X_LS = isometry_from(collision.origin);
    const urdf::Geometry* geometry = collision.geometry.get();
    if (const auto* box = dynamic_cast<const urdf::Box*>(geometry)) {
      shape.size_m = Eigen::Vector3d(box->dim.x, box->dim.y, box->dim.z);
    } else if (const auto* sphere = dynamic_cast<const urdf::Sphere*>(geometry)) {
      shape.form = ShapeForm::kSphere;
      shape.size_m = Eigen::Vector3d::Constant(2.0 * sphere->radius);
    } else if (const auto* cylinder = dynamic_cast<const urdf::Cylinder*>(geometry)) {
      shape.form = ShapeForm::kCylinder;
      const double across_m = 2.0 * cylinder->radius;
      shape.size_m = Eigen::Vector3d(across_m, across_m, cylinder->length);
    } else if (const auto* mesh = dynamic_cast<const urdf::Mesh*>(geometry)) {
      const Eigen::Vector3d scale(mesh->scale.x, mesh->scale.y, mesh->scale.z);
      return add_mesh(input_, mesh->filename, {}, scale, std::move(shape), link, out_.left_out);
    } else {
      return out_.left_out.add("collisions of other forms", link.name, link.offset);
    }
    link.shapes.push_back(shape);
  }

  void add_joint(const urdf::Joint& joint, const std::string& parent,
                 const Eigen::Isometry3d& X_WC) {
    JointDescription one;
    one.name = joint.name;
    one.offset = places_.of("joint", joint.name);
    one.parent = parent;
    one.child = joint.child_link_name;
    one.p_WA = X_WC.translation();
    one.axis_W = X_WC.linear() * Eigen::Vector3d(joint.axis.x, joint.axis.y, joint.axis.z);
    one.high = std::numeric_limits<double>::infinity();
    one.low = -one.high;
    if (joint.type == urdf::Joint::FLOATING) return;  // free
    if (joint.type == urdf::Joint::REVOLUTE || joint.type == urdf::Joint::CONTINUOUS) {
      one.type = JointType::kHinge;
    } else if (joint.type == urdf::Joint::PRISMATIC) {
      one.type = JointType::kSlider;
    } else if (joint.type != urdf::Joint::FIXED) {
      out_.left_out.add("joints of other types (held fast)", joint.name, one.offset);
    }
    if (one.type != JointType::kFixed) {
      if (joint.limits && joint.type != urdf::Joint::CONTINUOUS) {
        one.low = joint.limits->lower;
        one.high = joint.limits->upper;
      }
      if (joint.limits && joint.limits->effort > 0.0) {
        out_.left_out.add("limits of effort (nothing drives an imported joint)", joint.name,
                          one.offset);
      }
      if (joint.limits && joint.limits->velocity > 0.0) {
        out_.left_out.add("limits of velocity", joint.name, one.offset);
      }
      if (joint.dynamics) {
        one.damping = joint.dynamics->damping;
        one.friction = joint.dynamics->friction;
      }
      if (joint.mimic) {
        one.leader = joint.mimic->joint_name;
        one.ratio = joint.mimic->multiplier;
        one.shift = joint.mimic->offset;
      }
    }
    out_.joints.push_back(std::move(one));
  }

  void note_rest() { list_rest(outline_, kTaken, {}, out_.left_out); }

  const ImportInput& input_;
  const XmlOutline& outline_;
  NamePlaces places_;
  ImportedWorld& world_;
  Description out_;
};

}  // namespace

bool reads_urdf() { return true; }

ImportedWorld import_urdf(const ImportInput& input) {
  ImportedWorld world;
  const XmlOutline outline = outline_of(input.text);
  world.fault = outline.fault ? outline.fault : tree_fault(outline);
  if (world.fault) return world;
  UrdfReader(input, outline, world).run();
  return world;
}

}  // namespace parallax::harness

#endif
