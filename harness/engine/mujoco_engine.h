#pragma once

#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "harness/engine/engine_module.h"
#include "harness/engine/mujoco_world.h"

// The engine's own types, as its headers name them; only mujoco_*.cc sees more of them.
struct mjModel_;
struct mjData_;

namespace parallax::harness {

/// An error of the engine, with its message.
class EngineFault : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct ModelDeleter {
  void operator()(mjModel_* model) const;
};
struct DataDeleter {
  void operator()(mjData_* data) const;
};

/// The degrees of freedom of a joint: of a gantry its three slides and its turn.
struct JointPlace {
  int q = 0, v = 0;  // first place in the positions, in the velocities
};

/// Names of the parts that the engine is given, by index.
std::string link_name(std::size_t link);
std::string joint_name(std::size_t link, int part);
std::string geom_name(std::size_t geom);
inline constexpr const char* kFloorName = "floor";
std::string hull_name(std::size_t hull);  // of its mesh, and of the probe of that form
std::string probe_name(ShapeForm form);

/// The world in the engine's own language, MJCF, and its shapes by number; number 0 is the floor.
struct WorldText {
  std::string text;
  std::vector<BodyId> geom_bodies;                       // by geom_name, from 1
  std::vector<std::optional<std::size_t>> geom_hulls;    // likewise; none: it is not one
  std::vector<std::shared_ptr<const ConvexHull>> hulls;  // by hull_name
};
WorldText write_mjcf(const EngineInput& input);

/// The size as the engine takes it: half sides, or radius and half the length.
Eigen::Vector3d engine_size_m(ShapeForm form, const Eigen::Vector3d& size_m);

/// A hull, and its probe. The engine lays the frame of a mesh along its moments of inertia.
struct MeshHull {
  std::shared_ptr<const ConvexHull> hull;
  int probe = -1;
  Eigen::Vector3d p_HG = Eigen::Vector3d::Zero();  // the engine's frame in that of the hull [m]
  Eigen::Matrix3d R_HG = Eigen::Matrix3d::Identity();
};

/// The state behind MujocoWorld. The frame of a link is that of the tree.
struct MujocoWorld::Engine final : EngineState {
  LinkTree tree;
  std::unique_ptr<mjModel_, ModelDeleter> model;
  std::unique_ptr<mjData_, DataDeleter> data;
  std::vector<int> bodies;                        // by LinkId: the engine's number
  std::vector<JointPlace> joints;                 // by LinkId
  std::vector<LinkId> sliders, hinges, gantries;  // by SliderId, ...: what they move
  std::vector<const ContactSide*> sides;          // by the engine's number of a geom; null: probe
  std::vector<int> probes;                        // by ShapeForm, but for hulls
  std::vector<MeshHull> hulls;
  std::vector<const MeshHull*> hull_of;        // by the engine's number of a geom; null: none
  std::vector<double> targets;                 // by degree of freedom: the motor's velocity
  std::vector<Eigen::Vector3d> moments_kg_m2;  // by LinkId: principal, of the specified mass
  std::vector<double> preloads_m;              // by GantryId: of its spring; 0: it has none
  std::vector<double> asked_m_s2, lost_m_s2;   // by row of constraints: of solve_friction
  bool is_broken = false;                      // the engine gave up: lost until the next reset

  explicit Engine(const EngineInput& input)
      : EngineState(input.spec, input.layout), tree(input.tree) {
    in_link = tree.in_link;
  }
};

/// Reads the world and finds everything in it again. EngineFault where the engine refuses it.
void build_engine(MujocoWorld::Engine& engine, const EngineInput& input);

/// Where boxes and hulls touch each other is found by contacts_of and hull_contacts from here on,
/// in this process: of boxes that lie flat on each other but for a rounding, MuJoCo 2.2.2 leaves
/// out corners, gives half the depth, and points that are deep in nothing; hulls it has on few
/// points.
void replace_collisions();

/// Finds contacts as bodies stand, and leaves those of pairs that may touch, with their friction.
void find_contacts(MujocoWorld::Engine& engine);

/// Solves the forces of a step, in place of mj_fwdConstraint. Sliding contacts do not come apart by
/// it.
void solve_friction(MujocoWorld::Engine& engine);

/// Records the touches of free bodies among the contacts that were found.
void note_touches(MujocoWorld::Engine& engine);

/// The deepest of the contacts that were found.
std::optional<Overlap> deepest_contact(const MujocoWorld::Engine& engine);

}  // namespace parallax::harness
