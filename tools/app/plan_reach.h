#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <vector>

#include "runtime/trace/trace.h"
#include "tools/app/closed_loop.h"
#include "tools/app/coverage_plan.h"

namespace parallax::tools {

/// An execution of the model, as far as is needed to go through something of the plan.
struct ReachingTrace {
  runtime::Trace trace;
  PlanPath path;
};

/// The parts of a plan that executions of its model go through, with a shortest execution for each.
/// For more and more steps, the solver is asked which ways between two performs are open that no
/// execution has taken yet; one solver call for each answer and each number of steps.
class PlanReach {
 public:
  /// All outlive the object.
  PlanReach(const ScenarioModel& loaded, ClosedLoop& loop, const PlanCoverage& plan);

  /// Looks until nothing is left or the horizon is reached. False if the solver was stopped.
  bool run();
  /// The items that some execution goes through, with the first that was found.
  const std::map<CoverageKey, std::shared_ptr<const ReachingTrace>>& found() const {
    return found_;
  }
  /// After `run`: was the search for a way through the item given up, so that there may be one
  /// although none was found?
  bool is_undecided(const CoverageKey& key) const {
    return !found_.contains(key) && (too_many_ways_ || given_up_.contains(key));
  }
  /// Literals for: before `n`, no event happens that nobody performs and nothing demands.
  std::vector<compiler::Literal> nothing_idle(compiler::Timepoint n) const;
  /// An execution to the end of the plan, or to the horizon, that begins in this state: the true
  /// ones of `fluents`. None: the model has none, or the solver was stopped.
  std::optional<ReachingTrace> whole(const std::vector<compiler::FluentId>& state,
                                     const std::vector<compiler::FluentId>& fluents);

 private:
  /// A way from a perform, or from the entry, through branches to the next perform or an end.
  struct Way {
    std::optional<compiler::LocationId> from;  // none: the entry
    bool succeeded = false;
    std::vector<compiler::PlanDecision> decisions;
    std::optional<compiler::LocationId> to;  // none: an end
    std::set<CoverageKey> items;
  };
  struct OpenWay {
    const Way* way;
    std::vector<compiler::Literal> literals;
    compiler::Literal goes;
    int other_ways = 0;  // answers that went another way between the same performs
  };
  void add_ways(Way way, const compiler::PlanTarget& target, std::size_t& left);
  std::optional<std::vector<compiler::Literal>> literals(const Way& way,
                                                         compiler::Timepoint n) const;
  std::optional<compiler::Literal> choice(compiler::BranchId branch, compiler::Timepoint t) const;
  bool wanted(const Way& way) const;
  /// All new ways that executions of `n` steps end with. False if the solver was stopped.
  bool look_at(compiler::Timepoint n);
  ReachingTrace read(compiler::Timepoint n);
  bool holds(compiler::BranchId branch, const runtime::TracePoint& point) const;
  /// Excludes the values with which a guard on the way decided otherwise. False: the way is
  /// settled.
  bool refine(OpenWay& open, const ReachingTrace& answer, compiler::Timepoint n);
  PlanPath path_of(const runtime::Trace& trace);

  const ScenarioModel& loaded_;
  const compiler::PlanGraph& graph_;
  ClosedLoop& loop_;
  const PlanCoverage& plan_;
  compiler::AtomIndex index_;
  std::vector<compiler::FluentId> fluents_;  // by number in the plan's questions; those it knows
  std::vector<bool> known_;                  // likewise: the model has the fluent
  std::vector<std::uint32_t> idle_;  // slots of events that nobody performs and nothing demands
  std::vector<Way> ways_;
  bool too_many_ways_ = false;
  std::set<CoverageKey> given_up_;
  std::map<CoverageKey, std::shared_ptr<const ReachingTrace>> found_;
  compiler::RegisterObjects registers_;  // at the end of the path that was read last
};

}  // namespace parallax::tools
