#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "compiler/base/known.h"
#include "harness/campaign/campaign_result.h"
#include "harness/campaign/judge.h"
#include "harness/campaign/loop_input.h"
#include "harness/campaign/sample_record.h"

namespace parallax::harness {

/// The verdict of the model on an executed path.
struct LoopJudgement {
  base::Known admitted = base::Known::kUndecided;  // has it a trace like that?
  std::string missing;  // a variable that the mapping needs and the record lacks; the rest is unset
  // If the model does not admit the path: the shortest prefix that cannot go on.
  PathDivergence divergence;
  std::vector<DivergingFluent> fluents;  // after its last event
  DiscrepancyKind kind = DiscrepancyKind::kLasting;
  Cause cause;
};

/// Reads the compared fluents from the record's observations, by timepoint. `missing` gets the
/// variables that the mapping needs and the record lacks.
std::vector<LoopState> path_states(const StateMapping& mapping, const ModelFluents& fluents,
                                   const SampleRecord& record, Comparison comparison,
                                   std::set<std::string>& missing);

/// Compares the events, outcomes and observed states of the record, which begins in a state of the
/// model, with the executions of the model and its plan. Takes one solver call for a clean path;
/// for any other path as many as it has events and the model has compared fluents.
LoopJudgement judge_path(const StateMapping& mapping, const ModelFluents& fluents, LoopFeed& feed,
                         const SampleRecord& record, Comparison comparison);

/// The discrepancy that the judgement found, without the end of the simulation. `again`: its
/// repetition.
Discrepancy path_discrepancy(const SampleRecord& record, const LoopJudgement& judgement,
                             const SampleRecord& again);

}  // namespace parallax::harness
