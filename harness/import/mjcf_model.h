#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace parallax::harness {

// The model that MuJoCo's compiler makes of an MJCF file, as data that goes from the process that
// reads it to this one. Numbers index the lists; body 0 is the world.

/// A frame in that of the parent, or of the body.
struct MjcfFrame {
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  Eigen::Vector4d wxyz = Eigen::Vector4d::UnitX();
};

struct MjcfBody {
  std::string name;  // may be empty, as those of joints and geoms
  std::uint32_t parent = 0;
  bool is_static = false;  // welded to the world
  MjcfFrame frame;         // as the joints stand by default
  double mass_kg = 0.0;
  MjcfFrame centre;  // of mass, along the principal axes
  Eigen::Vector3d moments_kg_m2 = Eigen::Vector3d::Zero();
};

enum class MjcfJointType : std::uint8_t { kFree, kBall, kSlide, kHinge };

struct MjcfJoint {
  std::string name;
  std::uint32_t body = 0;
  MjcfJointType type = MjcfJointType::kFree;
  Eigen::Vector3d p_BJ = Eigen::Vector3d::Zero(), axis_B = Eigen::Vector3d::UnitZ();
  bool is_limited = false;
  double low = 0.0, high = 0.0;  // from where it stands by default
  double damping = 0.0, friction = 0.0, stiffness = 0.0, armature = 0.0;
  bool is_soft = false;     // solver parameters of its own
  bool has_margin = false;  // its stops act before they are met
};

enum class MjcfForm : std::uint8_t {
  kPlane,
  kHeightField,
  kSphere,
  kCapsule,
  kEllipsoid,
  kCylinder,
  kBox,
  kMesh
};

struct MjcfGeom {
  std::string name;
  std::uint32_t body = 0;
  MjcfForm form = MjcfForm::kSphere;
  Eigen::Vector3d size = Eigen::Vector3d::Zero();  // as the format has it: halves
  MjcfFrame frame;
  std::uint32_t mesh = 0;                               // of kMesh
  std::int32_t contact_type = 0, contact_affinity = 0;  // bits
  std::int32_t dimension = 3;                           // of contacts
  double friction = 0.0;
  bool has_priority = false, has_margin = false, is_soft = false;
};

/// Empty but for those that something collides with.
struct MjcfMesh {
  std::string name;
  std::vector<float> points;         // x, y, z of each
  std::vector<std::uint32_t> faces;  // three numbers of points for each
};

/// Elements of a kind that is not taken over.
struct MjcfRest {
  std::string kind;  // "sensors"
  std::string tag;   // of its first element, or its section
  std::size_t count = 0;
  std::string first;
  std::uint32_t body = 0;  // its number, where the tag is that of a body
};

struct MjcfModel {
  std::optional<std::string> fault;  // in the words of the reader; then the rest says nothing
  std::uint64_t fault_line = 0;      // 0: it names none
  std::string fault_tag;             // of the element there, if it says so
  Eigen::Vector3d gravity_m_s2 = Eigen::Vector3d::Zero();
  bool filters_parents = true;  // a body does not collide with its parent
  bool has_contacts = true;     // else nothing collides with anything
  std::vector<MjcfBody> bodies;
  std::vector<MjcfJoint> joints;
  std::vector<MjcfGeom> geoms;
  std::vector<MjcfMesh> meshes;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> excluded;  // bodies
  std::vector<MjcfRest> rest;
};

inline constexpr std::size_t kMaxMjcfAnswer = std::size_t{128} << 20U;

std::string bytes_of(const MjcfModel& model);

/// None where the bytes are not such a model, say because what wrote them was led astray. What is
/// named by number is there, and parents come before their children.
std::optional<MjcfModel> model_of(const std::string& bytes);

/// Is all that is said of it a number? Files can say `inf`.
bool has_numbers(const MjcfBody& body);
bool has_numbers(const MjcfJoint& joint);
bool has_numbers(const MjcfGeom& geom);

}  // namespace parallax::harness
