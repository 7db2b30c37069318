#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "compiler/base/source_file.h"
#include "compiler/plan/plan_graph.h"
#include "compiler/sema/typed_model.h"
#include "runtime/trace/trace.h"
#include "tools/app/coverage.h"
#include "tools/app/plan_path.h"

namespace parallax::tools {

CoverageKey coverage_key(CoverageGroup group, const base::SourceRange& source, std::string id,
                         const base::SourceFiles& files);

/// The coverage items of a plan, and those that a trace covers. Performs that no way through the
/// plan reaches are left out.
class PlanCoverage {
 public:
  /// All outlive the object.
  PlanCoverage(const compiler::PlanGraph& graph, const compiler::TypedModel& model,
               const base::SourceFiles& files);

  const std::set<CoverageKey>& all() const { return all_; }
  std::set<CoverageKey> covered_by(const PlanPath& path) const;
  /// How performs end, among `all`.
  const std::set<CoverageKey>& outcomes() const { return outcomes_; }
  /// Handlers for signals of the plan alone, without performs: no path covers them.
  const std::set<CoverageKey>& without_performs() const { return without_performs_; }
  /// Locations of the same `perform` from which a way leads to this location again.
  const std::vector<compiler::LocationId>& earlier(compiler::LocationId location) const {
    return earlier_[location.index()];
  }
  CoverageKey retry(const compiler::PlanLocation& location) const;
  /// `trace` as an enumerator gave it, with the plan's steps.
  PlanPath path_of(const runtime::Trace& trace) const;

 private:
  using Decision = compiler::PlanDecision;

  CoverageKey perform(const compiler::PlanLocation& location) const;
  CoverageKey outcome(const compiler::PlanLocation& location, bool success) const;
  CoverageKey decision(const compiler::PlanBranch& branch, bool value) const;
  CoverageKey handler(const compiler::PlanHandler& handler) const;
  /// The decisions on the way from a place to the next location; those that are certain.
  std::set<Decision> way(const compiler::PlanTarget& from, std::optional<compiler::LocationId> next,
                         const runtime::Trace& trace, std::size_t t) const;
  void add_ways(const compiler::PlanTarget& from, std::optional<compiler::LocationId> next,
                const runtime::Trace& trace, std::size_t t, std::vector<Decision>& path,
                std::vector<std::set<Decision>>& found) const;
  /// None: it has a quantifier, or speaks of what is not known.
  std::optional<bool> value(const compiler::FormulaTree& guard, const runtime::Trace& trace,
                            std::size_t t) const;

  const compiler::PlanGraph& graph_;
  const compiler::TypedModel& model_;
  const base::SourceFiles& files_;
  std::vector<std::vector<compiler::LocationId>> earlier_;
  std::set<CoverageKey> all_, outcomes_, without_performs_;
};

}  // namespace parallax::tools
