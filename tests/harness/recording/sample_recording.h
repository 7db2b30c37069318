#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "harness/recording/recording.h"

namespace parallax::harness {

/// Numbers that look random and are the same everywhere.
class Steps {
 public:
  explicit Steps(std::uint64_t seed) : state_(seed * 2862933555777941757U + 3037000493U) {}
  std::uint64_t next() {
    state_ ^= state_ << 13U;
    state_ ^= state_ >> 7U;
    state_ ^= state_ << 17U;
    return state_;
  }
  double uniform() { return static_cast<double>(next() >> 11U) * 0x1p-53; }

 private:
  std::uint64_t state_;
};

inline Pose random_pose(Steps& steps) {
  Pose pose;
  for (double& x : pose.p) x = 20.0 * steps.uniform() - 10.0;
  double norm = 0.0;
  for (double& x : pose.q) {
    x = steps.uniform() - 0.5;
    norm += x * x;
  }
  for (double& x : pose.q) x /= std::sqrt(norm);
  return pose;
}

/// Everything that a recording can have, once.
inline Recording sample_recording() {
  Recording out;
  out.trace = 2;
  out.sample = 4;
  out.seed = 18446744073709551615U;
  out.simulator = "ode 0.16.2";
  out.status = "ok";
  out.missing = "more than 8 MiB of frames";
  out.interval_s = 0.1;
  RecordedBody table{"table", BodyKind::kFurniture, "#a0b0c0", {}, false, {}, Pose{{1, 2, 3}}};
  table.shapes = {{ShapeKind::kBox, {0.1, 0.2, 0.3}, Pose{{0, 0, 0.5}, {0, 1, 0, 0}}},
                  {ShapeKind::kSphere, {0.1, 0, 0}, {}},
                  {ShapeKind::kCylinder, {0.1, 0.4, 0}, {}},
                  {ShapeKind::kCapsule, {0.1, 0.4, 0}, {}},
                  {ShapeKind::kHull,
                   {},
                   Pose{{0, 0, 1}},
                   {{0, 0, 0}, {0.1, 0, 0}, {0, 0.2, 0}, {0, 0, 0.3}},
                   {{{0, 2, 1}}, {{0, 1, 3}}, {{0, 3, 2}}, {{1, 2, 3}}}}};
  const RecordedBody base{"base", BodyKind::kRobot, "", {}, true, {}, {}};
  const RecordedBody pad{"pad", BodyKind::kGripper, "", {}, true, 1, Pose{{0.5, 0, 0}}};
  const RecordedBody cup{"c\"u\xC3\xBCp", BodyKind::kItem, "", {}, true, {}, {}};
  const RecordedBody camera{"camera", BodyKind::kCamera, "", {}, true, {}, {}};
  out.scene.bodies = {table, base, pad, cup, camera};
  out.scene.grippers = {"left", "right"};
  out.scene.arms = {{"left", 1, 2, {0.1, 0.0, 1.0}, 0.25, 0.95}};
  out.scene.camera = RecordedCone{0.2, 0.3, 2.5};
  out.events = {{"Go(a)", 0.0, 1.25, "ok", "", {{"goal", 0.0006}, {"hit", false}}},
                {"Pick(cup)", 1.25, 2.0, "failed", "slipped: 3 N", {}}};
  out.observations = {
      {{"x", 0.1}, {"held", false}, {"n", std::int64_t{3}}, {"at", std::string("a")}},
      {{"x", 0.1}, {"held", true}, {"n", std::int64_t{3}}},
      {{"x", 0.30000000000000004}, {"held", true}, {"n", 3.0}}};
  MotionWriter writer({3, 2});
  Steps steps(7);
  for (int i = 0; i < 20; ++i) {
    const std::vector<Pose> poses = {random_pose(steps), random_pose(steps), random_pose(steps)};
    std::vector<std::uint8_t> grips(6, 0);
    grips[3] = static_cast<std::uint8_t>(i % 16);
    writer.add(0.1 * i, poses, grips);
  }
  out.frames = writer.take();
  return out;
}

}  // namespace parallax::harness
