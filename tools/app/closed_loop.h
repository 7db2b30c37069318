#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "harness/campaign/loop_input.h"
#include "runtime/enumerate/path_admission.h"
#include "tools/app/context.h"
#include "tools/app/coverage_plan.h"
#include "tools/app/executable_plan.h"
#include "tools/app/scenario_model.h"

namespace parallax::tools {

/// A scenario's model and plan for closed loop: the plan is walked through its unrolled graph, and
/// the solver decides what the model admits.
class ClosedLoop final : public harness::LoopFeed {
 public:
  /// `loaded`, loaded to be run, and `context` outlive the object. Reports
  /// kQuestionNotObserved.
  static base::Result<std::unique_ptr<ClosedLoop>> make(const ScenarioModel& loaded,
                                                        Context& context);

  const harness::ExecutablePlan& plan() const override { return *plan_; }
  runtime::Symbols symbols() const override { return symbols_; }
  std::int64_t max_performs() const override;
  std::vector<std::string> bounds() const override;
  std::string reservation() const override;
  base::Result<std::optional<harness::LoopStates>> initial_states(
      std::span<const compiler::FluentId> fluents) override;
  harness::StartGuide* guide(std::uint64_t seed) override;
  harness::CoverWatch* cover(std::uint64_t seed) override;
  base::Known admits(std::span<const harness::PathStep> performs, std::size_t outcomes,
                     std::span<const ObservedFluents> observed) override;
  /// A trace of the model that goes as `admits` asks; none if it has none, or was stopped.
  std::optional<runtime::Trace> trace_of(std::span<const harness::PathStep> performs,
                                         std::size_t outcomes,
                                         std::span<const ObservedFluents> observed);
  const ScenarioPlan& scenario_plan() const { return *plan_; }
  runtime::SolverSession& session() { return session_; }
  const runtime::PathAdmission& admission() const { return admission_; }
  base::DiagnosticBuilder report_end(const harness::ExecutedPath& path,
                                     const std::string& reason) override;
  std::int64_t solve_calls() const { return session_.solve_calls(); }

 private:
  ClosedLoop(const ScenarioModel& loaded, Context& context);
  void leave_out_states_without_start(harness::LoopStates& states) const;
  const PlanCoverage& plan_coverage();

  const ScenarioModel& loaded_;
  Context& context_;
  runtime::Symbols symbols_;
  runtime::SolverSession session_;
  runtime::PathAdmission admission_;
  std::unique_ptr<ScenarioPlan> plan_;
  // Argument and result of the last call of initial_states.
  std::vector<compiler::FluentId> compared_;
  std::vector<std::vector<compiler::FluentId>> states_;
  std::unique_ptr<PlanCoverage> plan_coverage_;
  std::unique_ptr<harness::StartGuide> guide_;
  std::unique_ptr<harness::CoverWatch> cover_;
};

}  // namespace parallax::tools
