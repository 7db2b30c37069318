#pragma once

#include <string>
#include <vector>

#include "harness/campaign/rates.h"
#include "harness/campaign/sample_row.h"

namespace parallax::tools {

/// A page with plots of the counts of `parallax rates`: for each trace how often each cause comes,
/// how rate and bound settled with the number of runs, and how the rate depends on the variable of
/// the start that tells failures best. `rows` are all its simulations.
std::string rates_page(const harness::RatesResult& result,
                       const std::vector<harness::SampleRow>& rows);

}  // namespace parallax::tools
