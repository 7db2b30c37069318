#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/draw/action_marks.h"
#include "harness/recording/recording.h"
#include "harness/world/world_spec.h"

namespace parallax::harness {

/// Why a recording cannot show this world: bodies, arms and camera are others; empty: it can.
std::string unlike_world(const Recording& recording, const WorldSpec& spec);

/// Tells of the actions of a recording, one after the other, as an ActionRecorder does of those of
/// a simulator. No simulator takes part. Where bodies are at the beginning and end of an action is
/// as exact as it was observed, in between as it was recorded.
class RecordedActions {
 public:
  /// Both outlive this. `unlike_world` says nothing of them, or the simulator was another program,
  /// of whose bodies `spec` need not know.
  RecordedActions(const Recording& recording, const WorldSpec& spec);

  /// The next one, which these arguments were given to; kLost where the recording has no more.
  Outcome act(const std::string& controller, const State& arguments);
  const SceneAction& action() const { return action_; }
  const std::vector<SceneMoment>& moments() const { return seen_.moments; }
  const Scene& before() const { return seen_.moments.front().scene; }
  const Scene& scene() const { return scene_; }

 private:
  void read_frame();
  void observe(std::size_t timepoint);
  Scene shown() const;
  std::string base() const;
  std::optional<Gaze> gaze() const;
  std::optional<Eigen::Vector3d> place_in_world(const PlaceSpec& place) const;
  void look(const std::string& controller, const State& arguments, const Outcome& outcome);

  const Recording& recording_;
  const WorldSpec& spec_;
  Playback playback_;
  bool is_ahead_ = false;    // the playback stands at a frame that was not read
  std::vector<Pose> poses_;  // by body
  std::size_t next_ = 0;     // event
  std::optional<PlaceSpec> looked_at_;
  Scene scene_;
  SeenAction seen_;
  SceneAction action_;
};

}  // namespace parallax::harness
