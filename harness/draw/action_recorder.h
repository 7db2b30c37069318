#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/draw/failure_marks.h"
#include "harness/draw/scene.h"
#include "harness/robot/ode_simulator.h"

namespace parallax::harness {

/// Adds the places of the base, the hands, drawers and items as the next points of their tracks.
/// All scenes are of one world. A robot without arms has one hand, in the middle of its pads.
void extend_tracks(const Scene& scene, const std::string& base, std::vector<SceneTrack>& tracks);

double length_m(const SceneTrack& track);

/// Without the points that lie nearer than `tolerance_m` to the line through those that stay
/// (Douglas and Peucker 1973). O(n^2) at worst.
std::vector<Eigen::Vector3d> simplified(const std::vector<Eigen::Vector3d>& points,
                                        double tolerance_m);

/// Index of the moment, one for each point, at which the drawer or item of the longest way had done
/// half of it; of the longest hand's way where none has moved by more than `moved_m`. Nothing where
/// no hand has, either.
std::optional<std::size_t> half_way(const std::vector<SceneTrack>& tracks, double moved_m);

/// The boxes of `scene` that in `later` are farther away than `moved_m`, with the arms that are.
Scene elsewhere(const Scene& scene, const Scene& later, double moved_m);

/// Watches a simulator during an action, without touching it, and says afterwards what there is to
/// draw. Keeps a scene every 50 ms: about 20 kB each for a hundred boxes.
class ActionRecorder {
 public:
  /// Both outlive the recorder, which is the simulator's only watcher.
  ActionRecorder(OdeSimulator& simulator, const WorldSpec& spec);
  ~ActionRecorder();
  ActionRecorder(const ActionRecorder&) = delete;
  ActionRecorder& operator=(const ActionRecorder&) = delete;

  /// The action, as Simulator::act; then `action` tells of it and `scene` how the world stands.
  Outcome act(const std::string& controller, const State& arguments, double time_limit_s);
  const SceneAction& action() const { return action_; }
  /// The world as it stood when the action began.
  const Scene& before() const { return moments_.front().scene; }
  Scene scene() const { return scene_of(simulator_.world(), spec_); }

 private:
  struct Moment {
    double time_s = 0.0;
    Scene scene;
  };
  void take(double time_s);
  void add_tracks();
  void add_ghost();
  void add_goal(const State& arguments, const Outcome& outcome);
  void add_gaze();
  void add_sought(const State& arguments);
  void add_met(const Outcome& outcome);

  OdeSimulator& simulator_;
  const WorldSpec& spec_;
  std::vector<Moment> moments_;  // the first before the action, the last after it
  SceneAction action_;
};

}  // namespace parallax::harness
