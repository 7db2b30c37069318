#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "harness/engine/physics_world.h"

namespace parallax::harness {

/// Decides the colour. kDrawer: carried by a joint of the furniture.
enum class SceneKind : std::uint8_t { kFurniture, kDrawer, kRobot, kGripper, kItem };

struct SceneBox {
  std::string body;
  SceneKind kind = SceneKind::kFurniture;
  Probe box;
  Eigen::Vector3d origin_W = Eigen::Vector3d::Zero();  // of the body
};

/// A line from a shoulder to a palm on a gantry. The simulator has no body there; without the line
/// a hand would hang in the air. Chains of joints have bodies.
struct SceneArm {
  std::string name;
  Eigen::Vector3d from_W = Eigen::Vector3d::Zero(), to_W = Eigen::Vector3d::Zero();
};

/// A world as it stands, box by box.
struct Scene {
  std::vector<SceneBox> boxes;  // in order of the bodies' names
  std::vector<SceneArm> arms;
  std::string base;  // the robot's body that drives; empty: none
};

Scene scene_of(const PhysicsWorld& world, const WorldSpec& spec);

/// The way of a base, a hand or an item.
struct SceneTrack {
  std::string name;
  SceneKind kind = SceneKind::kRobot;
  std::vector<Eigen::Vector3d> points_W;
};

/// A stretch of an action's way that was not driven, and the point where it was to end.
struct SceneGoal {
  Eigen::Vector3d from_W = Eigen::Vector3d::Zero(), to_W = Eigen::Vector3d::Zero();
  bool reached = false;
};

/// The cone that a camera looks at.
struct SceneGaze {
  Eigen::Vector3d camera_W = Eigen::Vector3d::Zero(), point_W = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3d> border_W;  // of its far end, in order round the gaze
};

/// A body that was looked for.
struct SceneSought {
  std::string body;
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();
  bool seen = false;
};

/// A length that says why something went wrong.
struct SceneMeasure {
  Eigen::Vector3d from_W = Eigen::Vector3d::Zero(), to_W = Eigen::Vector3d::Zero();
  std::string label;  // "`base` and `drawer_mid` overlap by 43 mm"
};

/// How far an arm reaches.
struct SceneReach {
  Eigen::Vector3d shoulder_W = Eigen::Vector3d::Zero();
  double max_m = 0.0;
};

/// The marks of one action, to be drawn over the world as it stands at its end.
struct SceneAction {
  std::vector<SceneTrack> tracks;
  std::optional<SceneGoal> goal;
  std::optional<SceneGaze> gaze;
  std::vector<SceneSought> sought;
  Scene ghost;                      // what stood elsewhere at an earlier moment
  Scene meeting;                    // where something would have met another body
  std::vector<std::string> met;     // bodies that the reason of a failure names
  std::optional<SceneReach> reach;  // where something was out of it
  std::vector<SceneMeasure> measures;
  Scene predicted;                             // where the model says that something is
  std::vector<std::string> predicted_regions;  // in which the model says that something is
  std::vector<std::string> differing;          // bodies that are not where the model says
  std::vector<std::string> notes;  // what the marks mean: "dashed: 5.3 s into the action"
};

/// The part of the world that a picture shows. What lies outside is cut off; marks are moved to the
/// border.
struct SceneFrame {
  Eigen::Vector3d low = Eigen::Vector3d::Zero(), high = Eigen::Vector3d::Zero();  // [m]
};

/// kSide looks along +y, kFront along -x.
enum class ViewKind : std::uint8_t { kAbove, kSide, kFront };

struct Rectangle {
  Eigen::Vector2d low = Eigen::Vector2d::Zero(), high = Eigen::Vector2d::Zero();  // [px]
  Eigen::Vector2d size() const { return high - low; }
  bool empty() const { return !(low.array() < high.array()).any(); }
  bool meets(const Rectangle& other) const {
    return (low.array() < other.high.array()).all() && (other.low.array() < high.array()).all();
  }
  bool holds(const Rectangle& other) const {
    return (low.array() <= other.low.array()).all() && (other.high.array() <= high.array()).all();
  }
};
Rectangle around(const std::vector<Eigen::Vector2d>& points);

/// The part of a convex polygon within the rectangle (Sutherland and Hodgman 1974); empty: none is.
std::vector<Eigen::Vector2d> clipped(std::vector<Eigen::Vector2d> polygon, const Rectangle& area);

/// Points whose hull is the shape, or near it where it is round, in its own frame.
std::vector<Eigen::Vector3d> outline_points(const Probe& shape);

/// Convex hull, counter-clockwise (Andrew 1979).
std::vector<Eigen::Vector2d> hull(std::vector<Eigen::Vector2d> points);

/// With the first point again at the end.
std::vector<Eigen::Vector2d> closed(std::vector<Eigen::Vector2d> points);

/// "12.0,3.4 56.7,8.9", as polygons and polylines list their points.
std::string point_list(const std::vector<Eigen::Vector2d>& points);

/// The projection from the world to the pixels of one view: from above x is to the right and y up;
/// from the side, looking along +y, x is to the right and z up; looking along -x, y is to the
/// right.
class Projection {
 public:
  Projection(const SceneFrame& frame, ViewKind kind, double left_px, double top_px, double px_per_m)
      : frame_(frame), kind_(kind), left_px_(left_px), top_px_(top_px), px_per_m_(px_per_m) {}

  ViewKind kind() const { return kind_; }
  const SceneFrame& frame() const { return frame_; }
  double top_m() const { return kind_ == ViewKind::kAbove ? frame_.high.y() : frame_.high.z(); }
  double bottom_m() const { return kind_ == ViewKind::kAbove ? frame_.low.y() : frame_.low.z(); }
  double left_m() const { return kind_ == ViewKind::kFront ? frame_.low.y() : frame_.low.x(); }
  double right_m() const { return kind_ == ViewKind::kFront ? frame_.high.y() : frame_.high.x(); }
  double width_px() const { return px_per_m_ * (right_m() - left_m()); }
  double height_px() const { return px_per_m_ * (top_m() - bottom_m()); }
  Rectangle area() const {
    return {{left_px_, top_px_}, {left_px_ + width_px(), top_px_ + height_px()}};
  }

  double px_per_m() const { return px_per_m_; }
  /// Moved to the border if it lies outside.
  Eigen::Vector2d pixel(const Eigen::Vector3d& p_W) const;
  std::vector<Eigen::Vector2d> pixels(const std::vector<Eigen::Vector3d>& points_W) const;
  /// Cut off at the border; empty if all of it lies outside.
  std::vector<Eigen::Vector2d> outline(const Probe& shape) const;
  /// The nearness of the face that the viewer looks at; greater is nearer [m].
  double nearness(const Probe& box) const;

 private:
  Eigen::Vector2d anywhere(const Eigen::Vector3d& p_W) const;

  SceneFrame frame_;
  ViewKind kind_;
  double left_px_, top_px_, px_per_m_;
};

}  // namespace parallax::harness
