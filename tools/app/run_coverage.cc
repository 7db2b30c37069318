#include "tools/app/run_coverage.h"

#include <optional>
#include <set>

#include "tools/app/coverage.h"
#include "tools/app/coverage_model.h"
#include "tools/app/coverage_plan.h"

namespace parallax::tools {
namespace {

/// Limit on the model's size: larger models are left to `parallax coverage`, so that no report has
/// to wait.
constexpr std::int64_t kMaxInstances = 2'000'000;

using Shares = std::vector<harness::CoverageShare>;

/// Shares of the groups that are not empty. Traces are counted elsewhere in a report.
Shares shares(const std::set<CoverageKey>& all, const std::set<CoverageKey>& covered) {
  Shares out;
  for (std::size_t i = 0; i < kCoverageGroups.size(); ++i) {
    const auto group = static_cast<CoverageGroup>(i);
    if (group == CoverageGroup::kTraces) continue;
    harness::CoverageShare share{std::string(kCoverageGroups[i]), 0, 0};
    for (const auto& key : all) {
      if (key.group != group) continue;
      ++share.all;
      if (covered.count(key) > 0) ++share.covered;
    }
    if (share.all > 0) out.push_back(std::move(share));
  }
  return out;
}

Shares of_traces(const ScenarioModel& loaded, const harness::CampaignResult& result,
                 Context& context) {
  const auto& compilation = loaded.compilation;
  compiler::ReferenceLimits limits;
  limits.max_instances = kMaxInstances;
  limits.stop = &context.stop();
  const compiler::ReferenceEvaluator evaluator(*compilation.typed, limits);
  if (evaluator.refusal()) return {};
  const ModelCoverage model(*compilation.typed, evaluator, context.files());
  std::optional<PlanCoverage> plan;
  if (compilation.plan) plan.emplace(*compilation.plan, *compilation.typed, context.files());
  std::set<CoverageKey> all, covered;
  for (const auto& [key, text] : model.all()) all.insert(key);
  if (plan) all.insert(plan->all().begin(), plan->all().end());
  for (const auto& one : result.traces) {
    const bool searched = one.search && one.search->runs > one.search->lost;
    if (one.simulations == one.lost && !searched) continue;
    const auto cover = [&](const harness::CampaignTrace& trace) {
      covered.merge(model.covered_by(trace));
      if (plan) covered.merge(plan->covered_by(plan->path_of(trace)));
    };
    if (one.starts.states.empty()) cover(*one.trace);
    for (const auto& [number, state] : one.starts.states) {
      if (state.seen() > 0) cover(*state.trace);
    }
  }
  all.insert(covered.begin(), covered.end());
  return shares(all, covered);
}

Shares of_executions(const harness::CampaignResult& result, Context& context) {
  // Errors of the coverage are not reported as errors of the run.
  Context own(context.form(), context.stop());
  const auto coverage = coverage_of({{result.replay_folder}, result.scenario, 1}, own);
  if (!coverage) return {};
  std::set<CoverageKey> all, covered;
  for (const auto& [key, count] : coverage->items) {
    all.insert(key);
    if (count.hits > 0) covered.insert(key);
  }
  return shares(all, covered);
}

}  // namespace

std::vector<harness::CoverageShare> coverage_of_run(const ScenarioModel& loaded,
                                                    const harness::CampaignResult& result,
                                                    Context& context) {
  if (result.failed || result.interrupted || result.traces.empty()) return {};
  if (result.execution == harness::Execution::kOpenLoop) {
    return of_traces(loaded, result, context);
  }
  if (!result.journal_open) return {};
  return of_executions(result, context);
}

}  // namespace parallax::tools
