#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "harness/import/import.h"

namespace parallax::harness {

// The common result of the readers of all formats: links and joints of one world, with full poses.

struct LinkShape {
  ShapeForm form = ShapeForm::kBox;
  Eigen::Vector3d size_m = Eigen::Vector3d::Zero();
  Eigen::Isometry3d X_LS = Eigen::Isometry3d::Identity();
  std::optional<double> friction;
  std::optional<MeshUse> mesh = {};           // then form and size say nothing
  std::vector<Eigen::Vector3d> corners = {};  // of kHull, in its frame
};

struct LinkDescription {
  std::string name;
  Eigen::Isometry3d X_WL = Eigen::Isometry3d::Identity();
  double mass_kg = 0.0;                                    // 0: no inertia is given
  Eigen::Isometry3d X_LC = Eigen::Isometry3d::Identity();  // centre of mass and its axes
  Eigen::Matrix3d I_C_kg_m2 = Eigen::Matrix3d::Zero();     // along these axes
  std::vector<LinkShape> shapes;
  bool has_own_inertia = true;  // false: that of the shapes counts
  bool is_static = false;
  bool has_floor = false;  // what it has besides shapes
  std::string apart;       // BodySpec::apart
  std::size_t offset = 0;
};

struct JointDescription {
  std::string name;
  JointType type = JointType::kFixed;
  std::string parent;  // link, or empty for the world
  std::string child;
  Eigen::Vector3d axis_W = Eigen::Vector3d::UnitX(), p_WA = Eigen::Vector3d::Zero();
  double low = 0.0, high = 0.0;  // beyond the bounds that can be expressed: none
  double damping = 0.0, friction = 0.0;
  /// A joint that it follows: its position is `ratio` times the leader's, plus `shift`.
  std::string leader = {};
  double ratio = 1.0, shift = 0.0;
  std::size_t offset = 0;
};

/// Collects what is left out, by kind, in the order of the first of each.
class LeftOutList {
 public:
  void add(const std::string& what, const std::string& name, std::size_t offset);
  std::vector<LeftOut> take() { return std::move(kinds_); }

 private:
  std::vector<LeftOut> kinds_;
};

struct Description {
  std::vector<LinkDescription> links;
  std::vector<JointDescription> joints;
  std::optional<double> floor_friction;  // of a plane that is the floor
  bool has_floor = false;
  LeftOutList left_out;
};

/// Adds the shape of a mesh, or says that it is left out.
void add_mesh(const ImportInput& input, const std::string& uri, const std::string& from,
              const Eigen::Vector3d& scale, LinkShape shape, LinkDescription& link,
              LeftOutList& left_out);

/// Makes bodies and joints of the scenario's kinds: links without mass become part of the link that
/// they are fixed to, joints stand within their stops (fitting.h), body frames stand upright at the
/// default placement, and friction goes by materials.
void assemble(Description description, const ImportInput& input, ImportedWorld& world);

/// A name that keys and variables can have: letters, digits and `_`; "::" becomes one `_`.
std::string plain_name(const std::string& name);

/// The places where links, joints and models of these names begin in the text.
class NamePlaces {
 public:
  explicit NamePlaces(const XmlOutline& outline);
  /// 0 where it is not in this file.
  std::size_t of(const std::string& tag, const std::string& name) const;
  /// The first of the names in quotes or `[]` of a library's message that stands in the text.
  std::size_t of_message(const std::string& message) const;

 private:
  std::map<std::string, std::size_t> by_tag_, by_name_;
};

}  // namespace parallax::harness
