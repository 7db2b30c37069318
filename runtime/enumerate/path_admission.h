#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/base/known.h"
#include "runtime/session/solver_session.h"

namespace parallax::runtime {

/// Outcome of one perform of a plan that was executed, or of one event of a trace.
struct ExecutedPerform {
  std::optional<compiler::PlanStepId> step;  // none: an event of a trace
  std::string event;                         // printed: "Go(r2)"
  bool succeeded = false;
  std::string returned;  // the object that it found; may be empty
};

/// The events that no axiom can demand (demandable_events), by slot.
std::vector<std::uint32_t> undemanded_events(const CompiledModel& model);

/// Asks a model with a plan whether it has the path that an execution took.
class PathAdmission {
 public:
  /// The value of some fluents at one timepoint.
  using State = std::map<compiler::FluentId, bool>;

  /// `session` outlives the object.
  explicit PathAdmission(SolverSession& session);
  /// For `facts` only. `model` outlives the object.
  explicit PathAdmission(const CompiledModel& model);

  /// Facts of an execution that `admits` asks for. None: one of them is false in every execution.
  std::optional<std::vector<Literal>> facts(std::span<const ExecutedPerform> performs,
                                            std::size_t outcomes,
                                            std::span<const State> observed) const;
  /// Does the model have an execution that performs these from timepoint 0 on, whose first
  /// `outcomes` performs end like that, and that goes through these states? Other events may happen
  /// only if an axiom can demand them. `observed` begins at timepoint 0 and may end early. One
  /// solver call; undecided if the solver was stopped.
  base::Known admits(std::span<const ExecutedPerform> performs, std::size_t outcomes,
                     std::span<const State> observed);

  /// The slots of the events that no axiom can demand.
  const std::vector<std::uint32_t>& undemanded() const { return undemanded_; }

 private:
  SolverSession* session_ = nullptr;
  const CompiledModel* model_;
  compiler::AtomIndex index_;
  std::map<std::string, std::uint32_t, std::less<>> events_;
  std::vector<std::uint32_t> undemanded_;  // slots of events
};

/// The states at timepoint 0 that the axioms about it admit, each as the true ones of `fluents`,
/// ascending; states that agree on these are one. `solver` is fresh.
struct InitialStates {
  std::vector<std::vector<compiler::FluentId>> states;  // in the order of their members
  bool more = false;                                    // there are more than `limit`
  bool stopped = false;                                 // the solver was
};
InitialStates initial_states(const CompiledModel& model, std::unique_ptr<SatSolver> solver,
                             std::span<const compiler::FluentId> fluents, std::size_t limit);

/// Value of a user's predicate without time, by its printed name; undecided if the model leaves it
/// open or the solver was stopped. At most two solver calls.
base::Known predicate_value(SolverSession& session, std::string_view name);

}  // namespace parallax::runtime
