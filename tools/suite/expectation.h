#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "harness/config/scenario.h"

namespace parallax::tools {

/// Violations of the expectation by the document of `parallax run --json`, one sentence each; empty
/// if it is met. A document without the result of a run gives a sentence itself. `explanation`: the
/// document of `parallax explain --json` where a kind of cause is expected.
std::vector<std::string> unmet(const harness::Expectation& expect, std::string_view run_document,
                               std::string_view explanation);

/// The same for the document of `parallax rates --json` of one trace.
std::vector<std::string> unmet(const harness::RateExpectation& expect,
                               std::string_view rates_document);

/// The first error in a document of `--json`, or empty.
std::string first_error(const std::string& document);

/// The first discrepancy of a run, in words; empty without one.
std::string first_discrepancy(const std::string& run_document);

/// The cause named by the document of `parallax explain --json`: its words, and below them the
/// axioms of the first set with their places. Empty if it names none.
std::string blame(std::string_view explanation);

/// The most frequent causes of a document of `parallax rates --json`, one a line; may be empty.
std::string frequent_causes(std::string_view rates_document);

/// Did an error end the command that wrote the document, whatever its exit code?
bool has_failed(const std::string& document);

}  // namespace parallax::tools
