#pragma once

#include <cstdint>
#include <functional>
#include <ostream>
#include <span>
#include <vector>

#include "compiler/artifact/compiled_model.h"
#include "runtime/session/solver_session.h"
#include "runtime/trace/trace.h"

namespace parallax::runtime {

/// "The model has no trace but these", as a formula that has no model if that is true: the clauses
/// of the compiled model and one blocking clause for every trace.
///
/// Without state constraints a trace is a valuation of HoldsAt and Happens at the full horizon, and
/// its clause says that one of them is different. With constraints a trace is a sequence of events
/// and of what performs returned, up to the first hit. Then the formula also chooses a length, by
/// variables beyond those of the model: `ends` n implies the clauses of the timepoints up to n,
/// that the constraints hold at n and not before; a blocking clause binds the length that its trace
/// has.
class CompletenessClaim {
 public:
  /// `model` outlives the claim.
  explicit CompletenessClaim(const CompiledModel& model);

  /// For models with constraints: executions that do not end by the horizon may be left.
  void limit_to_horizon() { may_go_on_ = false; }
  /// Traces as they were listed. Memory: one bit for each observable atom.
  void add(const Trace& trace);
  std::int64_t traces() const { return static_cast<std::int64_t>(traces_.size()); }

  std::int64_t variables() const { return variables_; }
  /// What a search for traces may take for granted: without state constraints the claim is about
  /// the whole horizon.
  std::vector<compiler::Literal> given() const;
  using Visit = std::function<void(std::span<const compiler::Literal>)>;
  void for_each_clause(const Visit& visit) const;
  /// With comments that name the variables of observable atoms. Returns when the stream fails.
  void write_dimacs(std::ostream& out) const;

 private:
  struct Observable {
    compiler::Literal literal;
    compiler::AtomKind kind;
    Timepoint time;
    std::uint32_t number;  // of the fluent or event
    std::string name;
  };
  struct Found {
    Timepoint length;
    std::vector<bool> values;  // by observable, as far as they exist
  };

  bool is_key(const Observable& observable, Timepoint length) const;
  void visit_model(const Visit& visit) const;
  void visit_lengths(const Visit& visit) const;
  void visit_end(Timepoint n, const Visit& visit) const;
  void visit_going_on(const Visit& visit) const;
  void visit_traces(const Visit& visit) const;

  const CompiledModel& model_;
  LengthVariables lengths_;
  compiler::AtomIndex index_;
  std::vector<Observable> observables_;
  std::vector<Found> traces_;
  std::int64_t variables_;
  bool may_go_on_ = true;
};

}  // namespace parallax::runtime
