#include "harness/robot/controller.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace parallax::harness {
namespace {

constexpr double kPatience = 2.0;      // times the nominal duration of a motion
constexpr double kLeastLimit_s = 0.3;  // so that a motion of no distance can end

}  // namespace

std::string metres(double value_m) { return fmt::format("{:.3f} m", value_m); }

double patience_s(double distance_m, const Motion& motion) {
  return kPatience * nominal_time_s(distance_m, motion) + kLeastLimit_s;
}

std::optional<Outcome> PhasedController::tick(double time_s) {
  if (refusal_) return refusal_;
  while (current_ < phases_.size()) {
    if (!begun_) {
      insert_at_ = current_ + 1;
      const auto begin = phases_[current_].begin;  // the list may grow meanwhile
      phase_end_s_ = time_s + begin();
      insert_at_.reset();
      begun_ = true;
      if (refusal_) return refusal_;
    }
    const Phase& phase = phases_[current_];
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
  Phase phase{name, std::move(begin), std::move(done)};
  if (!insert_at_) {
    phases_.push_back(std::move(phase));
    return;
  }
  phases_.insert(phases_.begin() + static_cast<std::ptrdiff_t>(*insert_at_), std::move(phase));
  ++*insert_at_;
}

void PhasedController::add_pause(std::string_view name, double duration_s) {
  // `done` is never true before the limit; a pause that ends is not overdue, hence the clock here.
  const auto steps = static_cast<std::int64_t>(std::ceil(duration_s / context_.world.timestep_s()));
  add(
      name, [duration_s] { return duration_s + kLeastLimit_s; },
      [left = steps]() mutable { return left-- <= 0; });
}

void PhasedController::add_step(std::function<void()> what) {
  add(
      "step",
      [what = std::move(what)] {
        what();
        return 0.0;
      },
      [] { return true; });
}

void PhasedController::refuse(std::string reason, State margins) {
  refusal_ = Outcome{SimStatus::kFailed, std::move(reason), 0.0, std::move(margins)};
}

}  // namespace parallax::harness
