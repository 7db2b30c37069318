#pragma once

#include <atomic>
#include <optional>
#include <string>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "compiler/base/result.h"
#include "compiler/base/source_file.h"
#include "compiler/plan/plan_binding.h"
#include "compiler/plan/plan_graph.h"
#include "compiler/plan/pose_locator.h"
#include "compiler/plan/unroll_limits.h"

namespace parallax::compiler {

struct UnrollOptions {
  std::optional<std::string> entry;  // the function to run; see unroll_plan
  /// Or the file of the plan whose forms at top level run; those of other files do not.
  std::optional<base::FileId> entry_forms = std::nullopt;
  UnrollLimits limits;
  /// The model's constants and fluents. A name of the plan means the one that is equal up to case,
  /// `-` and `_` (`top-drawer` is `topDrawer`); CPL032 if there is none. Empty: names are taken as
  /// they are.
  std::vector<std::string> constants;
  std::vector<std::string> fluents;
  /// The model's constants that each object entry of the binding table can mean.
  std::vector<std::vector<std::string>> candidates;
  /// The same for each variable of each query.
  std::vector<std::vector<std::vector<std::string>>> query_candidates;
  /// Explore every condition that the binding table gives a failure by its reason, not `else`
  /// alone.
  bool failures_by_reason = false;
  bool interleave = false;  // explore every order of the performs in branches of `par`
  const std::atomic<bool>* stop = nullptr;  // raised to end it early: CPL054
  /// If the whole graph has too many locations, those that no execution reaches before this
  /// timepoint are left out. None: the whole graph is wanted.
  std::optional<std::int64_t> horizon = std::nullopt;
};

/// Runs the plan on its static values and forks where the model decides: at the outcome of every
/// `perform`, at `holds` and at comparisons with detected objects. Paths that reach the same
/// perform in the same state are merged, so the graph's size follows the plan's states, not its
/// paths. What a bound cut off ends in a kBound terminal. A plan of more locations than the limit
/// is unrolled again, the shortest ways first and only up to the horizon, if there is one.
///
/// The plan is the function `entry`; without it the bare top-level forms in order; without those
/// the last function defined. Several files are one plan, read in their order. Reports CPL0xx
/// errors and W- warnings, several per run.
base::Result<PlanGraph> unroll_plan(const base::SourceFiles& files,
                                    std::span<const base::FileId> plan, const PlanBinding& binding,
                                    const PoseLocator& locator, const UnrollOptions& options,
                                    base::DiagnosticSink& sink);

}  // namespace parallax::compiler
