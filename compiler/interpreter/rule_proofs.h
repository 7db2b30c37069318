#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "compiler/interpreter/perform_resolver.h"
#include "compiler/interpreter/plan_machine.h"
#include "compiler/interpreter/prolog_search.h"
#include "compiler/interpreter/unroller.h"

namespace parallax::compiler {

/// The function of the plan that carries out an action, and its arguments.
struct PlanCall {
  std::uint32_t unit = 0;
  std::vector<ValueId> arguments;  // one for each parameter
  DesignatorLinks links;
};
struct ProofValue {
  ValueId value;
  DesignatorLinks links;
};
/// No rule carries out the action: `fits` if there is one of its type, whose conditions fail.
struct NoPlanCall {
  bool fits = false;
};

/// Asks the rules of a plan's fact groups: which function carries out an action, and what makes the
/// goal of a `prolog` form true.
class RuleProofs final : public ProofWorld {
 public:
  using GuardOf = std::function<base::Result<FormulaTree>(const StopQuestion&)>;
  RuleProofs(const FactBase& facts, const LispData& data, const PlanCode& code,
             const UnrollOptions& options, PerformResolver& resolver, PlanMachine& machine,
             GuardOf guard_of, ValueStore& values, base::DiagnosticSink& sink)
      : facts_(facts),
        data_(data),
        code_(code),
        options_(options),
        resolver_(resolver),
        machine_(machine),
        guard_of_(std::move(guard_of)),
        values_(values),
        sink_(sink) {}

  bool has_grounding_rules() const { return facts_.has(kGroundingRule); }
  /// Does a query of the binding table or a clause speak of the goal, a list of quoted data?
  bool knows(ValueId goal);
  using Grounding = std::variant<PlanCall, NoPlanCall, ProofQuestion, ProofFailed, ProofError>;
  /// The call in the first solution of (action-grounding designator ?solution).
  Grounding ground(const StopPerform& perform, const DesignatorLinks& links,
                   std::span<const std::uint32_t> given);
  using Proof = std::variant<ProofValue, ProofQuestion, ProofFailed, ProofError>;
  /// The solutions of a goal as lists of bindings, as CRAM's `prolog` returns them.
  Proof prove(const StopProof& proof, const DesignatorLinks& links,
              std::span<const std::uint32_t> given);

  // --- interface to a search
  bool is_query(std::string_view name, std::size_t arguments) override;
  std::optional<std::vector<ModelWay>> ways(std::string_view name,
                                            std::span<const std::optional<ValueId>> arguments,
                                            DatumId at) override;
  Computed call(const std::string& function, const std::vector<ValueId>& arguments, DatumId at,
                ProofAnswers& answers) override;
  DesignatorLinks& links() override { return links_; }
  void unknown(std::string_view name, std::size_t arguments, DatumId at) override;
  void report(DatumId at, std::string_view what, std::string_view text) override;
  bool spend(DatumId at, bool exhausted) override;

 private:
  std::variant<ProofValue, ProofQuestion, ProofFailed, ProofError> solve(const StopProof& proof,
                                                                         ProofAnswers& answers);
  Computed run(std::uint32_t unit, const std::vector<ValueId>& arguments, DatumId at,
               ProofAnswers& answers);
  Computed call_builtin_named(const std::string& function, const std::vector<ValueId>& arguments,
                              DatumId at, ProofAnswers& answers);
  Computed wrong_arguments(std::string_view function, std::string_view text, DatumId at);
  Computed truth_of(const StopQuestion& question, ProofAnswers& answers);
  Grounding plan_call(ValueId solution, DatumId at);
  ValueId lisp_name(const std::string& constant);

  const FactBase& facts_;
  const LispData& data_;
  const PlanCode& code_;
  const UnrollOptions& options_;
  PerformResolver& resolver_;
  PlanMachine& machine_;
  GuardOf guard_of_;
  ValueStore& values_;
  base::DiagnosticSink& sink_;
  DesignatorLinks links_;
  std::int64_t spent_ = 0;  // in this proof
  int depth_ = 0;           // proofs in functions that a proof calls
};

}  // namespace parallax::compiler
