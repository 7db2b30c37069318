#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "harness/engine/physics_world.h"

namespace parallax::harness {

/// An obstacle to a motion.
struct Obstacle {
  std::string part;      // of the moving bodies
  std::string obstacle;  // body, or "floor"
  double way_m = 0.0;    // how far the motion gets
  /// For a straight motion, the room across it, sideways if it is level [m]. It is below 0 here:
  /// the overlap of part and obstacle where one would pass the other. None: a turn, or the floor.
  std::optional<double> clearance_m = {};
};

/// Shapes that move as one, tried in other places without moving anything: the boxes of `bodies`
/// as they stand at construction, against everything else that is not in `ignored`.
class Sweep {
 public:
  /// Overlaps of at most `tolerance_m` count as touching; a negative tolerance asks for that much
  /// room all round.
  Sweep(const PhysicsWorld& world, const BodyMask& bodies, const BodyMask& ignored,
        double tolerance_m);

  /// The first obstacle on the straight way by `way`, looked at every `step_m`, ends included.
  std::optional<Obstacle> along(const Eigen::Vector3d& offset, const Eigen::Vector3d& way,
                                double step_m) const;
  /// The same for a turn about the vertical through `axis_W`, after a shift by `offset`.
  std::optional<Obstacle> turning(const Eigen::Vector3d& offset, const Eigen::Vector3d& axis_W,
                                  double angle_rad, double step_rad) const;

 private:
  struct Part {
    std::string name;
    Probe probe;
  };
  std::optional<Obstacle> at(const Eigen::Vector3d& offset, const Eigen::Vector3d& axis_W,
                             double angle_rad) const;
  std::optional<double> clearance_of(const Obstacle& hit, const Eigen::Vector3d& offset,
                                     const Eigen::Vector3d& way) const;

  const PhysicsWorld& world_;
  BodyMask ignored_;
  double tolerance_m_;
  std::vector<Part> parts_;
};

}  // namespace parallax::harness
