#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>

#include "compiler/base/diagnostic.h"
#include "compiler/plan/lisp_data.h"
#include "compiler/plan/plan_builtins.h"
#include "compiler/plan/plan_code.h"
#include "compiler/plan/plan_state.h"
#include "compiler/plan/plan_value.h"

namespace parallax::compiler {

/// Why the machine stopped; in the first two cases the caller pushes the answer and runs it again.
struct StopPerform {
  ValueId designator;
  DatumId form;
};
struct StopQuestion {                           // only the model knows
  std::variant<ValueId, ModelEquality> fluent;  // a fluent's list, or whether two values are equal
  DatumId form;
  bool query_only = false;  // of `prolog`: the list is a query of the binding table
};
struct StopDone {};
struct StopFailed {
  std::string failure_class;
};
struct StopBound {
  std::string form;
  DatumId at;
};
struct StopTurn {};   // every branch of the outermost `par` is over or waits for its turn
struct StopError {};  // reported
using PlanStop =
    std::variant<StopPerform, StopQuestion, StopDone, StopFailed, StopBound, StopTurn, StopError>;

struct MachineLimits {
  std::uint32_t max_call_depth = 8;
  std::int64_t max_loop = 16;
  std::int64_t max_steps = 5000000;
  std::int64_t location_samples = 0;
};

/// Executes plan code on one state at a time, silently, up to the next thing that is not silent.
/// Deterministic: the answer depends on the state alone.
class PlanMachine {
 public:
  PlanMachine(const PlanCode& code, const LispData& data, const MachineLimits& limits,
              ValueStore& values, base::DiagnosticSink& sink)
      : code_(code), data_(data), limits_(limits), values_(values), sink_(sink) {}

  /// Sets the global constants; false if that reported an error.
  bool run_definitions();
  PlanState start() const;
  PlanStop run(PlanState& state);
  /// Lets the current step fail instead of answering; run goes on from there.
  std::optional<PlanStop> raise(PlanState& state, ValueId failure);
  /// Inside a `par`: the running branch waits at this perform, others run up to theirs. None: run
  /// goes on with another branch.
  std::optional<PlanStop> wait(PlanState& state, const StopPerform& perform);
  /// Where branches wait: the way to each through nested `par`s, in written order.
  using BranchPath = std::vector<std::size_t>;
  static std::vector<BranchPath> waiting(const PlanState& state);
  /// Puts that branch in place; its perform is next.
  static StopPerform resume(PlanState& state, const BranchPath& path);
  /// Lets a function of the plan answer; run goes into it.
  std::optional<PlanStop> enter(PlanState& state, std::uint32_t unit,
                                const std::vector<ValueId>& arguments, DatumId form);

 private:
  using Step = std::optional<PlanStop>;  // empty: go on
  Step execute(PlanState& state, const PlanInstruction& instruction);
  Step leave(PlanState& state);
  Step load_global(PlanState& state, const PlanInstruction& instruction);
  Step expect_list(const PlanState& state, const PlanInstruction& instruction);
  Step builtin(PlanState& state, const PlanInstruction& instruction);
  Step call(PlanState& state, const PlanInstruction& instruction);
  Step apply(PlanState& state, const PlanInstruction& instruction);
  Step tick(PlanState& state, const PlanInstruction& instruction);
  Step fail_value(PlanState& state, const PlanInstruction& instruction);
  void push_guard(PlanState& state, const PlanInstruction& instruction);
  void run_cleanup(PlanState& state, const PlanInstruction& instruction);
  Step end_handler(PlanState& state);
  Step end_cleanup(PlanState& state);
  Step search(PlanState& state, ValueId failure, std::size_t limit);
  Step start_par(PlanState& state, const PlanInstruction& instruction);
  Step end_branch(PlanState& state);
  Step next_branch(PlanState& state);
  Step abandon_branches(PlanState& state, std::size_t frames);
  Step unwind(PlanState& state, Pending pending);
  void add_key(PlanState& state, const PlanInstruction& instruction);
  std::size_t place(const PlanState& state, const PlanInstruction& instruction) const;
  std::uint32_t linked(const PlanState& state, std::uint32_t level) const;
  StopError error(base::DiagnosticCode code, const PlanInstruction& at, std::string text);
  std::string name_at(DatumId form) const;

  const PlanCode& code_;
  const LispData& data_;
  MachineLimits limits_;
  ValueStore& values_;
  base::DiagnosticSink& sink_;
  std::vector<std::optional<ValueId>> globals_;
  std::int64_t steps_ = 0;
};

}  // namespace parallax::compiler
