#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "harness/recording/motion_stream.h"
#include "harness/recording/recorded_scene.h"

namespace parallax::harness {

/// Named values, as the simulator reports them.
using RecordedValues =
    std::map<std::string, std::variant<bool, std::int64_t, double, std::string>, std::less<>>;

/// An event, its time and its result.
struct RecordedEvent {
  std::string name;                   // "Go(bTable)"
  double begin_s = 0.0, end_s = 0.0;  // simulated time since the start
  std::string status;                 // "ok", "failed", "truncated"
  std::string reason;
  RecordedValues margins;
  friend bool operator==(const RecordedEvent&, const RecordedEvent&) = default;
};

/// One simulation as it went.
struct Recording {
  std::int64_t trace = 0, sample = 0;  // as the journal numbers them
  std::uint64_t seed = 0;
  std::string simulator;    // "ode 0.16.2"
  std::string status;       // "ok" or "lost", as in the journal
  std::string missing;      // why motion is missing from some time on; empty: it is whole
  double interval_s = 0.0;  // between frames, where something moves
  RecordedScene scene;
  std::vector<RecordedEvent> events;
  std::vector<RecordedValues> observations;  // at the start and after each event
  std::string frames;                        // packed: a MotionCursor reads them
  friend bool operator==(const Recording&, const Recording&) = default;
};

/// Goes through the frames of a recording, which outlives it.
///
///     for (Playback at(recording); at.next();) draw(at.time_s(), at.pose_of(body));
class Playback {
 public:
  explicit Playback(const Recording& recording)
      : scene_(recording.scene),
        moving_(recording.scene.moving()),
        index_of_(recording.scene.bodies.size(), 0),
        cursor_(recording.frames, {moving_.size(), recording.scene.grippers.size()}) {
    for (std::size_t i = 0; i < moving_.size(); ++i) index_of_[moving_[i]] = i;
  }

  bool next() { return cursor_.next(); }
  double time_s() const { return cursor_.time_s(); }
  const MotionCursor& cursor() const { return cursor_; }
  /// The pose of the body of this number in the world.
  Pose pose_of(std::size_t body) const {
    const auto& spec = scene_.bodies[body];
    if (!spec.moves) return spec.pose;
    if (spec.on) return composed(cursor_.poses()[index_of_[*spec.on]], spec.pose);
    return cursor_.poses()[index_of_[body]];
  }
  /// The relation between a gripper and a body: bits of Grip.
  std::uint8_t grip_of(std::size_t body, std::size_t gripper) const {
    const auto& spec = scene_.bodies[body];
    if (!spec.moves || spec.on) return 0;
    return cursor_.grips()[index_of_[body] * scene_.grippers.size() + gripper];
  }

 private:
  const RecordedScene& scene_;
  std::vector<std::size_t> moving_;    // numbers of bodies
  std::vector<std::size_t> index_of_;  // by body, in moving_
  MotionCursor cursor_;
};

}  // namespace parallax::harness
