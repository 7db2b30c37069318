#include "harness/calibration/synthetic_simulator.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

#include "compiler/base/descriptor.h"
#include "harness/sampling/sampler.h"

namespace parallax::harness {
namespace {

constexpr auto kSlowRun = std::chrono::milliseconds(20);

}  // namespace

double synthetic_end_m(double x_m) { return kSyntheticGoal_m + 0.4 + 0.2 * x_m; }

SimulatorInfo SyntheticSimulator::info() {
  const bool own = options_.kind == SyntheticKind::kNoisy ||
                   options_.kind == SyntheticKind::kCrashFirst ||
                   options_.kind == SyntheticKind::kTwoTraces;
  return {"synthetic",
          std::string(to_string(options_.kind)),
          own ? "none" : "bitwise",
          !own,
          {{"box.x", "m", true}},
          {"push-left", "push-right"},
          0.01};
}

Outcome SyntheticSimulator::reset(const State& initial, std::uint64_t seed) {
  const auto found = initial.find("box.x");
  const auto* value = found == initial.end() ? nullptr : std::get_if<double>(&found->second);
  if (value == nullptr) return {SimStatus::kUnsupported, "no start of the box", 0.0, {}};
  start_m_ = box_m_ = *value;
  seed_ = seed;
  const bool refused =
      options_.kind == SyntheticKind::kRefusing && start_m_ - kSyntheticStart_m >= 0.5;
  if (refused) return {SimStatus::kInvalidStart, "the box overlaps the wall by 3 mm", 0.0, {}};
  return {};
}

double SyntheticSimulator::own_draw(std::uint64_t stream, std::uint64_t index) const {
  return CounterRng({.campaign_seed = options_.key, .trace_key = stream, .sample = index})
      .uniform(0);
}

/// The number of a draw of its own that no other attempt had.
std::uint64_t SyntheticSimulator::next_draw() {
  if (options_.draws.empty()) return draws_made_++;
  const base::Descriptor file(
      ::open(options_.draws.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600));
  const auto size = ::lseek(file.get(), 0, SEEK_END);
  return ::write(file.get(), "x", 1) == 1 && size >= 0 ? static_cast<std::uint64_t>(size) : 0;
}

/// Cells are one metre wide, one for each initial state.
double SyntheticSimulator::in_cell_m() const {
  const double x = start_m_ - kSyntheticStart_m;
  return x - std::floor(x);
}

bool SyntheticSimulator::goes_wrong(std::string_view action) {
  const double p = options_.probability, x = in_cell_m();
  const bool second = action == "push-right";
  switch (options_.kind) {
    case SyntheticKind::kByStart:
    case SyntheticKind::kLosing:
    case SyntheticKind::kSlow:
      return x < p;
    case SyntheticKind::kRefusing:
      return x < 0.5 * p;
    case SyntheticKind::kBySeed:
      return own_draw(1, seed_) < p;
    case SyntheticKind::kNoisy:
    case SyntheticKind::kCrashFirst:
      return own_draw(2, next_draw()) < p;
    case SyntheticKind::kOneSound:
      return second && x < p;
    case SyntheticKind::kOneFailing:
      return !second || x < p;
    case SyntheticKind::kStates:
    case SyntheticKind::kLosingStates:
    case SyntheticKind::kWeightedStates: {
      constexpr auto kLast = static_cast<double>(kSyntheticStates - 1);
      const auto state =
          static_cast<std::size_t>(std::clamp(start_m_ - kSyntheticStart_m, 0.0, kLast));
      return x < p * synthetic_factor(options_.kind, state);
    }
    case SyntheticKind::kTwoTraces:
      break;
  }
  const double draw = own_draw(3, pushes_[second ? 1 : 0]++);
  return second ? draw >= 1.0 - p : draw < p;
}

Outcome SyntheticSimulator::act(std::string_view action, const State&, double) {
  if (action != "push-left" && action != "push-right") {
    return {SimStatus::kUnsupported, "no such action", 0.0, {}};
  }
  if (!goes_wrong(action)) {
    box_m_ = synthetic_end_m(in_cell_m());
    return {SimStatus::kOk, "", 0.1, {}};
  }
  if (options_.kind == SyntheticKind::kCrashFirst && options_.ends_process) ::_exit(1);
  if (options_.kind == SyntheticKind::kCrashFirst || options_.kind == SyntheticKind::kLosing ||
      options_.kind == SyntheticKind::kLosingStates) {
    return {SimStatus::kLost, "numbers blew up", 0.0, {}};
  }
  if (options_.kind == SyntheticKind::kSlow) std::this_thread::sleep_for(kSlowRun);
  return {SimStatus::kFailed, "stuck", 0.1, {}};
}

State SyntheticSimulator::observe() { return {{"box.x", box_m_}}; }

}  // namespace parallax::harness
