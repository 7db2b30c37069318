#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "compiler/base/result.h"
#include "harness/campaign/journal.h"
#include "tools/app/closed_loop.h"
#include "tools/app/coverage.h"
#include "tools/app/coverage_model.h"
#include "tools/app/coverage_plan.h"

namespace parallax::tools {

/// Coverage by executions of a scenario's plan: the plan as it was walked, the model by one of its
/// traces that goes the same way. Add the runs, then take the result.
class LoopCoverage {
 public:
  /// The run's confidence and comparison; both outlive the object.
  struct RunTerms {
    double confidence = 0.0;
    harness::Comparison comparison = harness::Comparison::kEveryStep;
  };
  /// `loaded` as for closed loop, and everything outlives the object. `longest`: performs of any
  /// execution that is added. Reports kCheckGivenUp, and what ClosedLoop reports.
  static base::Result<std::unique_ptr<LoopCoverage>> make(const ScenarioModel& loaded,
                                                          std::int64_t longest, Context& context);

  /// One that came to a result. Reports kForeignJournalLine, at `place`, for what the plan does not
  /// do in what was observed.
  base::Status add(const harness::SampleRecord& record, std::uint64_t seed, const RunTerms& terms,
                   const base::SourceRange& place);
  /// Adds all to `coverage`.
  void write(Coverage& coverage) const;

 private:
  using Fluents = harness::LoopFeed::ObservedFluents;
  /// Coverage shared by all executions that went the same way through the same states.
  struct Judged {
    std::set<CoverageKey> covered;  // of the model
    std::set<ModelBehaviour> possible, shown;
    std::optional<WorldBehaviour> lacking;
  };

  LoopCoverage(const ScenarioModel& loaded, std::unique_ptr<ClosedLoop> loop, std::int64_t longest,
               Context& context);
  const Judged& judged(const harness::SampleRecord& record, harness::Comparison comparison);
  Judged judge(const harness::SampleRecord& record, harness::Comparison comparison);
  void note_outcomes(const harness::SampleRecord& record, const std::vector<Fluents>& states,
                     std::size_t admitted, Judged& out);
  ModelBehaviour behaviour(const harness::PathStep& step, std::string outcome) const;

  const ScenarioModel& loaded_;
  Context& context_;
  std::unique_ptr<ClosedLoop> loop_;
  harness::ModelFluents fluents_;
  compiler::TypedModel typed_;  // for no more timepoints than are needed
  compiler::ReferenceEvaluator evaluator_;
  std::unique_ptr<ModelCoverage> model_;
  PlanCoverage plan_;
  std::map<std::string, Judged> judged_;  // by path and states
  std::map<CoverageKey, std::int64_t> hits_;
  std::map<ModelBehaviour, std::int64_t> possible_;  // runs
  std::set<ModelBehaviour> shown_;
  std::map<std::string, WorldBehaviour> lacking_;  // by what it is
  double confidence_ = 1.0;
  std::int64_t drawn_ = 0;  // executions with a start that was drawn
};

}  // namespace parallax::tools
