#include "harness/world/controller.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace parallax::harness {
namespace {

constexpr double kPatience = 2.0;      // times the nominal duration of a motion
constexpr double kLeastLimit_s = 0.3;  // so that a motion of no distance can end

}  // namespace

std::string metres(double value_m) { return fmt::format("{:.3f} m", value_m); }

std::optional<Outcome> PhasedController::tick(double time_s) {
  if (refusal_) return refusal_;
  while (current_ < phases_.size()) {
    const Phase& phase = phases_[current_];
    if (!begun_) {
      phase_end_s_ = time_s + phase.begin();
      begun_ = true;
    }
    const bool done = phase.done();
    if (!done && time_s < phase_end_s_) return std::nullopt;
    if (!done && overdue_.empty()) overdue_ = phase.name;
    ++current_;
    begun_ = false;
  }
  return judge(overdue_);
}

void PhasedController::add(std::string_view name, std::function<double()> begin,
                           std::function<bool()> done) {
  phases_.push_back(Phase{name, std::move(begin), std::move(done)});
}

void PhasedController::add_pause(std::string_view name, double duration_s) {
  // `done` is never true before the limit; a pause that ends is not overdue, hence the clock here.
  const auto steps = static_cast<std::int64_t>(std::ceil(duration_s / context_.world.timestep_s()));
  add(
      name, [duration_s] { return duration_s + kLeastLimit_s; },
      [left = steps]() mutable { return left-- <= 0; });
}

void PhasedController::add_move(std::string_view name, Axis axis, std::function<double()> target,
                                Motion motion) {
  add(
      name,
      [this, axis, target = std::move(target), motion] {
        const double goal_m = target();
        robot().move_to(axis, goal_m, motion);
        return kPatience * nominal_time_s(goal_m - robot().position_m(axis), motion) +
               kLeastLimit_s;
      },
      [this, axis] { return robot().at_rest(axis); });
}

void PhasedController::refuse(std::string reason, State margins) {
  refusal_ = Outcome{SimStatus::kFailed, std::move(reason), 0.0, std::move(margins)};
}

}  // namespace parallax::harness
