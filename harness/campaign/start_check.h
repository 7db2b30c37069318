#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "compiler/base/diagnostic.h"
#include "harness/campaign/trial.h"

namespace parallax::harness {

/// Reports that `rejected` starts of a sample in a row were invalid: at the region of the first
/// body that `reason` names in backquotes, else at the body, with a note at the other one; at
/// `sampling` if it names no body of the scenario.
base::DiagnosticBuilder report_rejected(const Scenario& scenario, const CampaignTrace& trace,
                                        std::int64_t rejected, std::int64_t sample,
                                        const std::string& reason, base::DiagnosticSink& sink);

/// Reports that the simulator shows `fluent` after a reset otherwise than the trace starts with it.
base::DiagnosticBuilder report_other_start(const Scenario& scenario, const SampleRecord& record,
                                           const DivergingFluent& fluent,
                                           base::DiagnosticSink& sink);

/// Draws the first sample's start as a campaign with `seed` does, puts the simulator into it, again
/// for invalid ones up to the scenario's limit, and reports what `Trial::next` would report of it.
/// Nothing is moved. Returns without a word when `abandoned` says so before the end.
void check_first_start(const Scenario& scenario, const CampaignTrace& trace,
                       const PreparedTrace& prepared, const ModelFluents& fluents,
                       std::uint64_t seed, Simulator& simulator,
                       const std::function<bool()>& abandoned, base::DiagnosticSink& sink);

}  // namespace parallax::harness
