#include "harness/draw/action_recorder.h"

#include <algorithm>
#include <cmath>

namespace parallax::harness {
namespace {

constexpr double kEvery_s = 0.05;  // as recordings

}  // namespace

ActionRecorder::ActionRecorder(OdeSimulator& simulator, const WorldSpec& spec)
    : simulator_(simulator),
      spec_(spec),
      every_(std::max<std::int64_t>(1, std::llround(kEvery_s / spec.solver.timestep_s))) {
  simulator_.watch(
      [](void* context, double time_s, const OdeSimulator&) {
        auto& recorder = *static_cast<ActionRecorder*>(context);
        if (++recorder.steps_ % recorder.every_ == 0) recorder.take(time_s);
      },
      this);
}

ActionRecorder::~ActionRecorder() { simulator_.watch(nullptr, nullptr); }

void ActionRecorder::take(double time_s) { seen_.moments.push_back({time_s, scene()}); }

Outcome ActionRecorder::act(const std::string& controller, const State& arguments,
                            double time_limit_s) {
  action_ = SceneAction{};
  seen_ = SeenAction{controller, arguments, {}, {}, {}, {}};
  take(0.0);
  seen_.outcome = simulator_.act(controller, arguments, time_limit_s);
  if (seen_.outcome.status == SimStatus::kLost) return seen_.outcome;  // no position means anything
  take(seen_.outcome.sim_time_s);
  seen_.gaze = simulator_.gaze();
  seen_.after = simulator_.state();
  action_ = action_marks(seen_, spec_);
  return seen_.outcome;
}

}  // namespace parallax::harness
