#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "compiler/base/word_table.h"
#include "runtime/enumerate/path_admission.h"
#include "runtime/enumerate/trace_source.h"
#include "runtime/session/solver_session.h"
#include "runtime/symmetry/lex_leader.h"
#include "runtime/trace/trace.h"

namespace parallax::runtime {

/// State of knowledge about the traces that were not reported.
enum class Exploration : std::uint8_t {
  kStopped,            // nobody asked for all of them yet, or the solver gave up
  kCompleteUpToBound,  // there are longer executions than the horizon admits
  kAllTracesExplored,  // a solver call proved that no execution is left
};
inline constexpr auto kExplorationWords =
    base::word_table<Exploration>("stopped", "complete up to bound", "all traces explored");
constexpr std::string_view to_string(Exploration exploration) {
  return kExplorationWords.of(exploration);
}

struct PlanEnumeratorOptions {
  /// Every prefix that ends in a hit is a trace, not only the one up to the first hit.
  bool all_hits = false;
  /// Every initial state is a trace of its own, not only every key.
  bool split_initial = false;
  /// Order of the traces of one length; shorter ones come first in any case. With any order any
  /// initial state stands for a trace.
  TraceOrder order = TraceOrder::kCanonical;
  /// Symmetries of the session's model. The first trace is sought among representatives of orbits;
  /// with `representatives` all are, at least one of each orbit of keys. Null: no symmetry is used.
  const ModelSymmetry* symmetry = nullptr;
  bool representatives = false;
};

/// Where executions go on that were not followed: none of them met the constraints before.
struct OpenEnds {
  std::vector<std::size_t> cuts;    // of CompiledModel::plan_cuts, ascending: reached
  std::optional<std::size_t> step;  // the first of CompiledModel::plan that would come next
};

/// A trace with the events of another one, from an initial state that was asked for.
struct TraceFrom {
  /// Does the model have one? Undecided if the solver was stopped.
  base::Known exists = base::Known::kUndecided;
  std::optional<Trace> trace;  // if so
};

/// The traces of a model (with or without a plan) that end where the state constraints hold for
/// the first time, at the first timepoint that has a hit atom (1, of a violation 0) or later, and
/// that the model can continue to its horizon. A prefix that cannot go on is no trace. Two
/// traces are one if their event sequences and the objects that their performs returned are equal;
/// the first initial state in canonical order stands for them. Shortest first; among equals the
/// order of the model's events decides. Deterministic: the order does not depend on the solver's.
class PlanEnumerator {
 public:
  /// `session` outlives the enumerator; its model has state constraints.
  explicit PlanEnumerator(SolverSession& session, const PlanEnumeratorOptions& options = {});
  /// None if there is no further one, or the solver was stopped on the way to it: `exploration`
  /// tells. Whether there are others like it may be undecided in a trace that was found before.
  std::optional<Trace> next();
  /// Final once `next` has answered none.
  Exploration exploration() const { return exploration_; }
  /// Why it is complete up to the bound only.
  const OpenEnds& open_ends() const { return open_ends_; }

  /// The first length at which the constraints are met by prefixes that cannot go on to the horizon
  /// and whose key no trace has. Only lengths without further traces are known to have one.
  std::optional<Timepoint> dead_end() const { return dead_end_; }

  /// That there are no others was found for one trace of each orbit only.
  bool by_symmetry() const { return by_symmetry_; }

  /// Does the model admit, for the trace's events and initial state, a last state in which each of
  /// these fluents has the value given, and which it can continue? The initial state is that of the
  /// trace in every fluent, or in those of `start_fluents` if it is given. At most two solver
  /// calls.
  base::Known admits(const Trace& trace,
                     const std::vector<std::map<compiler::FluentId, bool>>& observed,
                     const std::vector<compiler::FluentId>* start_fluents = nullptr);

  /// The initial states that lead to the key of a trace that was given, each as its true ones of
  /// `fluents`, in the order of their members; states that agree on these are one. At most `limit`
  /// of them, with one solver call each and one more.
  InitialStates initial_states(const Trace& trace, std::span<const compiler::FluentId> fluents,
                               std::size_t limit);
  /// Groups of `fluents` that clauses about timepoint 0 connect, each with the values that it can
  /// have by itself in an initial state that leads to the key; every initial state is one value of
  /// each group. No groups where one has more than `limit` values. None: stopped.
  std::optional<std::vector<std::vector<std::vector<compiler::FluentId>>>> initial_parts(
      const Trace& trace, std::span<const compiler::FluentId> fluents, std::size_t limit);
  /// The first trace, in canonical order, with the key of `trace`, which was given, and an initial
  /// state in which exactly `state` of `fluents` hold. `state` is ascending.
  TraceFrom from(const Trace& trace, std::span<const compiler::FluentId> fluents,
                 const std::vector<compiler::FluentId>& state);
  /// Names of the ids in the traces.
  const Symbols& symbols() const { return symbols_; }

 private:
  std::optional<Literal> breaking();
  bool asks_all_lengths() const;
  bool may_hit_after(Timepoint n);
  void note_refuted(std::optional<Literal> breaking);
  base::Known has_alternative(Timepoint n, std::span<const Literal> fixed,
                              std::span<const Literal> different);
  void note_alternatives(std::span<const Literal> fixed, std::size_t length, Trace& trace);
  /// The literals that tell executions of one length apart, most important first.
  struct Orders {
    /// Happens before the end, then what performs returned, by time and name; true preferred: the
    /// trace's key.
    std::vector<Literal> key;
    std::vector<Literal> start;  // HoldsAt at 0, false preferred
    std::vector<Literal> state;  // HoldsAt from 1 on, false preferred
    /// Free choices of the plan, true preferred: of the same events the ways that the text names
    /// first.
    std::vector<Literal> choice;
  };
  Orders orders_of(Timepoint n) const;
  std::vector<Literal> hit_at(Timepoint n) const;
  /// Literals that fix the length and the key of a trace that was given.
  std::vector<Literal> key_of(const Trace& trace) const;
  std::optional<std::vector<Literal>> settle(Timepoint n, const Orders& orders,
                                             const std::vector<Literal>& assumptions,
                                             const std::vector<Literal>& searched);
  SolveStatus find_settled(Timepoint n, const Orders& orders,
                           const std::vector<Literal>& assumptions,
                           const std::vector<Literal>& searched, std::vector<Literal>& fixed);
  std::vector<Literal> no_hit_until(Timepoint n) const;
  bool note_cuts(Timepoint n);
  void finish();
  SolveStatus find_step(std::span<const Literal> unmet);

  SolverSession* session_;
  PlanEnumeratorOptions options_;
  compiler::AtomIndex index_;
  Symbols symbols_;
  Timepoint first_ = 1;  // with a hit atom
  Timepoint n_ = 0;
  std::optional<Literal> guard_;  // switches the blocking clauses of length n_ on
  Orders orders_;                 // of length n_
  std::int64_t found_ = 0;
  std::optional<SymmetryBreaker> breaker_;
  bool by_symmetry_ = false;
  bool done_ = false;
  std::optional<Timepoint> dead_end_;
  Exploration exploration_ = Exploration::kStopped;
  std::vector<std::size_t> cuts_;  // found so far, ascending
  OpenEnds open_ends_;
};

}  // namespace parallax::runtime
