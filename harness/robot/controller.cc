#include "harness/robot/controller.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "harness/robot/mobile_controller.h"

namespace parallax::harness {
namespace {

constexpr double kPatience = 2.0;      // times the nominal duration of a motion
constexpr double kLeastLimit_s = 0.3;  // so that a motion of no distance can end
constexpr double kCloseGrace_s = 0.5;
constexpr double kBraking_s = 1.0;  // limit
constexpr int kSupportSteps = 5;    // of contact in a row before a load counts as supported

struct NamedFactory {
  std::string_view name;  // in controllers()
  ControllerFactory make;
};

constexpr std::array<NamedFactory, 16> kFactories = {{
    {"close-door", &make_close_door},
    {"close-drawer", &make_close_drawer},
    {"detect", &make_detect},
    {"drive", &make_drive},
    {"going", &make_going},
    {"look", &make_look},
    {"move-torso", &make_move_torso},
    {"open-door", &make_open_door},
    {"open-drawer", &make_open_drawer},
    {"open-gripper", &make_open_gripper},
    {"park", &make_park},
    {"pick-up", &make_pick_up},
    {"picking-up", &make_picking_up},
    {"place", &make_place},
    {"placing", &make_placing},
    {"regrip", &make_regrip},
}};

}  // namespace

ControllerFactory find_factory(std::string_view name) {
  const auto found = std::find_if(kFactories.begin(), kFactories.end(),
                                  [&](const NamedFactory& one) { return one.name == name; });
  return found == kFactories.end() ? nullptr : found->make;
}

std::string metres(double value_m) { return fmt::format("{:.3f} m", value_m); }

double patience_s(double distance_m, const Motion& motion) {
  return kPatience * nominal_time_s(distance_m, motion) + kLeastLimit_s;
}

double closing_time_s(double opening_m, double speed_m_s, double hold_s) {
  return opening_m / speed_m_s + hold_s + kCloseGrace_s;
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
    const ActionPhase& phase = phases_[current_];
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
  ActionPhase phase{name, std::move(begin), std::move(done)};
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

void PhasedController::add_braking(std::function<void()> brake, std::function<bool()> at_rest) {
  add(
      "braking",
      [brake = std::move(brake)] {
        brake();
        return kBraking_s;
      },
      std::move(at_rest));
}

std::string PhasedController::with_overdue(std::string reason, std::string_view overdue) {
  if (!overdue.empty()) reason += fmt::format(" ({} did not come to its end)", overdue);
  return reason;
}

bool PhasedController::supported(BodyId load) {
  return support_.note(world().touch(load).support) >= kSupportSteps;
}

}  // namespace parallax::harness
