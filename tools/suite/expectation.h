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

/// The standing of the first discrepancy in a document.
struct ToldStanding {
  std::string is;     // "not-asked", "stands", "in-doubt"; empty: there is no discrepancy
  std::string words;  // a clause
};
/// The standing in a document of `parallax run --json`: that of the first discrepancy that is not
/// in doubt, or else of the first.
ToldStanding standing_of_run(std::string_view run_document);
/// The standing in a document of `parallax confirm --json`; empty where it gives none.
ToldStanding standing_of_confirmation(std::string_view document);

/// The cause named by the document of `parallax explain --json`: its words, and below them the
/// axioms of the first set with their places. Empty if it names none.
std::string blame(std::string_view explanation);

/// The most frequent causes of a document of `parallax rates --json`, one a line; may be empty.
std::string frequent_causes(std::string_view rates_document);

/// Did an error end the command that wrote the document, whatever its exit code?
bool has_failed(const std::string& document);

}  // namespace parallax::tools
