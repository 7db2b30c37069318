#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/campaign/campaign_result.h"

namespace parallax::harness {

/// A discrepancy as it was judged, with the words that the report has for it.
struct ReportedDiscrepancy {
  /// Its record has what is reported: start, outcomes, and the path of an executed plan.
  Discrepancy found;
  std::string words;   // "Go(r2) fails (path-blocked), and the model says that it succeeds"
  std::string replay;  // the command that repeats it
  /// The cause has its event, which is empty for a start that differs.
  bool has_cause = false;
  /// Numbers, first divergence and the fluents that differ there are all reported.
  bool is_whole = false;

  /// "1.4"
  std::string id() const;
};

/// One trace of the report.
struct ReportedTrace {
  std::int64_t number = 0;
  std::string verdict;  // "no-discrepancy", "discrepancy", "inconclusive"
  std::vector<std::string> events;
  std::vector<std::string> initial_state;  // the fluents that hold
  std::optional<std::int64_t> simulations, clean;
  std::optional<double> confidence, epsilon;  // certified
};

/// The report of a run: report.json, or the document of `parallax run --json`.
struct RunReport {
  std::string status;  // "ok": the run gave a result
  std::string scenario;
  std::optional<std::uint64_t> seed;
  std::string tool_version;
  std::string verdict;  // as for traces
  std::optional<std::int64_t> iterations, simulations;
  std::string exploration;
  std::string execution;  // "open-loop", "closed-loop"
  std::string comparison;
  // JSON on one line, members in order of their names; empty: not reported.
  std::string criterion, simulator;
  std::string simulator_name;
  std::optional<bool> interrupted;
  std::optional<std::vector<ReportedTrace>> traces;               // none: there is no such list
  std::optional<std::vector<ReportedDiscrepancy>> discrepancies;  // none: there is no such list
};

/// Reads a report, each field as far as it is there and of the right type: what is missing is
/// empty. An entry of a list keeps its place, whatever it is. None if the text is no JSON object.
std::optional<RunReport> read_run_report(std::string_view text);

}  // namespace parallax::harness
