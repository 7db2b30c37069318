#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "harness/confidence/criterion.h"
#include "harness/confidence/criterion_spec.h"
#include "harness/confidence/tally.h"

namespace parallax::harness {

/// Exactly what the runs of one trace support, as one sentence without a full stop: "with 99 %
/// confidence, fewer than 5 % of start states drawn uniformly from the start region give a
/// discrepancy (90 clean runs of 90)". Figures are rounded up, so never beyond the evidence.
std::string claim(const Tally& tally, const CriterionSpec& spec);

/// What weakens the claim, one sentence each: rejected starts, lost runs, fluents without
/// regression evidence where the paper's rule is satisfied, which it is after `paper_stopped_at`
/// runs, if at all.
std::vector<std::string> caveats(const Tally& tally, const CriterionSpec& spec,
                                 std::optional<std::int64_t> paper_stopped_at);

/// "paper-literal, n = 2": the reading of the paper's rule and its number of varying initial
/// parameters.
std::string paper_variant(const Tally& tally, const PaperRuleSpec& spec);

/// A probability in per cent with a blank, at most three significant digits, rounded up: "5 %",
/// "48.3 %".
std::string percent_up(double probability);

}  // namespace parallax::harness
