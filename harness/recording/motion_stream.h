#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "harness/recording/pose.h"

namespace parallax::harness {

// Frames of moving bodies as bytes (docs/reference/formats.md): of each frame what has changed
// since the one before it, in whole steps of time, place and turn.

inline constexpr double kFrameTime_s = 1e-3;
inline constexpr double kFramePosition_m = 0.5e-3;
inline constexpr double kFrameQuaternion = 1.0 / 4096.0;
/// A place farther away is invalid [m].
inline constexpr double kFarthest_m = 1e6;
/// More of one simulation is not recorded, nor more than that at once: it goes in one line of the
/// simulators' protocol.
inline constexpr std::size_t kMaxMotionBytes = std::size_t{8} << 20U;
inline constexpr std::size_t kMaxMotionAtOnce = std::size_t{1} << 19U;

/// The relations between a gripper and a body, as bits.
enum Grip : std::uint8_t {
  kGripNearPad = 1,    // the pad that stands still touches it
  kGripFarPad = 2,     // the other one does
  kGripHeld = 4,       // it hangs in the gripper
  kGripSupported = 8,  // something that is not the robot touches it as well
};

struct MotionShape {
  std::size_t bodies = 0;    // that move
  std::size_t grippers = 0;  // whose grips are told for each of them
};

/// Packs frames. A body that has not moved by three quarters of a step stays where it was written,
/// so that what trembles on the border between two steps costs nothing.
class MotionWriter {
 public:
  explicit MotionWriter(MotionShape shape = {});

  /// The first frame of another simulation comes next; what was not taken is forgotten.
  void begin();
  /// `poses` by body; `grips` by body, then gripper, or empty: as before. Times do not go back. A
  /// frame in which nothing has changed is left out, and so is one with a pose that is not finite
  /// or farther away than kFarthest_m: then `false`.
  bool add(double time_s, std::span<const Pose> poses, std::span<const std::uint8_t> grips);
  /// The bytes since the last call.
  std::string take();
  /// The reason why frames are left out from some time on; empty: they are not.
  std::string fault() const;

 private:
  MotionShape shape_;
  std::vector<std::array<std::int64_t, 7>> written_;  // by body, in steps
  std::vector<std::uint8_t> grips_;
  std::int64_t time_ = 0;
  bool fresh_ = true;
  std::size_t total_ = 0;
  bool at_once_ = false;  // more than kMaxMotionAtOnce
  std::string bytes_, frame_;
};

/// Reads what a MotionWriter packed, frame by frame, and believes nothing: whatever the bytes are,
/// it ends, and needs no memory beyond one frame.
class MotionCursor {
 public:
  /// `bytes` outlive the cursor.
  MotionCursor(std::string_view bytes, MotionShape shape);

  /// Reads the next frame. False at the end, or where the bytes are not a frame.
  bool next();
  /// The reason why it ended before the end of the bytes; empty: it did not.
  const std::string& fault() const { return fault_; }
  std::size_t byte() const { return at_; }

  double time_s() const { return static_cast<double>(time_) * kFrameTime_s; }
  const std::vector<Pose>& poses() const { return poses_; }             // by moving body
  const std::vector<std::uint8_t>& grips() const { return grips_; }     // by body, then gripper
  const std::vector<std::size_t>& moved() const { return moved_; }      // moving bodies, ascending
  const std::vector<std::size_t>& gripped() const { return gripped_; }  // in grips(), ascending

 private:
  bool fail(const char* why);
  bool varint(std::uint64_t& out);
  bool read_poses();
  bool read_pose(std::size_t body);
  bool read_grips();

  std::string_view bytes_;
  MotionShape shape_;
  std::size_t at_ = 0;
  std::int64_t time_ = 0;
  std::vector<std::array<std::int64_t, 7>> steps_;
  std::vector<Pose> poses_;
  std::vector<std::uint8_t> grips_;
  std::vector<std::size_t> moved_;
  std::vector<std::size_t> gripped_;
  std::string fault_;
};

}  // namespace parallax::harness
