#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string_view>

#include "compiler/base/word_table.h"
#include "harness/simulator/simulator.h"

namespace parallax::harness {

/// The cause of failing runs in a synthetic simulator, and how a failure shows. Each kind fails
/// with a probability that is known exactly.
enum class SyntheticKind : std::uint8_t {
  kByStart,       // in a part of the start region
  kBySeed,        // by the seed that it is handed
  kNoisy,         // by random numbers of its own; it takes no seed
  kRefusing,      // as by start; half of all starts are refused
  kLosing,        // as by start, and then it says that it is lost; the same again when repeated
  kCrashFirst,    // as noisy, and then the process ends instead of showing it; it takes no seed
  kSlow,          // as by start; runs that go wrong take longer than others
  kTwoTraces,     // run i of the second trace goes wrong only where that of the first does not
  kOneSound,      // as by start in the second trace; the first never goes wrong
  kOneFailing,    // as by start in the second trace; the first always goes wrong
  kStates,        // three initial states; p is the mean, and none, as much and twice that is theirs
  kLosingStates,  // likewise, and then it says that it is lost
  kWeightedStates,  // three initial states of weights; p is the mean by them, and without them
};
inline constexpr auto kSyntheticWords = base::word_table<SyntheticKind>(
    "by-start", "by-seed", "noisy", "refusals", "losses", "crash-first", "slow", "two-traces",
    "one-sound", "one-failing", "states", "losing-states", "weighted-states");
constexpr bool has_states(SyntheticKind kind) {
  return kind == SyntheticKind::kStates || kind == SyntheticKind::kLosingStates ||
         kind == SyntheticKind::kWeightedStates;
}
/// So many initial states they have, a metre apart.
inline constexpr std::int64_t kSyntheticStates = 3;
/// The weights of those of kWeightedStates.
inline constexpr std::array<double, kSyntheticStates> kSyntheticWeights = {2.0, 1.0, 1.0};
/// How many times as likely as in the mean a run from this initial state, from 0, goes wrong.
constexpr double synthetic_factor(SyntheticKind kind, std::size_t state) {
  constexpr std::array<double, kSyntheticStates> kEqual = {0.0, 1.0, 2.0},
                                                 kWeighted = {1.0, 0.0, 2.0};
  return kind == SyntheticKind::kWeightedStates ? kWeighted[state] : kEqual[state];
}
constexpr std::string_view to_string(SyntheticKind kind) { return kSyntheticWords.of(kind); }

/// Where a box lies at first [m], where `push-left` and `push-right` bring it to, and what else
/// there is between them. A push that goes wrong leaves it where it is.
inline constexpr double kSyntheticStart_m = 3.0, kSyntheticGoal_m = 0.0;
/// The end position of the box for a start, `x_m` from its cell's lower end.
double synthetic_end_m(double x_m);

/// One start region, one action, and a probability of going wrong.
class SyntheticSimulator final : public Simulator {
 public:
  struct Options {
    SyntheticKind kind = SyntheticKind::kByStart;
    double probability = 0.0;  // that a run goes wrong
    std::uint64_t key = 0;     // of its own random numbers
    /// Counts draws of its own by its size, so that a process that follows a crashed one goes on
    /// with fresh ones. Empty: counted in memory.
    std::filesystem::path draws;
    bool ends_process = false;  // a crash is one; else it is a loss
  };
  explicit SyntheticSimulator(Options options) : options_(std::move(options)) {}

  SimulatorInfo info() override;
  Outcome reset(const State& initial, std::uint64_t seed) override;
  Outcome act(std::string_view action, const State& arguments, double sim_time_limit_s) override;
  State observe() override;

 private:
  double own_draw(std::uint64_t stream, std::uint64_t index) const;
  std::uint64_t next_draw();
  bool goes_wrong(std::string_view action);
  double in_cell_m() const;

  Options options_;
  double start_m_ = 0.0, box_m_ = 0.0;
  std::uint64_t seed_ = 0, draws_made_ = 0;
  std::uint64_t pushes_[2] = {0, 0};
};

}  // namespace parallax::harness
