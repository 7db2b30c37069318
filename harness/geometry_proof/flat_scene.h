#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "harness/geometry_proof/flat_shapes.h"
#include "harness/geometry_proof/geometric_check.h"

namespace parallax::harness {

/// A shape as the second evaluation sees it.
struct FlatShape {
  enum class Frame { kWorld, kBase, kBody, kHand };
  Frame frame = Frame::kWorld;
  std::size_t body = 0;                            // of kBody, and of a held body
  Eigen::Vector2d hand = Eigen::Vector2d::Zero();  // in the frame of the base
  Polygon corners;  // in the frame, round everywhere that it may be but for `slack_m`
  double slack_m = 0.0;
  Bounds1 bottom, top;
  // Where it certainly is, if its place is known.
  bool is_exact = true;
  Eigen::Vector2d middle = Eigen::Vector2d::Zero(), half = Eigen::Vector2d::Zero();
  double heading_rad = 0.0;
  double shrink_m = 0.0;
  // A circle round the corners, in the frame.
  Eigen::Vector2d hub = Eigen::Vector2d::Zero();
  double radius_m = 0.0;
};

/// Sets its circle.
void add_circle(FlatShape& shape);

/// A part and an obstacle, by their numbers.
using FlatPair = std::pair<std::size_t, std::size_t>;

/// The world before an action as the second evaluation sees it: shapes by their corners, from the
/// placements that a simulation starts with.
class FlatScene {
 public:
  /// All outlive it.
  FlatScene(const WorldSpec& spec, const WorldLayout& layout, const StartCuboid& region,
            const KnownState& state);

  static double reach_of(const Polygon& corners);
  static bool overlap(const Polygon& a, const Polygon& b);
  static bool meet_in_height(const FlatShape& a, const FlatShape& b);
  static bool surely_meet_in_height(const FlatShape& a, const FlatShape& b);

  struct Circle {
    Eigen::Vector2d middle = Eigen::Vector2d::Zero();
    double radius_m = 0.0;
  };
  /// Round the shape wherever its frame is in the range.
  static Circle circle_of(const FlatShape& shape, const PlanarRange& frame);
  /// The direction in which two polygons are farthest apart, of the normals of their sides and of
  /// some others.
  static double best_direction(const Polygon& a, const Polygon& b);
  /// Shows that, wherever the frames of the part and of the obstacle are, the part with these
  /// corners is not met; `middle`: it in the middle of the box.
  bool apart(const FlatShape& part, const Polygon& corners, const std::vector<PlanarRange>& frames,
             const Polygon& middle, const FlatShape& obstacle, const StartBox& box) const;
  /// Halves of a box, and its widest variable.
  static std::pair<StartBox, StartBox> cut(const StartBox& box, std::size_t axis);
  static std::size_t widest_of(const StartBox& box);
  /// The bounds on how far a free body may lie beside range_of and be turned against it [m, rad].
  std::pair<double, double> free_slack(std::size_t body) const;
  PlanarRange base_range(const StartBox& box) const;
  /// The range of the frame of a part once the base is at `base`.
  PlanarRange carried(const FlatShape& part, const PlanarRange& base, const StartBox& box) const;
  /// The shape of a part for a turn about the base's middle: anything held is a disc.
  Polygon turning_corners(const FlatShape& part) const;
  PlanarRange range_of(const FlatShape& shape, const StartBox& box) const;
  Polygon at_middle(const FlatShape& shape, const StartBox& box) const;

 protected:
  const WorldSpec& spec_;
  const WorldLayout& layout_;
  const StartCuboid& region_;
  const KnownState& state_;
  std::vector<FlatShape> parts_;  // of the robot and what it holds
  std::vector<FlatShape> obstacles_;

 private:
  std::size_t arm_of(std::size_t body) const;
  void add_body(std::size_t i, const std::vector<Placement>& placements);
  /// Corners at both ends of the slider's way hold all that lies between.
  void add_slider(std::size_t i, FlatShape& flat) const;
  void add_free(std::size_t i, const BodySpec& body, FlatShape& flat) const;
  void raise(FlatShape& flat, double slack_m) const;
  void add_part(std::size_t i, const BodySpec& body, const BodyShape& shape,
                const Placement& placement, const Placement& base, FlatShape flat);
  Eigen::Vector3d pad_middle(const std::string& name) const;
  /// Turned against the world as when it was gripped, at the hand.
  void add_held(std::size_t i, const BodySpec& body, const BodyShape& shape, FlatShape flat);
  Bounds1 variable(const StartBox& box, const std::string& name, double fallback) const;
  double sliding_rad(const FlatShape& part) const;
};

}  // namespace parallax::harness
