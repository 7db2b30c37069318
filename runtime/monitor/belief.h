#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "runtime/monitor/step_query.h"
#include "runtime/monitor/step_windows.h"

namespace parallax::runtime {

struct BeliefOptions {
  std::size_t max_states = 20'000;  // states that are possible at once
  /// Number of states up to which ways from state to state are remembered, or ten times as many
  /// ways; then the memory starts anew.
  std::size_t remembered = 200'000;
  std::vector<compiler::EventId> unobserved;  // may happen without being reported
  /// Happen without being reported where the axioms demand them, and only there: in a state, and
  /// beside the other events, a subset-minimal set of them. None of them is unobserved.
  std::vector<compiler::EventId> demanded;
  /// Happen where the plan performs them, and nowhere else.
  std::vector<compiler::EventId> performed;
  const std::atomic<bool>* stop = nullptr;  // outlives the belief
};

/// Knowledge of the fluents, by FluentId: 1 holds, -1 does not, 0 is unknown.
using Observation = std::vector<std::int8_t>;

/// Fluents of which at least one holds, where it was not seen which.
using OneOfFluents = std::vector<compiler::FluentId>;

/// Report on one step: exactly these events happen, beside any of the unobserved ones. `succeeded`
/// tells whether the perform of the plan did; without a perform or a plan it says nothing.
struct ToldStep {
  std::vector<compiler::EventId> events;  // sorted
  std::optional<bool> succeeded = std::nullopt;
};

enum class Admission : std::uint8_t {
  kAdmitted,
  kRefused,    // by every state that was possible: those stay as they were
  kUndecided,  // from now on always; undecided_because() says why
};

/// A fluent whose observed value differs from the possible ones.
struct Disagreement {
  compiler::FluentId fluent;
  bool observed = false;
};

/// The possible states of a model, with the place of its plan's control, according to the reports
/// so far: exactly those in which some trace of any length is that has these events, with
/// unobserved ones anywhere between and beside them, and agrees with all observations. A step is
/// one timepoint; without a step time stands still, except for unobserved events, which the plan's
/// control may be waiting for.
///
/// Where the plan's unrolling was cut, anything that the axioms admit may follow; once nothing else
/// is possible, nothing is said any more.
///
/// States are kept one by one, at most `max_states`: beyond that nothing is said any more. Memory
/// is bounded by the options, however long it goes on. The successors of a state are asked of the
/// clauses once and remembered.
class Belief {
 public:
  /// `windows` outlives the belief.
  Belief(const StepWindows& windows, const BeliefOptions& options);

  /// Starts another log of the same model; known steps are kept.
  void restart();
  /// Takes what was seen: also, of each list of `one_of`, that at least one fluent holds.
  Admission observe(const Observation& observed, const std::vector<OneOfFluents>& one_of = {});
  /// Would the observation be admitted? It is not taken.
  bool agrees(const Observation& observed);
  Admission step(const ToldStep& told);
  /// Would the step be admitted? Changes nothing.
  bool admits(const ToldStep& told);

  /// None: there are more than can be kept, which the next observations may change.
  std::optional<std::size_t> size() const;
  std::size_t largest() const { return largest_; }  // the maximum so far
  std::size_t remembered_ways() const { return way_count_; }
  const std::string& undecided_because() const { return undecided_; }

  /// Why an observation was refused: the fluents whose observed value no possible state has; if
  /// there are none, those in which the nearest possible state differs.
  std::vector<Disagreement> disagreement(const Observation& observed);
  /// Where the plan's control may be: indices into CompiledModel::plan, ascending.
  std::vector<std::size_t> plan_steps() const;
  /// May the plan be over?
  bool plan_may_be_over() const;

 private:
  using StateId = std::uint32_t;
  using Words = std::vector<std::uint64_t>;  // phases, bits of `observed`, then of `hidden`
  struct WordsHash {
    std::size_t operator()(const Words& words) const;
  };
  /// Condition of an observation on the words of a state.
  struct Filter {
    Words mask, value;
    bool possible = true;       // false: it says that a fluent holds that never does
    std::vector<Words> one_of;  // sets of bits of which one is set at least
    friend bool operator==(const Filter&, const Filter&) = default;
    bool admits(const Words& state) const;
  };
  // Labels of unreported steps: of model and plan, and of the model alone.
  static constexpr std::uint32_t kUntold = 0, kAlone = 1, kToldFrom = 2;
  /// The plan's phase behind a cut.
  static constexpr std::uint32_t kUnknownPlan = 0xFFFFFFFF;
  static std::uint32_t axiom_phase(const Words& state) {
    return static_cast<std::uint32_t>(state[0]);
  }
  static std::uint32_t plan_phase(const Words& state) {
    return static_cast<std::uint32_t>(state[0] >> 32U);
  }
  static std::uint64_t phases(std::uint32_t axioms, std::uint32_t plan) {
    return (std::uint64_t{plan} << 32U) | axioms;
  }

  Filter filter_of(const Observation& observed, const std::vector<OneOfFluents>& one_of = {}) const;
  bool add_known(const Filter& filter, Filter& known) const;
  Admission give_up(const std::string& why);
  Admission settle();
  /// `some_admitted`, where there are too many: one of those found agrees with all.
  std::optional<std::vector<StateId>> initial_states(const Filter& known,
                                                     bool* some_admitted = nullptr);
  std::optional<std::vector<StateId>> after(const std::vector<StateId>& states,
                                            const ToldStep& told);
  std::optional<std::vector<StateId>> closed(std::vector<StateId> states);
  const std::vector<StateId>* successors(StateId state, std::uint32_t label);
  std::optional<std::vector<StateId>> ask_step(StateId state, std::uint32_t label);
  StepQuery& query(std::uint32_t axiom_phase, std::optional<std::uint32_t> plan_phase);
  void assume_state(const Words& state, std::vector<Literal>& assumptions) const;
  bool assume_events(const ToldStep& told, std::uint32_t label, StepQuestion& question) const;
  void assume_plan_after(const Words* as_before, std::vector<Literal>& assumptions) const;
  std::vector<Literal> event_literals(const std::vector<compiler::EventId>& events) const;
  Admission admit(std::vector<StateId> states);
  std::string cut_text() const;
  StateId intern(Words words);
  std::uint32_t label_of(const ToldStep& told);
  void forget();
  void take(std::vector<StateId> states);
  bool is_at_perform(const Words& state) const;
  bool is_at_cut(const Words& state) const;
  bool is_known(StateId state) const { return plan_phase(states_[state]) != kUnknownPlan; }
  static constexpr std::size_t kBits = 64;
  static bool bit(const Words& state, std::size_t place) {
    return (state[1 + place / kBits] >> (place % kBits) & 1U) != 0;
  }
  static void set_bit(Words& state, std::size_t place) {
    state[1 + place / kBits] |= std::uint64_t{1} << (place % kBits);
  }

  const StepWindows& windows_;
  BeliefOptions options_;
  std::size_t observed_count_, word_count_;
  std::vector<std::optional<std::size_t>> fluent_bit_;  // by fluent
  std::vector<std::optional<std::size_t>> plan_bit_;    // by plan step
  std::vector<std::optional<std::size_t>> cut_bit_;     // by cut of the plan
  std::vector<std::size_t> control_bits_;               // all of the plan's control
  enum class Unseen : std::uint8_t { kNever, kUnobserved, kPerformed, kDemanded };
  std::vector<Unseen> unseen_;  // by event; kPerformed: unobserved, by the plan alone
  StepLiterals literals_;
  WindowSolver start_;
  /// By window of the axioms, and of the plan; -1: of the axioms alone.
  std::map<std::pair<std::uint32_t, std::int64_t>, std::unique_ptr<StepQuery>> steps_;

  std::vector<Words> states_;
  std::unordered_map<Words, StateId, WordsHash> state_ids_;  // for look-up only, as those below
  std::vector<ToldStep> labels_;
  std::unordered_map<std::string, std::uint32_t> label_ids_;
  std::unordered_map<std::uint64_t, std::vector<StateId>> ways_;  // by label and state
  std::size_t way_count_ = 0;  // including those that lead nowhere

  bool is_settled_ = false;  // else `known_` is all that is known of the start
  Filter known_;
  bool known_is_open_ = false;     // too many states agree with `known_`
  std::vector<StateId> possible_;  // sorted
  std::pair<std::vector<StateId>, std::vector<StateId>> last_closed_;
  std::size_t largest_ = 0;
  std::string undecided_, obstacle_;
};

}  // namespace parallax::runtime
