#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "harness/campaign/start_guide.h"
#include "tools/app/closed_loop.h"
#include "tools/app/coverage_plan.h"

namespace parallax::tools {

/// A start of executions, with the items that the model lets them go through.
struct StartCandidates {
  struct Candidate {
    std::int64_t start = 0;  // number of the initial state, from 1
    std::set<CoverageKey> items;
  };
  std::vector<Candidate> candidates;
  std::set<CoverageKey> coverable;  // what some execution of the model goes through
};

/// Asks the model. `states`: those that executions begin in, as the true ones of `fluents`.
StartCandidates start_candidates(const ScenarioModel& loaded, ClosedLoop& loop,
                                 const PlanCoverage& plan,
                                 const std::vector<std::vector<compiler::FluentId>>& states,
                                 const std::vector<compiler::FluentId>& fluents);

/// Chooses the start from which the model goes through most items that no execution has gone
/// through yet: performs, branches, handlers and retries of the plan.
class ScenarioStartGuide final : public harness::StartGuide {
 public:
  /// Number of times that one candidate is tried.
  static constexpr int kMaxTries = 8;

  /// All but the candidates outlive the object.
  ScenarioStartGuide(StartCandidates starts, const PlanCoverage& plan,
                     const ScenarioPlan& scenario_plan, std::uint64_t seed,
                     int max_tries = kMaxTries);

  std::optional<harness::GuidedStart> next(std::int64_t sample) override;
  void tell(const harness::SampleRecord& record) override;

  const std::set<CoverageKey>& uncovered() const { return uncovered_; }

 private:
  StartCandidates starts_;
  const PlanCoverage& plan_;
  const ScenarioPlan& scenario_plan_;
  std::uint64_t seed_;
  int max_tries_;
  std::vector<int> tries_;                         // by candidate
  std::map<std::int64_t, std::size_t> under_way_;  // candidates, by sample
  std::set<CoverageKey> uncovered_;
};

}  // namespace parallax::tools
