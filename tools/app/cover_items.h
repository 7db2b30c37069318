#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "harness/campaign/cover_watch.h"
#include "tools/app/closed_loop.h"
#include "tools/app/coverage.h"
#include "tools/app/coverage_plan.h"
#include "tools/app/plan_reach.h"

namespace parallax::tools {

/// "fails", "succeeds", "fails with navigation-pose-unreachable"
std::string outcome_of(const harness::PathStep& step, const compiler::PlanLocation& location);

/// Coverage items of executions of a plan: ways of its branches, handlers, performs that are tried
/// again, the outcomes of performs, and events that an axiom demands.
class ScenarioCoverWatch final : public harness::CoverWatch {
 public:
  /// Asks the solver which items executions of the model can show, for more and more performs, as
  /// PlanReach does. Null if the solver was stopped. The references and the run's comparison
  /// outlive the object.
  static std::unique_ptr<ScenarioCoverWatch> make(const ScenarioModel& loaded, ClosedLoop& loop,
                                                  const PlanCoverage& plan, std::uint64_t seed,
                                                  const base::SourceFiles& files);

  const std::vector<harness::CoverItem>& items() const override { return items_; }
  const std::vector<harness::CoverItem>& unreachable() const override { return unreachable_; }
  std::vector<std::size_t> shown_by(const harness::SampleRecord& record, bool admitted) override;

 private:
  /// Condition on the last step of an execution, which ends with it.
  struct Target {
    CoverageKey key;
    compiler::LocationId location;  // of a perform; else an event alone
    bool is_perform = false;
    std::set<std::uint32_t> slots;  // one of these events happens
    std::optional<bool> succeeded;  // none: it is tried again, whatever comes of it
  };

  ScenarioCoverWatch(const ScenarioModel& loaded, ClosedLoop& loop, const PlanCoverage& plan,
                     std::uint64_t seed, const base::SourceFiles& files);
  bool settle();
  void add_targets();
  bool look_at(const PlanReach& reach, compiler::Timepoint n);
  std::vector<std::vector<compiler::Literal>> ways_to(const Target& target,
                                                      compiler::Timepoint n) const;
  CoverageKey perform_key(compiler::LocationId id, const std::string& event,
                          const std::string& outcome) const;
  void name_all(const std::set<CoverageKey>& items, const std::set<CoverageKey>& unreachable);

  const ScenarioModel& loaded_;
  ClosedLoop& loop_;
  const PlanCoverage& plan_;
  std::uint64_t seed_;
  const base::SourceFiles& files_;
  compiler::AtomIndex index_;
  harness::ModelFluents fluents_;
  std::vector<Target> targets_;
  std::set<CoverageKey> wanted_, found_;         // of the targets
  std::map<std::string, CoverageKey> demanded_;  // by event symbol, those that an axiom demands
  std::map<CoverageKey, std::size_t> numbers_;   // of the items
  std::vector<harness::CoverItem> items_, unreachable_;
};

}  // namespace parallax::tools
