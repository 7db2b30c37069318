#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "harness/engine/physics_world.h"
#include "harness/robot/detection_errors.h"
#include "harness/robot/mobile_robot.h"

namespace parallax::harness {

/// The robot's belief about one body. The position moves along with the body that `frame` names.
struct BodyBelief {
  bool perceived = false;  // the last look for it found it
  bool located = false;
  std::string frame;
  Eigen::Vector3d p_F = Eigen::Vector3d::Zero();
  double bottom_F_m = 0.0;  // height of its lowest point
  double yaw_rad = 0.0;
};

/// The quality of a look at a body.
struct Sighting {
  int points = 0;         // tried
  int seen = 0;           // in the cone and not hidden
  std::string hidden_by;  // what hid a point, if something did
  // The origin, exact but for what the view does; only with seen > 0.
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();
};

/// The camera and the point that it was told to look at, in the world.
struct Gaze {
  Eigen::Vector3d camera_W = Eigen::Vector3d::Zero(), point_W = Eigen::Vector3d::Zero();
};

/// A camera that sees points of bodies by casting rays, and what was made of it. An estimate is the
/// median of the middles of the stretches that the rays have inside the body (of the points
/// themselves where they lie in its hollow): how a body of known shape is found, with an error that
/// depends on the view. What is believed of it is off by the camera's errors of detection besides.
class Perception {
 public:
  Perception(const PhysicsWorld& world, const MobileRobot& robot);

  void reset(std::uint64_t seed = 0);
  /// Turns the gaze to a place; a message instead if the neck does not turn so far.
  std::optional<std::string> look_at(const PlaceSpec& place);
  /// Name of the place that the camera looks at: empty once the robot has turned or driven so far
  /// that the neck, left as it was, would point elsewhere by more than the cone.
  std::string gaze() const;
  /// Once the place is out of the cone the robot looks at nothing, also when it drives back.
  void drop_lost_gaze();
  /// Along which `sight` sees; nothing before the first look or once it was dropped.
  std::optional<Gaze> line_of_sight() const;

  /// Casts rays at `points` points spread along the longest side of the body.
  Sighting sight(BodyId id, int points) const;
  /// `taken_for`: the body is believed to be that one, and where `id` was seen.
  void believe(BodyId id, const Sighting& sighting, std::optional<BodyId> taken_for = {});
  void unsee(BodyId id) { beliefs_[id.index()].perceived = false; }
  void forget(BodyId id) { beliefs_[id.index()].located = false; }
  /// It was put down there.
  void believe_as_is(BodyId id);

  const BodyBelief& belief(BodyId id) const { return beliefs_[id.index()]; }
  DetectionErrors& errors() { return errors_; }
  /// The believed origin, now; nothing if it was never located.
  std::optional<Eigen::Vector3d> believed(BodyId id) const;
  std::optional<double> believed_bottom_m(BodyId id) const;

  Eigen::Vector3d place_in_world(const PlaceSpec& place) const;
  /// The free bodies of a kind.
  std::vector<BodyId> bodies_of_kind(const std::string& kind) const;

 private:
  /// Is the place that was looked at in the cone of the neck as it was left?
  bool is_on_target() const;
  /// Half way between where a ray at a point of the body enters it and where it leaves it; for a
  /// point in its hollow, that point. `p_B` is in the body's frame.
  Eigen::Vector3d middle_of_chord(const Eigen::Vector3d& from, const Eigen::Vector3d& p_B,
                                  BodyId id) const;
  /// Stores the belief about `id`, located where `like` was seen.
  void store(BodyId id, BodyId like, const Eigen::Vector3d& p_W, double yaw_rad,
             const std::string& frame);
  Eigen::Vector3d from_frame(const std::string& frame, const Eigen::Vector3d& p_F) const;

  const PhysicsWorld& world_;
  const MobileRobot& robot_;
  PlaceSpec gaze_;
  Eigen::Vector3d looked_W_ = Eigen::Vector3d::Zero();  // where the place was then
  Eigen::Vector3d neck_B_ = Eigen::Vector3d::UnitX();   // direction of the gaze then
  bool looking_ = false;
  std::vector<BodyBelief> beliefs_;  // by BodyId
  DetectionErrors errors_;
};

}  // namespace parallax::harness
