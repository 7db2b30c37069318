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

/// What the model says of an executed path.
struct LoopJudgement {
  base::Known admitted = base::Known::kUndecided;  // has it a trace like that?
  std::string missing;  // a variable that the mapping asks for in vain; then nothing else is said
  // Of one that it has not: the shortest prefix that cannot go on.
  PathDivergence divergence;
  std::vector<DivergingFluent> fluents;  // after its last event
  DiscrepancyKind kind = DiscrepancyKind::kLasting;
  Cause cause;
};

/// What the record's observations say of the compared fluents, by timepoint; `missing` gets the
/// variables that the mapping asks for in vain.
std::vector<LoopState> path_states(const StateMapping& mapping, const ModelFluents& fluents,
                                   const SampleRecord& record, Comparison comparison,
                                   std::set<std::string>& missing);

/// Holds the events, outcomes and observed states of the record, which begins in a state of the
/// model, against the executions of the model and its plan. One solver call for a clean path; for
/// another one as many as it has events and the model has compared fluents.
LoopJudgement judge_path(const StateMapping& mapping, const ModelFluents& fluents, LoopFeed& feed,
                         const SampleRecord& record, Comparison comparison);

}  // namespace parallax::harness
