#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "compiler/base/diagnostic.h"
#include "harness/campaign/trace_input.h"
#include "harness/confidence/criterion_spec.h"
#include "harness/confidence/spending.h"

namespace parallax::harness {

/// So many traces are looked at ahead, to know their number before the first of them is claimed to
/// be in order: each costs a few solver calls, and saves the simulations by which the shares of the
/// series exceed equal ones. No limit of time, on which verdicts would then depend.
inline constexpr std::int64_t kMostTracesAhead = 100;

/// The traces of a feed in their order, and what error each may spend. The number of traces is
/// looked for when it is first asked for, which is after the first trace's runs: it follows from
/// the model alone, so nothing that runs showed has an influence on it.
class TraceFamily {
 public:
  /// `max_traces` of the scenario; 0: all. `feed` and `sink` outlive the object.
  TraceFamily(TraceFeed& feed, Family family, std::int64_t max_traces, base::DiagnosticSink& sink)
      : feed_(feed), family_(family), max_traces_(max_traces), sink_(sink) {}

  /// Returns the next trace of the feed. An error that was met while looking ahead is returned only
  /// when its turn comes.
  base::Result<std::optional<CampaignTrace>> next();

  /// The share of the error for the trace that was given last; 1 where each trace is claimed by
  /// itself. None: the search was stopped before the share was known.
  std::optional<double> share();
  /// Is the share known, or can nobody tell it? Then asking costs nothing.
  bool is_settled() const { return family_ == Family::kPerTrace || looked_; }
  /// How the error is shared. None: not asked for, not known, or each trace is claimed by itself.
  const std::optional<SpendingRule>& rule() const { return rule_; }
  /// How far the search for traces came, whatever became of their simulations: "all traces
  /// explored", "complete up to bound", or "stopped" where it was not followed to its end.
  const std::string& exploration() const { return exploration_; }
  /// Whether every trace that the search found was given.
  bool all_given() const { return ahead_.empty(); }

 private:
  std::int64_t seen() const { return given_ + static_cast<std::int64_t>(ahead_.size()); }
  bool look_at_next();
  void find_rule();

  TraceFeed& feed_;
  Family family_;
  std::int64_t max_traces_;
  base::DiagnosticSink& sink_;
  std::deque<CampaignTrace> ahead_;
  std::int64_t given_ = 0;
  bool ended_ = false, failed_ = false;  // of the feed
  bool looked_ = false;
  std::string exploration_ = "stopped";
  std::optional<SpendingRule> rule_;
};

}  // namespace parallax::harness
