#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/engine/ode_world.h"

// The engine's own types, as its headers name them; only ode_*.cc sees more of them.
struct dxWorld;
struct dxSpace;
struct dxBody;
struct dxJoint;
struct dxJointGroup;
struct dxGeom;
struct dxTriMeshData;
struct dxThreadingImplementation;

namespace parallax::harness {

/// The data of a geom for the collision callback.
struct GeomInfo {
  ContactSide side;
  std::optional<LinkId> link;  // none: it never moves
  const ConvexHull* hull = nullptr;
};

/// A gantry: linear motors along the parent's axes, angular ones about the world's.
struct Gantry {
  dxJoint* linear = nullptr;
  dxJoint* angular = nullptr;
  dxBody* parent = nullptr;  // null: the world
  dxBody* child = nullptr;
  BodyId parent_id, child_id;                         // the first is meaningless without a parent
  Eigen::Vector3d start_P = Eigen::Vector3d::Zero();  // of the child in the parent by default [m]
  double start_yaw_rad = 0.0;
  // The share of an error that a step takes back, and the share of the weight that the spring
  // carries at rest, as a velocity; the defaults are those of a rigid one.
  double vertical_share = 1.0, preload_m_s = 0.0;
  double tilt_share = 0.0;  // of a suspended gantry
};

/// The pending command for the motors of a gantry: velocities in the parent's frame.
struct GantryOrder {
  Eigen::Vector3d velocity_m_s = Eigen::Vector3d::Zero();
  double yaw_rate_rad_s = 0.0;
  bool waiting = false;
};

/// The whole turns that a hinge with far stops has made (ode_turns.cc).
struct TurnCount {
  HingeId hinge;
  int whole = 0;
  double last_rad = 0.0;  // the engine's angle after the last step
};

/// A contact of the next step, before it is known which bodies move.
struct NewContact {
  dxGeom *a = nullptr, *b = nullptr;
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero(), normal_W = Eigen::Vector3d::Zero();  // into a
  double depth_m = 0.0;
  double friction = 0.0;
};

class RestingJoints;
class Followers;

/// The data of a geom of the world.
const GeomInfo& info_of(dxGeom* geom);

/// The state behind OdeWorld. The frame of a link is in its centre of mass.
struct OdeWorld::Engine final : EngineState {
  dxWorld* world = nullptr;
  dxThreadingImplementation* threading = nullptr;
  dxSpace* static_space = nullptr;
  dxSpace* movable_space = nullptr;  // in it a space for each link of many shapes
  dxJointGroup* contact_group = nullptr;
  std::vector<dxBody*> links;              // by LinkId
  std::vector<dxSpace*> link_spaces;       // by LinkId
  std::vector<bool> never_sleeps;          // by LinkId: parts of the robot
  std::vector<dxJoint*> sliders;           // by SliderId
  std::vector<Gantry> gantries;            // by GantryId
  std::vector<dxJoint*> slider_dampers;    // by SliderId; null: none
  std::vector<GantryOrder> gantry_orders;  // by GantryId
  std::vector<dxJoint*> hinges;            // by HingeId
  std::vector<dxJoint*> turners;           // by HingeId: their motors
  std::vector<dxJoint*> hinge_dampers;     // by HingeId; null: none
  std::vector<TurnCount> turn_counts;      // of hinges that may pass half a turn, or are coupled
  std::vector<GeomInfo> geoms;             // never grows after building: geoms point into it
  std::vector<bool> touched;               // by LinkId, of the robot: in the next step
  std::vector<NewContact> new_contacts;
  std::unique_ptr<Followers> followers;
  std::unique_ptr<RestingJoints> resting;
  /// The engine's meshes, one for each hull. Held here as long as geoms refer to them.
  std::vector<std::pair<std::shared_ptr<const ConvexHull>, dxTriMeshData*>> meshes;

  explicit Engine(const WorldSpec& spec);
  ~Engine() override;
};

/// A rotation as the engine wants it: four numbers a row.
void copy_rotation(const Eigen::Matrix3d& R, double (&out)[12]);

/// The form, size and hull that a geom is made of.
struct GeomForm {
  ShapeForm form = ShapeForm::kBox;
  const Eigen::Vector3d& size_m;
  const std::shared_ptr<const ConvexHull>& hull;
};

/// A geom of this form and size; `space` may be null.
dxGeom* create_geom(OdeWorld::Engine& engine, dxSpace* space, const GeomForm& form);
/// Destroys the meshes of all hulls. No geom may refer to them any more.
void destroy_meshes(OdeWorld::Engine& engine);

/// Creates everything from the layout, in its order. One use per engine.
class OdeBuilder {
 public:
  explicit OdeBuilder(OdeWorld::Engine& engine);
  void build();

 private:
  void create_world();
  void create_links();
  void create_geoms();
  void create_link_spaces();
  void create_shape(const BodyShape& shape, BodyId id, GeomInfo& info);
  void create_sliders();
  void create_gantries();
  void create_hinges();
  void suspend(const SuspensionSpec& springs, Gantry& gantry) const;
  dxJoint* damper_of(const JointSpec& spec);
  dxJoint* turner_of(const JointSpec& spec);
  dxBody* body_of(const std::string& name) const;

  OdeWorld::Engine& engine_;
};

/// The rotation of a gantry's parent in the world.
Eigen::Matrix3d parent_rotation(const OdeWorld& world, const Gantry& gantry);

/// Passes pending commands to the motors of gantries.
void carry_out_orders(const OdeWorld& world, OdeWorld::Engine& engine);

/// Counts the turns of hinges after a step, and moves their stops along.
void count_turns(OdeWorld::Engine& engine);
/// Puts far stops where the engine's angles meet them in the current turn.
void move_far_stops(OdeWorld::Engine& engine);
/// To be added to the engine's angle; 0 where no turns are counted.
double whole_turns_rad(const OdeWorld::Engine& engine, HingeId id);

/// Gives a free body another mass, spread as before.
void set_free_mass(OdeWorld::Engine& engine, BodyId id, double mass_kg);

/// Collision pass: finds the contacts of the next step, and records what touches free bodies and
/// parts of the robot.
void find_contacts(OdeWorld::Engine& engine);

/// Makes joints of them, between what moves. `softening` multiplies their CFM, that of friction
/// included.
void attach_contacts(OdeWorld::Engine& engine, double softening = 1.0);

/// Attaches the contacts and steps the world. A step that the contact solver gives up is taken back
/// and solved again with softer contacts. `complaints` counts the solver's messages; on return,
/// those of a step that stayed unsolved.
void solve_step(OdeWorld::Engine& engine, std::int64_t& complaints);

/// Leaves at most `most` of those contacts between two links (or a link and what never moves) that
/// have the same normal and friction: those that span the most. Where a flat side lies on another
/// it makes no difference what else touches between them.
void thin_out(std::vector<NewContact>& contacts, std::size_t most);

/// Collision pass that makes nothing: the deepest pair, if any touches.
std::optional<Overlap> find_deepest_overlap(OdeWorld::Engine& engine);

}  // namespace parallax::harness
