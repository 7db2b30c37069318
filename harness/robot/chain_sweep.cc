// Tells what an arm would meet in another posture, without moving it.
//
// The shapes of the arm and of its load are noted once, each in the frame of the last joint that
// moves it. For a posture the chain gives the motion of every joint, each shape is placed by it
// and the engine is asked for an obstacle there, the arm itself being left out. Where room is
// asked for, shapes are grown by it, hulls as the boxes round them. Parts from the third joint
// on are asked about once more without the room, against the rest of the robot. To try a body
// that turns as well, everything else is turned back instead, since the engine knows the body
// only where it is.
//
// Cost: two questions to the engine for each shape and posture.

#include "harness/robot/chain_sweep.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <utility>

#include "harness/world/angles.h"

namespace parallax::harness {
namespace {

constexpr std::size_t kFirstApart = 2;  // joint whose parts the robot itself can be in the way of

using Motions = std::array<Eigen::Isometry3d, kMostChainJoints>;

Probe at_pose(const Probe& probe, const Eigen::Isometry3d& X_WS) {
  return {probe.size_m, X_WS.translation(), X_WS.linear(), probe.form, probe.hull};
}

}  // namespace

ChainSweep::ChainSweep(const PhysicsWorld& world, const PalmChain& chain,
                       std::optional<BodyId> load, const BodyMask& ignored, const BodyMask& robot,
                       double tolerance_m)
    : world_(world),
      arm_(chain.arm()),
      X_WR_(chain.root()),
      ignored_(ignored),
      tolerance_m_(std::max(tolerance_m, 0.0)) {
  const auto& hangs_on = arm_.hangs_on;
  const double room_m = std::max(-tolerance_m, 0.0);
  Motions moved;
  arm_.chain.motions(chain.positions(), moved);
  for (std::size_t i = 0; i < hangs_on.size(); ++i) {
    const BodyId id = world.layout().bodies.id_at(i);
    const bool held = load && *load == id;
    // All others are no part of the robot, or of its own arm.
    all_but_robot_.push_back(!robot[i] || hangs_on[i] >= 0);
    if (hangs_on[i] < 0 && !held) continue;
    const std::size_t joint = held ? arm_.masses.size() - 1 : static_cast<std::size_t>(hangs_on[i]);
    ignored_[i] = true;
    add(id, joint, X_WR_ * moved[joint], room_m);
  }
}

void ChainSweep::add(BodyId id, std::size_t joint, const Eigen::Isometry3d& X_WJ, double room_m) {
  const BodySpec& body = world_.layout().bodies[id];
  if (!body.collides) return;
  for (const BodyShape& shape : body.shapes) {
    const Probe own = world_.placed(id, shape);
    Part part{body.name, joint, own, own, {}};
    Eigen::Isometry3d X_WS = Eigen::Isometry3d::Identity();
    X_WS.linear() = own.R_WS;
    X_WS.translation() = own.p_WS;
    part.X_JS = X_WJ.inverse() * X_WS;
    part.roomy.size_m += Eigen::Vector3d::Constant(2.0 * room_m);
    if (room_m > 0.0 && own.form == ShapeForm::kHull) {
      part.roomy.form = ShapeForm::kBox;
      part.roomy.hull = nullptr;
    }
    parts_.push_back(std::move(part));
  }
}

std::optional<Obstacle> ChainSweep::at(const JointVector& q) const {
  Motions moved;
  arm_.chain.motions(q, moved);
  for (const Part& part : parts_) {
    const Eigen::Isometry3d X_WS = X_WR_ * moved[part.joint] * part.X_JS;
    if (const auto hit = world_.find_obstacle(at_pose(part.roomy, X_WS), ignored_, tolerance_m_)) {
      return Obstacle{part.name, hit->first, 0.0};
    }
    if (part.joint < kFirstApart) continue;
    const Probe own = at_pose(part.own, X_WS);
    if (const auto hit = world_.find_obstacle(own, all_but_robot_, tolerance_m_)) {
      if (hit->first != "floor") return Obstacle{part.name, hit->first, 0.0};
    }
  }
  return std::nullopt;
}

std::optional<Obstacle> ChainSweep::meets_turned(const JointVector& q, BodyId turned,
                                                 const Eigen::Vector3d& centre_W,
                                                 double angle_rad) const {
  Motions moved;
  arm_.chain.motions(q, moved);
  // Seen from the body, which stays where it is, everything else turns back.
  const Eigen::AngleAxisd back(-angle_rad, Eigen::Vector3d::UnitZ());
  for (const Part& part : parts_) {
    if (part.joint + 1 == arm_.masses.size()) continue;
    const Eigen::Isometry3d X_WS = X_WR_ * moved[part.joint] * part.X_JS;
    Probe probe = at_pose(part.own, X_WS);
    probe.p_WS = round_vertical(probe.p_WS, centre_W, -angle_rad);
    probe.R_WS = back * probe.R_WS;
    if (world_.overlaps(probe, turned)) {
      return Obstacle{part.name, world_.layout().bodies[turned].name, 0.0};
    }
  }
  return std::nullopt;
}

}  // namespace parallax::harness
