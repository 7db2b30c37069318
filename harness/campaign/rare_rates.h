#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "harness/campaign/rates.h"
#include "harness/search/rare_event.h"

namespace parallax::harness {

/// The rate at which one trace goes wrong, where that is too seldom to be counted.
struct RareTraceRate {
  std::int64_t number = 0;
  std::string trace;     // its events
  StartResult starts;    // the initial states that were simulated
  std::string law;       // that starts are drawn by, as LawResult::text; empty: uniform
  std::string left_out;  // the part of the start region that is never drawn
  RareEventResult estimate;
  std::vector<std::string> contradicting;  // parts of margins that were left out
};

struct RareRatesResult {
  std::string scenario;
  std::uint64_t seed = 0;
  double confidence = 0.0;
  RareEventMethod method = RareEventMethod::kImportance;
  std::int64_t budget = 0;
  Comparison comparison = Comparison::kEveryStep;
  bool complete = true;  // false: stopped, or the simulator was lost too often
  std::vector<RareTraceRate> traces;
  std::vector<std::string> bounds;  // what was left out, a sentence each
  /// Does every trace have its interval?
  bool is_answered() const;
};

/// Estimates for each trace the probability that a uniform start gives a discrepancy, with
/// `options.runs` simulations at most, by how near to one simulations come (sample_margin.h). Units
/// of margins are those of the first batch. Reports as estimate_rates does.
base::Result<RareRatesResult> estimate_rare_rates(const Scenario& scenario, TraceFeed& traces,
                                                  const SimulatorFactory& make_simulator,
                                                  const RatesOptions& options,
                                                  RareEventMethod method,
                                                  base::DiagnosticSink& sink);

/// Explains why there is no interval; empty for kEstimated.
std::string why_unanswered(const RareTraceRate& rate, const RareRatesResult& result);

}  // namespace parallax::harness
