#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "harness/engine/sweep.h"
#include "harness/robot/arm.h"
#include "harness/robot/chain_sweep.h"

namespace parallax::harness {

/// The reason why a tool cannot be led straight from one point to another.
struct WayFault {
  std::optional<Obstacle> hit;
  std::string unfollowed;  // else: why the joints cannot follow; "`elbow` at its stop"

  /// "`palm` meets `shelf`".
  std::string text(const char* meets = "meets") const;
};

/// A test of a straight stretch, both ends in the world.
using StretchTest =
    std::function<std::optional<WayFault>(const Eigen::Vector3d&, const Eigen::Vector3d&)>;

/// The corners of a way of the tool, its start left out; or what was in the way of the last try.
struct ToolPath {
  std::vector<Eigen::Vector3d> corners;
  std::optional<WayFault> blocked;
};

/// A way from `from` to `to` all stretches of which pass the test: straight, or back along `back`
/// (a unit vector), up, across, down and forward again, with the shortest retreats and the lowest
/// height that will do. Heights end at `ceiling_m`. No other ways are tried. Cost: up to some
/// hundred stretches.
ToolPath find_tool_path(const StretchTest& test, const Eigen::Vector3d& from,
                        const Eigen::Vector3d& to, const Eigen::Vector3d& back, double ceiling_m);

/// The test of one set of shapes, which stand at `from`.
StretchTest swept(const Sweep& sweep, const Eigen::Vector3d& from);

/// Straight ways of the tool of an arm as it hangs at construction, which leave its wrist as it is
/// to be turned then; the first of them turns it, if it is not.
/// On them the palm and what it holds meet nothing, and, of a chain, no link does; and the joints
/// can follow. Postures at points that no way led to yet are looked for from those nearby.
class ArmWays {
 public:
  /// `ignored`: what the arm is for; `robot`: all parts of the robot.
  ArmWays(const PhysicsWorld& world, const Arm& arm, std::optional<BodyId> load, BodyMask ignored,
          const BodyMask& robot, double tolerance_m);

  std::optional<WayFault> along(const Eigen::Vector3d& from, const Eigen::Vector3d& to);
  /// The same by `angle_rad` round the vertical through `centre_W`, the wrist turning with it, and
  /// so does `led`, which the hand leads and no link of a chain may meet.
  std::optional<WayFault> round(const Eigen::Vector3d& from, const Eigen::Vector3d& centre_W,
                                double angle_rad, BodyId led);
  /// Can the joints follow all the corners in a row, from where they are?
  std::optional<WayFault> follow(const std::vector<Eigen::Vector3d>& corners) const;
  /// For a chain: consecutive ways of all joints at once to a posture that has the tool there. On
  /// these no link meets anything, and a hand that holds something leans little. Empty: none was
  /// found.
  std::vector<ChainWay> swings(const Eigen::Vector3d& to) const;
  /// For a chain: can the wrist turn to `wrist_rad` where the tool is, with nothing in the way?
  /// Others turn about the axis of the palm.
  bool turns_on_the_spot(double wrist_rad) const;

 private:
  bool may_be(const JointVector& q) const;
  std::optional<JointVector> posture(const Eigen::Vector3d& tool_W);
  std::optional<WayFault> lead(JointVector& q, const Eigen::Isometry3d& goal) const;
  bool is_turned() const;

  const Arm& arm_;
  const PalmChain* chain_;
  double wrist_rad_;
  bool holds_;
  Eigen::Vector3d tool_W_;
  Sweep palm_;
  std::optional<ChainSweep> links_;
  std::vector<std::pair<Eigen::Vector3d, JointVector>> known_;
};

}  // namespace parallax::harness
