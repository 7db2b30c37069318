#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compiler/base/known.h"
#include "compiler/pipeline/plan_questions.h"
#include "compiler/plan/plan_graph.h"
#include "harness/campaign/loop_input.h"
#include "harness/region/state_mapping.h"
#include "tools/app/context.h"
#include "tools/app/plan_path.h"
#include "tools/app/scenario_model.h"

namespace parallax::tools {

/// Executes the plan of a scenario by a walk through its graph. Guards are evaluated on what the
/// simulator shows, by the scenario's mapping. A perform succeeds if the simulator says so; in a
/// world that is a model, which carries out events and judges none, the formula of success must
/// also hold in the state that it shows. One that returns an object returns the object that the
/// simulator names, or else any one for which that formula holds.
class ScenarioPlan final : public harness::ExecutablePlan {
 public:
  /// `loaded` outlives the object.
  ScenarioPlan(const ScenarioModel& loaded, const Context& context);

  /// Settles the predicates that its formulas mention by `value`. Reports kQuestionNotObserved for
  /// what no observation answers.
  base::Status settle(const std::function<base::Known(const std::string&)>& value,
                      base::DiagnosticSink& sink);

  std::unique_ptr<harness::PlanExecution> begin(const harness::DrawKey& key) const override;
  std::vector<harness::PlannedPerform> performs() const override;
  /// The way that a recorded execution took; `key` as `begin` was given it. None: the plan does not
  /// go so in what was observed.
  std::optional<PlanPath> retrace(const harness::DrawKey& key,
                                  const harness::SampleRecord& record) const;
  const compiler::PlanQuestions& questions() const { return questions_; }
  /// Why the formula of success cannot tell what the perform found; empty: it can.
  std::string unseen(compiler::LocationId location) const;

 private:
  friend class ScenarioPlanExecution;

  std::string unseen(const compiler::PlanQuestions::Needs& needs) const;
  harness::PlannedPerform perform(compiler::LocationId id,
                                  const compiler::RegisterObjects& registers) const;

  const ScenarioModel& loaded_;
  const compiler::PlanGraph& graph_;
  const harness::StateMapping& mapping_;
  bool formula_decides_;
  compiler::PlanQuestions questions_;
  std::vector<harness::GroundFluent> fluents_;  // as the questions number them
  std::vector<std::string> places_;             // of the performs, by location
};

}  // namespace parallax::tools
