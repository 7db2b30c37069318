#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/campaign/campaign_result.h"
#include "harness/report/standing.h"

namespace parallax::harness {

/// A discrepancy as it was judged, with the words that the report has for it.
struct ReportedDiscrepancy {
  /// Its record has what is reported: start, outcomes, and the path of an executed plan.
  Discrepancy found;
  /// "Go(r2) fails (path-blocked), and the model says that it succeeds"; the cause's text where the
  /// report has no words.
  std::string words;
  std::string replay;            // the command that repeats it
  DiscrepancyStanding standing;  // by the run's second opinion
  /// The cause has its event, which is empty for a start that differs.
  bool has_cause = false;
  /// Numbers, first divergence and the fluents that differ there are all reported.
  bool is_whole = false;

  /// "1.4"
  std::string id() const;
};

/// How far a closed-loop run has shown every behaviour of plan and model.
struct ReportedCover {
  std::string end;  // why it ended
  std::int64_t items = 0, shown = 0;
  double confidence = 0.0, bound = 1.0;
};

/// One trace of the report.
struct ReportedTrace {
  std::int64_t number = 0;
  std::string verdict;  // "no-discrepancy", "discrepancy", "inconclusive"
  std::string claim;
  std::vector<std::string> events;
  std::vector<std::string> sources;        // "fetch.lisp:4", by event
  std::vector<std::string> initial_state;  // the fluents that hold
  std::optional<StartResult> starts;       // of a trace; without `law`
  std::vector<std::string> caveats, not_covered;
  std::optional<std::int64_t> simulations, clean, lost;
  std::vector<LossCount> losses;
  std::optional<double> confidence, epsilon;  // certified
  std::optional<double> error_share;          // of 1-C that its bound may spend
  std::optional<std::int64_t> paper_stopped_at;
  std::string paper_variant;
  std::vector<CauseRate> causes;  // without the start and the event
  // For executions of the plan.
  std::optional<std::int64_t> chosen_starts, unfinished;
  std::vector<PathCount> paths;
  std::optional<ReportedCover> cover;
};

/// The claim about all traces together.
struct ReportedFamily {
  std::optional<std::int64_t> traces;  // none: their number was not known
  std::string claim;
};

/// The verdict of another simulator.
struct ReportedOpinion {
  std::string other;  // "mujoco 2.2.2"
  std::vector<std::string> sentences;
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
  std::vector<std::string> bounds;   // what was left out, a sentence each
  std::vector<std::string> ignored;  // fluents that are not compared
  std::string execution;             // "open-loop", "closed-loop"
  std::string comparison;
  std::string compared;  // by fluent: "Open(..) every-step, Parked() ignored"
  // JSON on one line, members in order of their names; empty: not reported.
  std::string criterion, simulator;
  std::optional<CriterionSpec> criterion_spec;  // the paper's rule by its preset alone
  std::string simulator_name, simulator_version;
  std::optional<ReportedFamily> family;
  std::vector<CoverageShare> coverage;
  std::optional<ReportedOpinion> opinion;
  std::optional<bool> interrupted;
  std::optional<std::vector<ReportedTrace>> traces;               // none: there is no such list
  std::optional<std::vector<ReportedDiscrepancy>> discrepancies;  // none: there is no such list
};

/// Reads a report, each field as far as it is there and of the right type: what is missing is
/// empty. An entry of a list keeps its place, whatever it is. None if the text is no JSON object.
std::optional<RunReport> read_run_report(std::string_view text);

}  // namespace parallax::harness
