#pragma once

#include <string>
#include <vector>

#include "harness/draw/scene.h"
#include "harness/robot/ode_simulator.h"

namespace parallax::harness {

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
