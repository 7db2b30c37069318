#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "harness/world/ode_world.h"

// The engine's own types, as its headers name them; only ode_*.cc sees more of them.
struct dxWorld;
struct dxSpace;
struct dxBody;
struct dxJoint;
struct dxJointGroup;
struct dxThreadingImplementation;

namespace parallax::harness {

enum class ContactRole : std::uint8_t { kWorld, kFree, kNearPad, kFarPad, kOtherPart };

/// What the collision callback knows of a geom.
struct GeomInfo {
  std::optional<BodyId> body;  // none: the floor
  std::uint32_t assembly = 0;
  std::uint32_t material = 0;
  ContactRole role = ContactRole::kWorld;
};

/// Pose of body B in its link L (in the world for a static body).
struct BodyInLink {
  Eigen::Vector3d p_LB = Eigen::Vector3d::Zero();
  Eigen::Matrix3d R_LB = Eigen::Matrix3d::Identity();
};

/// Everything behind OdeWorld.
struct OdeWorld::Engine {
  WorldLayout layout;
  SolverSpec solver;
  dxWorld* world = nullptr;
  dxThreadingImplementation* threading = nullptr;
  dxSpace* static_space = nullptr;
  dxSpace* movable_space = nullptr;
  dxJointGroup* contact_group = nullptr;
  std::vector<dxBody*> links;       // by LinkId
  std::vector<bool> never_sleeps;   // by LinkId: parts of the robot
  std::vector<dxJoint*> sliders;    // by SliderId
  std::vector<BodyInLink> in_link;  // by BodyId
  std::vector<GeomInfo> geoms;      // never grows after building: geoms point into it
  std::uint32_t material_count = 0;
  std::vector<double> friction;  // (material_count x material_count)
  std::vector<Touch> touches;    // by BodyId
  std::uint64_t digest = 0;
  bool measure_times = false;
  StepStatistics statistics;
};

/// Creates everything from the layout, in its order. One use per engine.
class OdeBuilder {
 public:
  OdeBuilder(const WorldSpec& spec, OdeWorld::Engine& engine);
  void build();

 private:
  void create_world();
  void create_links();
  void create_geoms();
  void create_box(const BoxShape& shape, BodyId id, GeomInfo& info);
  void create_sliders();
  void collect_friction();
  std::uint32_t material_index(const std::string& name) const;
  GeomInfo info_for(BodyId id) const;

  const WorldSpec& spec_;
  OdeWorld::Engine& engine_;
  std::vector<std::string> materials_;  // sorted
};

/// Collision pass: makes contact joints for the next step and records what touches free bodies.
void make_contacts(OdeWorld::Engine& engine);

/// Collision pass that makes nothing: the deepest pair, if any touches.
std::optional<Overlap> find_deepest_overlap(OdeWorld::Engine& engine);

}  // namespace parallax::harness
