#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/session/solver_session.h"
#include "runtime/trace/trace.h"

namespace parallax::runtime {

/// What is known of the traces that were not reported.
enum class Exploration : std::uint8_t {
  kStopped,            // nobody asked for all of them yet, or the solver gave up
  kCompleteUpToBound,  // there are longer executions than the horizon admits
  kAllTracesExplored,  // a solver call proved that no execution is left
};
std::string_view to_string(Exploration exploration);

/// The traces of a model (with or without a plan) that end where the state constraints hold for
/// the first time, at a timepoint n >= 1. Two traces are one if their event sequences are equal;
/// the first initial state in canonical order stands for them. Shortest first; among equals the
/// order of the model's events decides. Deterministic: the order does not depend on the solver's.
class PlanEnumerator {
 public:
  /// `session` outlives the enumerator; its model has state constraints.
  explicit PlanEnumerator(SolverSession& session);
  std::optional<Trace> next();
  /// Final once `next` has answered none.
  Exploration exploration() const { return exploration_; }

  /// Does the model admit, for the trace's events and initial state, a last state in which each of
  /// these fluents has the value given? One solver call.
  bool admits(const Trace& trace, const std::map<std::string, bool>& last_state);

 private:
  bool has_alternative(std::span<const Literal> fixed, std::span<const Literal> different);
  void note_alternatives(std::span<const Literal> fixed, Trace& trace);
  std::vector<Literal> first_hit(Timepoint n) const;
  void prepare_orders(Timepoint n);
  void finish();

  SolverSession* session_;
  compiler::AtomIndex index_;
  Timepoint n_ = 0;
  std::optional<Literal> guard_;      // switches the blocking clauses of length n_ on
  std::vector<Literal> event_order_;  // Happens before n_, true preferred: the trace's key
  std::vector<Literal> start_order_;  // HoldsAt at 0, false preferred
  std::vector<Literal> state_order_;  // HoldsAt from 1 to n_, false preferred
  std::int64_t found_ = 0;
  bool done_ = false;
  Exploration exploration_ = Exploration::kStopped;
};

}  // namespace parallax::runtime
