#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "harness/campaign/campaign.h"
#include "harness/campaign/start_law.h"
#include "harness/confidence/rate_evidence.h"
#include "harness/confidence/sequential_test.h"
#include "harness/confidence/value_summary.h"

namespace parallax::harness {

/// A number that runs report, over the runs of a trace: a margin, or the duration.
struct ReportedValue {
  std::string name;                     // as asked for: "duration", "goal", "2.goal"
  std::int64_t without = 0;             // runs seen to their end that did not report it
  std::optional<ValueSummary> summary;  // none: no run reported it
};

/// How one run ended, and where it began.
struct RunOutcome {
  std::string outcome;  // "clean", "admitted", "discrepancy", "lost"
  std::string start;    // hash of the start's variables, 16 hexadecimal digits
};

struct TraceRates {
  std::int64_t number = 0;
  std::string trace;      // its events
  std::int64_t runs = 0;  // seen to their end
  std::int64_t lost = 0;
  std::int64_t of_the_solver = 0;  // of the lost ones: taken back by the simulator (kOfTheSolver)
  /// Lost, or not made because the simulator was lost too often: what they would have shown is not
  /// known, and intervals allow for either.
  std::int64_t unseen = 0;
  std::int64_t rejected = 0;      // invalid starts that were drawn again
  StartResult starts;             // the initial states that were simulated
  std::optional<LawResult> law;   // none: starts are uniform
  std::string left_out;           // the part of the start region that is never drawn
  CauseRate any;                  // any discrepancy at all
  std::vector<CauseRate> causes;  // most frequent first
  SequentialAnswer sequential = SequentialAnswer::kOpen;  // of `indifference`
  std::vector<ReportedValue> values;                      // where they were asked for
  std::vector<RunOutcome> outcomes;                       // likewise, by sample number
};

struct RatesOptions {
  std::uint64_t seed = 1;
  std::int64_t jobs = 1;
  std::int64_t runs = 300;  // of each trace
  std::int64_t trace = 0;   // 0: all of them
  /// Above 0: `runs` are the most, and a trace ends as soon as the interval of any discrepancy is
  /// no wider. Intervals then hold whenever one looks: the mixture's bound from either side.
  double until_width = 0.0;
  /// `runs` are the most, and a trace ends as soon as it is known whether the rate of any
  /// discrepancy is as claimed, with the claim's confidence. Intervals hold whenever one looks.
  std::optional<RateClaim> until_known;
  /// With a claim of one side: it is tested by SequentialTest, up to the end of this region.
  std::optional<IndifferenceRegion> indifference;
  double confidence = 0.95;  // of each interval
  const std::atomic<bool>* stop = nullptr;
  std::function<void(const CampaignProgress&)> progress;  // called in the caller's thread
  SampleListener on_sample;                               // none: nobody listens
};

struct RatesResult {
  std::string scenario;
  std::uint64_t seed = 0;
  double confidence = 0.0;
  /// Intervals are for a number of runs fixed in advance. False: what was seen, or somebody, ended
  /// them, and intervals hold at any time.
  bool fixed_runs = true;
  double until_width = 0.0;  // what was asked for, as in RatesOptions
  std::optional<RateClaim> until_known;
  std::optional<IndifferenceRegion> indifference;
  Comparison comparison = Comparison::kEveryStep;
  std::vector<ComparedFluents> compared{};
  bool match_model = true;  // as in Scenario
  std::string simulator{};  // "ode 0.16.2"; empty: there was no trace to start it for
  /// Hashes of what decides on the result, for who compares it with another one; set by those who
  /// know them (tools/app/rates_identity.h).
  std::string scenario_hash{}, starts_hash{}, judging_hash{};
  bool complete = true;  // false: stopped, or the simulator was lost too often
  std::vector<TraceRates> traces;
  std::vector<KindCount> kinds;     // of workers, where they may be several
  std::vector<std::string> bounds;  // what was left out, a sentence each

  /// Weighs the runs of a trace as evidence for or against `until_known`; of `indifference` it is
  /// the answer of the sequential test.
  RateVerdict evidence(const TraceRates& trace) const;
  /// Did the runs end before the interval was as narrow as asked?
  bool is_too_wide(const TraceRates& trace) const;
  /// Does every trace have what the runs were to go on for?
  bool is_answered() const;
};

/// Simulates each trace `runs` times from starts that are drawn independently, whatever comes out,
/// and counts what a campaign would call a discrepancy by its cause. Reports as run_campaign does;
/// a simulator that is lost too often ends it, with the counts so far and `complete` false.
base::Result<RatesResult> estimate_rates(const Scenario& scenario, TraceFeed& traces,
                                         const SimulatorFactory& make_simulator,
                                         const RatesOptions& options, base::DiagnosticSink& sink);

}  // namespace parallax::harness
