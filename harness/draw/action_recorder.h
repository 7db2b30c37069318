#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "harness/draw/action_marks.h"
#include "harness/draw/failure_marks.h"
#include "harness/draw/scene_motion.h"
#include "harness/robot/ode_simulator.h"

namespace parallax::harness {

/// Watches a simulator during an action, without touching it, and says afterwards what there is to
/// draw. Keeps a scene every 50 ms of simulated time since it began to watch: those moments that a
/// recording has as well.
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
  const std::vector<SceneMoment>& moments() const { return seen_.moments; }
  /// The world as it stood when the action began.
  const Scene& before() const { return seen_.moments.front().scene; }
  Scene scene() const { return scene_of(simulator_.world(), spec_); }

 private:
  void take(double time_s);

  OdeSimulator& simulator_;
  const WorldSpec& spec_;
  std::int64_t every_ = 1, steps_ = 0;
  SeenAction seen_;
  SceneAction action_;
};

}  // namespace parallax::harness
