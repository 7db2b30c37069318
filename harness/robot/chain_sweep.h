#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/engine/sweep.h"
#include "harness/robot/palm_chain.h"

namespace parallax::harness {

/// An arm that is a chain, and what it holds, tried in other postures without moving anything: each
/// shape that hangs on a joint, against everything else that is not in `ignored`. From the third
/// joint on, the rest of the robot counts as in the way, too; what the first two carry sits in it.
class ChainSweep {
 public:
  /// Takes the robot and the arm as they stand at construction. Overlaps of at most `tolerance_m`
  /// count as touching; a negative tolerance asks for that much room all round, but not from the
  /// robot itself.
  ChainSweep(const PhysicsWorld& world, const PalmChain& chain, std::optional<BodyId> load,
             const BodyMask& ignored, const BodyMask& robot, double tolerance_m);

  /// The obstacle that is met with the joints at `q`, if any; the way there is not examined.
  std::optional<Obstacle> at(const JointVector& q) const;
  /// Which part meets a body that has turned by `angle_rad` about the vertical through `centre_W`
  /// from where it is; not what the last joint carries, which leads it.
  std::optional<Obstacle> meets_turned(const JointVector& q, BodyId turned,
                                       const Eigen::Vector3d& centre_W, double angle_rad) const;

 private:
  struct Part {
    std::string name;
    std::size_t joint = 0;
    Probe own;               // as it is
    Probe roomy;             // grown by the room; of a hull the box round it
    Eigen::Isometry3d X_JS;  // moves with the joint
  };
  void add(BodyId id, std::size_t joint, const Eigen::Isometry3d& X_WJ, double room_m);

  const PhysicsWorld& world_;
  const ChainArm& arm_;
  Eigen::Isometry3d X_WR_;
  BodyMask ignored_, all_but_robot_;
  double tolerance_m_;
  std::vector<Part> parts_;
};

}  // namespace parallax::harness
