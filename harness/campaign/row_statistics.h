#pragma once

#include <string>
#include <vector>

#include "harness/campaign/rates.h"
#include "harness/campaign/sample_row.h"

namespace parallax::harness {

/// Adds to each trace the mean and the quantiles of what its runs report. A name is `duration`
/// (simulated time of all actions [s]), a margin (the least one of that name in a run), or
/// `EVENT.MARGIN` (that of one event, numbered from 0). Lost runs may have had any value.
void add_values(const std::vector<SampleRow>& rows, const std::vector<std::string>& names,
                RatesResult& result);

/// The names of all margins in the rows, sorted.
std::vector<std::string> margin_names(const std::vector<SampleRow>& rows);

/// Adds to each trace how each of its runs ended and where it began, so that two results with equal
/// starts can be compared run by run.
void add_outcomes(const std::vector<SampleRow>& rows, RatesResult& result);

}  // namespace parallax::harness
