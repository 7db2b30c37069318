#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "harness/recording/motion_stream.h"
#include "harness/simulator/protocol.h"

namespace parallax::harness {

/// Packs the poses that an external simulator reports into frames, and checks them: bodies that it
/// announced, finite places, turns that are unit quaternions, times that do not go back. Frames
/// that come faster than requested are thinned out; an error ends the recording of this simulation,
/// and nothing else.
class PoseIntake {
 public:
  /// Another simulation. Without a scene, or with an interval of 0, nothing is taken. `scene`
  /// outlives it.
  void begin(const RecordedScene* scene, double interval_s);
  /// Replaces what the reply says by `reply.outcome.motion`.
  void take(OutcomeReply& reply);

 private:
  std::string add(const PlainFrame& frame, bool last);
  std::string check_packed(const std::string& frames);
  std::string note_held(const PlainFrame& frame);

  const RecordedScene* scene_ = nullptr;
  double interval_s_ = 0.0;
  bool faulty_ = false;
  std::size_t packed_bytes_ = 0;
  std::map<std::string, std::size_t, std::less<>> index_of_;  // by name, among the moving bodies
  std::map<std::string, std::size_t, std::less<>> gripper_of_;
  std::vector<bool> placed_;  // by moving body
  std::vector<Pose> poses_;
  std::vector<std::uint8_t> grips_;
  double last_s_ = 0.0, written_s_ = 0.0;
  bool any_ = false;
  MotionWriter writer_;
};

}  // namespace parallax::harness
