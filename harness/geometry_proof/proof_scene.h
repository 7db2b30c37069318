#pragma once

#include <span>
#include <string>
#include <vector>

#include "harness/geometry_proof/known_state.h"
#include "harness/world/world_layout.h"

namespace parallax::harness {

/// A box of start states: bounds of each variable that is drawn, in the order of the scene.
using StartBox = std::vector<Bounds1>;

/// An upright box of the world as a function of the start. Heights are known to intervals: those of
/// its lower and of its upper face.
struct UprightBox {
  AffineForm x, y;          // of its middle
  AffineForm cosine, sine;  // of its heading
  double half_x = 0.0, half_y = 0.0;
  Bounds1 bottom, top;
};

/// One shape of a body, and what it moves with.
struct ScenePiece {
  enum class Carrier { kWorld, kSlider, kBase, kItself, kHand };
  BodyId body;
  Carrier carrier = Carrier::kWorld;
  bool moves_with_robot = false;  // of the robot, or held by it
  /// False: the shape is somewhere in this box.
  bool is_exact = true;
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();  // in the frame of its carrier [m]
  double yaw_rad = 0.0;                              // likewise
  double half_x = 0.0, half_y = 0.0;
  Bounds1 bottom = {}, top = {};                      // in the world
  Eigen::Vector2d slack_m = Eigen::Vector2d::Zero();  // of its middle, against its carrier
  // For kHand: the hand's place in the base's frame, and the radius of a circle round it that holds
  // the shape however it is turned.
  Eigen::Vector2d hand = Eigen::Vector2d::Zero();
  double hand_radius_m = 0.0;
};

/// An arm at the default placement, as the controllers measure it.
struct ArmGeometry {
  std::vector<BodyId> bodies;
  Eigen::Vector3d tool_W = Eigen::Vector3d::Zero();
  BodyId far_pad;
  Eigen::Vector3d closed = Eigen::Vector3d::Zero();  // the ends of the far pad's way
  Eigen::Vector3d opened = Eigen::Vector3d::Zero();
  Eigen::Vector3d pad_line_W = Eigen::Vector3d::UnitY();  // Arm::pad_line
  Eigen::Vector3d palm_offset = Eigen::Vector3d::Zero();  // Arm::palm_offset
  Eigen::Matrix3d R_WP = Eigen::Matrix3d::Identity();     // of the palm
  Eigen::Vector3d palm_size_m = Eigen::Vector3d::Zero();
};

/// The boxes of a mobile robot's world before an action, seen as functions of the start.
class ProofScene {
 public:
  /// All outlive the scene but `region`. What is not known any more is in `unknown`.
  ProofScene(const WorldSpec& spec, const WorldLayout& layout, const StartCuboid& region,
             const KnownState& state);

  const std::vector<ScenePiece>& pieces() const { return pieces_; }
  /// The things whose place is not known: "the left arm", "`cup1`"; empty if all is known.
  const std::vector<std::string>& unknown() const { return unknown_; }
  /// Where a body that the arm holds has the arm's tool, in the body's frame: beside the grasp, as
  /// the near pad stays where it is while the far one closes; `side` -1 where the hand is turned
  /// the other way.
  Eigen::Vector3d gripped_at(const GraspSpec& grasp, std::size_t arm, double side) const;
  const ArmGeometry& arm(std::size_t index) const { return arms_[index]; }
  // The height and heading of the base at the default placement.
  double base_z() const;
  double base_yaw_rad() const;
  const KnownState& state() const { return *state_; }
  const WorldSpec& spec() const { return *spec_; }
  const WorldLayout& layout() const { return *layout_; }
  const StartCuboid& region() const { return region_; }

  /// The variables drawn from an interval, not fixed: at most AffineForm::kMostVariables.
  const std::vector<std::string>& variables() const { return variables_; }
  StartBox whole() const;

  /// Middle and heading of the base.
  struct Base {
    AffineForm x, y, yaw, cosine, sine;
  };
  Base base(std::span<const Bounds1> box) const;
  struct Point {
    AffineForm x, y, z;
  };
  /// A point of a part on the torso, given in the frame of the base.
  Point on_torso(const Eigen::Vector3d& p_B, const Base& base) const;
  UprightBox place(const ScenePiece& piece, std::span<const Bounds1> box, const Base& base) const;
  /// The value of a variable, which may be fixed, or `fallback` where it is not set.
  AffineForm variable(const std::string& name, std::span<const Bounds1> box, double fallback) const;
  /// The origin of a free body in the plane, and its heading.
  Base free_body(BodyId id, std::span<const Bounds1> box) const;
  /// Range of the height of its origin.
  Bounds1 free_height(BodyId id) const;

 private:
  void add_piece(BodyId id, const BodyShape& shape);
  std::vector<const JointSpec*> joints_below(BodyId id) const;
  void add_arm_pieces(BodyId id, const BodyShape& shape, std::size_t arm);
  void add_held(BodyId id, std::size_t arm);

  const WorldSpec* spec_;
  const WorldLayout* layout_;
  const KnownState* state_;
  StartCuboid region_;
  std::vector<std::string> variables_;
  std::vector<ScenePiece> pieces_;
  std::vector<std::string> unknown_;
  std::vector<ArmGeometry> arms_;
};

}  // namespace parallax::harness
