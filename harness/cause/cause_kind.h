#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/base/word_table.h"
#include "harness/cause/failure_rule.h"
#include "harness/cause/state_rule.h"

namespace parallax::harness {

/// The kind of cause that makes simulations of one trace fail in one way.
enum class CauseKind : std::uint8_t {
  kUnknown,    // the runs do not tell
  kAlways,     // every run fails: an axiom is wrong
  kRegion,     // runs fail in a part of the start region
  kRandom,     // from one and the same start runs fail or do not: the outcome is open
  kSimulator,  // the same where the world is a simulator: its seed alone decides
  kState,      // every run fails in some initial states and none in others: a condition is missing
};
inline constexpr auto kCauseKindWords =
    base::word_table<CauseKind>("unknown", "always", "region", "random", "simulator", "state");
constexpr std::string_view to_string(CauseKind kind) { return kCauseKindWords.of(kind); }

/// Counts of repetitions from one failing start, and of those that failed again.
struct Persistence {
  std::int64_t runs = 0, failures = 0;
  bool in_most() const { return 2 * failures >= runs; }
};

/// The border where a failing start, moved along one parameter, stops failing: both values were
/// simulated.
struct CauseBorder {
  std::string parameter;
  double fails = 0.0, other = 0.0;
};

struct CauseFinding {
  CauseKind kind = CauseKind::kUnknown;
  std::int64_t runs = 0, failures = 0;
  /// Starts, equal to the last bit, from which some runs fail and others do not.
  std::int64_t contradictory_starts = 0;
  std::optional<FailureRule> rule;
  /// The initial states that most failures begin in, where the runs show that.
  std::optional<StateRule> where;
  /// Persistence of a failing start with other seeds of the simulator, and with half its step.
  std::optional<Persistence> other_seeds, half_step;
  /// The borders found by moving a failing start. Each of these, alone, ends the failure.
  std::vector<CauseBorder> borders;
};

/// `is_model`: the world is a model, so that what differs from one start is its open outcome.
CauseFinding tell_cause(const std::vector<CauseRun>& runs, bool is_model);

/// Takes into account the initial states of the same runs.
void weigh_states(const std::vector<StateRun>& runs, CauseFinding& finding);

/// Takes into account whether it happens again from the failing start: where the runs tell nothing
/// else and it does not in most of either kind, the simulator is in doubt.
void weigh_persistence(std::optional<Persistence> other_seeds, std::optional<Persistence> half_step,
                       CauseFinding& finding);

/// Takes into account where a failing start that was moved stops failing (shrink_start): if the
/// runs tell nothing else, it is the region, and one or two borders, of parameters that the runs
/// have, are its rule.
void weigh_borders(const std::vector<CauseBorder>& borders, const std::vector<CauseRun>& runs,
                   const std::vector<std::string>& parameters, CauseFinding& finding);

/// "`milk1.mass` > 0.98 and `robot.x` <= 0.7"
std::string rule_text(const std::vector<Border>& borders,
                      const std::vector<std::string>& parameters);

/// Describes the finding, with the counts behind it, in one or two sentences; contradictory runs
/// first. Of initial states state_words tells.
std::string cause_words(const CauseFinding& finding, const std::vector<std::string>& parameters);

}  // namespace parallax::harness
