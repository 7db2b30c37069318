#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "harness/config/scenario.h"

namespace parallax::tools {

/// What the document of `parallax run --json` says against the expectation, one sentence each;
/// empty if it is met. A document that is no result of a run is itself a sentence.
std::vector<std::string> unmet(const harness::Expectation& expect, std::string_view run_document);

/// The same for the document of `parallax rates --json` of one trace.
std::vector<std::string> unmet(const harness::RateExpectation& expect,
                               std::string_view rates_document);

}  // namespace parallax::tools
