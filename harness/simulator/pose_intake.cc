#include "harness/simulator/pose_intake.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace parallax::harness {
namespace {

constexpr double kLatest_s = 1e9;
constexpr double kOffUnit = 0.02;  // of the square of a quaternion's norm
// Frames nearer to each other than this share of the interval are more than was asked for.
constexpr double kNearest = 0.5;

/// Makes the turn of a pose a unit quaternion. Returns the fault of the pose; empty: none.
std::string mend(Pose& pose) {
  double norm = 0.0;
  for (const double x : pose.q) norm += x * x;
  for (const double x : pose.p) {
    if (!(std::abs(x) < kFarthest_m)) return "has a place that is not finite, or beyond 1e6 m";
  }
  if (!(std::abs(norm - 1.0) <= kOffUnit)) return "has a turn that is no unit quaternion w-x-y-z";
  for (double& x : pose.q) x /= std::sqrt(norm);
  return {};
}

}  // namespace

void PoseIntake::begin(const RecordedScene* scene, double interval_s) {
  scene_ = interval_s > 0.0 ? scene : nullptr;
  interval_s_ = interval_s;
  faulty_ = any_ = false;
  packed_bytes_ = 0;
  last_s_ = written_s_ = 0.0;
  if (scene_ == nullptr) return;
  index_of_.clear();
  gripper_of_.clear();
  const auto moving = scene_->moving();
  for (std::size_t i = 0; i < moving.size(); ++i) index_of_[scene_->bodies[moving[i]].name] = i;
  for (std::size_t i = 0; i < scene_->grippers.size(); ++i) gripper_of_[scene_->grippers[i]] = i;
  placed_.assign(moving.size(), false);
  poses_.assign(moving.size(), Pose());
  grips_.assign(moving.size() * scene_->grippers.size(), 0);
  writer_ = MotionWriter({moving.size(), scene_->grippers.size()});
}

void PoseIntake::take(OutcomeReply& reply) {
  auto& motion = reply.outcome.motion;
  const auto frames = std::exchange(reply.frames, {});
  if (scene_ == nullptr || faulty_) {
    motion = {};
    return;
  }
  std::string packed = std::exchange(motion.frames, {});
  if (!packed.empty()) {
    auto why = frames.empty() ? check_packed(packed) : "it sends `poses` and `motion`";
    // A fault that the simulator reports about motion after them does not make them wrong.
    if (why.empty()) motion.frames = std::move(packed);
    if (motion.fault.empty()) motion.fault = std::move(why);
  }
  for (std::size_t i = 0; i < frames.size() && motion.fault.empty(); ++i) {
    motion.fault = add(frames[i], i + 1 == frames.size());
  }
  faulty_ = !motion.fault.empty();
  if (!frames.empty()) motion.frames = writer_.take();
}

/// They are read when the recording is made; here it only counts how much there is.
std::string PoseIntake::check_packed(const std::string& frames) {
  packed_bytes_ += frames.size();
  return packed_bytes_ <= kMaxMotionBytes ? "" : "more than 8 MiB of frames";
}

std::string PoseIntake::note_held(const PlainFrame& frame) {
  if (!frame.held) return {};
  std::fill(grips_.begin(), grips_.end(), std::uint8_t{0});
  for (const auto& [name, gripper] : *frame.held) {
    const auto body = index_of_.find(name);
    if (body == index_of_.end()) return fmt::format("no moving body `{}` was announced", name);
    const auto by = gripper_of_.find(gripper);
    if (by == gripper_of_.end()) return fmt::format("no gripper `{}` was announced", gripper);
    grips_[body->second * gripper_of_.size() + by->second] = kGripHeld;
  }
  return {};
}

std::string PoseIntake::add(const PlainFrame& frame, bool last) {
  if (!(frame.time_s >= last_s_ && frame.time_s <= kLatest_s)) {
    return fmt::format("a frame at {} s follows one at {} s", frame.time_s, last_s_);
  }
  last_s_ = frame.time_s;
  for (const auto& [name, given] : frame.poses) {
    const auto body = index_of_.find(name);
    if (body == index_of_.end()) return fmt::format("no moving body `{}` was announced", name);
    auto pose = given;
    if (const auto why = mend(pose); !why.empty()) return fmt::format("`{}` {}", name, why);
    poses_[body->second] = pose;
    placed_[body->second] = true;
  }
  if (auto why = note_held(frame); !why.empty()) return why;
  if (!any_) {
    const auto missing = std::find(placed_.begin(), placed_.end(), false);
    if (missing != placed_.end()) {
      const auto moving = scene_->moving();
      const auto body = moving[static_cast<std::size_t>(missing - placed_.begin())];
      return fmt::format("the first frame does not say where `{}` is", scene_->bodies[body].name);
    }
  }
  const bool too_soon = any_ && frame.time_s - written_s_ < kNearest * interval_s_;
  if (too_soon && !last) return {};
  writer_.add(frame.time_s, poses_, grips_);
  written_s_ = frame.time_s;
  any_ = true;
  return writer_.fault();
}

}  // namespace parallax::harness
