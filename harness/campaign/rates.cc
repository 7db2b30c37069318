#include "harness/campaign/rates.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <map>

#include "compiler/base/codes/campaigns.h"
#include "harness/campaign/asked_traces.h"
#include "harness/campaign/judge.h"
#include "harness/campaign/run_setup.h"
#include "harness/campaign/start_words.h"
#include "harness/campaign/trial.h"

namespace parallax::harness {
namespace {

class Estimator {
 public:
  Estimator(const Scenario& scenario, TraceFeed& traces, const SimulatorFactory& make_simulator,
            const RatesOptions& options, base::DiagnosticSink& sink)
      : scenario_(scenario),
        traces_(traces),
        options_(options),
        sink_(sink),
        bench_(
            scenario, traces, make_simulator, {options.seed, options.jobs, options.stop},
            [](const SampleRecord&) {}, sink) {}

  base::Result<RatesResult> run() {
    RatesResult result;
    result.scenario = scenario_.name;
    result.seed = options_.seed;
    result.confidence = options_.confidence;
    result.fixed_runs = runs_are_fixed();
    result.until_width = options_.until_width;
    result.until_known = options_.until_known;
    result.indifference = options_.indifference;
    result.comparison = scenario_.comparison();
    result.match_model = scenario_.match_model;
    const auto visit = [&](CampaignTrace trace) -> base::Result<bool> {
      bool complete = true;
      auto rates = one_trace(std::move(trace), complete);
      if (!rates) return sink_.already_reported();
      result.traces.push_back(std::move(*rates));
      return complete;
    };
    const auto complete =
        visit_asked_traces(bench_, traces_, options_.trace, scenario_.name, visit, sink_);
    if (!complete) return sink_.already_reported();
    result.complete = *complete;
    if (scenario_.mapping) {
      result.compared =
          compared_fluents(*scenario_.mapping, bench_.fluents().ground(), result.comparison);
    }
    const auto& simulator = bench_.simulator();
    result.simulator = simulator.name + (simulator.version.empty() ? "" : " ") + simulator.version;
    if (!result.complete && !lost_too_often_) forget_plan(result);
    if (options_.trace == 0) result.bounds = traces_.bounds();
    for (const auto& [kind, count] : kinds_) result.kinds.push_back({kind, count});
    return result;
  }

 private:
  /// Replaces the intervals of an interrupted campaign by ones that hold at any stopping time, as
  /// the number of runs was not fixed.
  void forget_plan(RatesResult& result) const {
    result.fixed_runs = false;
    for (auto& trace : result.traces) {
      trace.unseen = trace.lost;
      for (auto& rate : trace.causes) {
        set_anytime_interval(rate, trace.runs, trace.unseen, options_.confidence);
      }
      set_anytime_interval(trace.any, trace.runs, trace.unseen, options_.confidence);
    }
  }

  base::Result<TraceRates> one_trace(CampaignTrace found, bool& complete) {
    auto trial = Trial::prepare(bench_, std::move(found));
    if (!trial) return sink_.already_reported();
    TraceRates rates;
    const auto& trace = *trial->plan().trace;
    rates.number = trace.number;
    rates.trace = trace.events();
    std::map<std::string, CauseRate> causes;
    LawCounter law;
    law.name(trial->plan().sampler);
    trial->draw_independently();
    std::optional<SequentialTest> test;
    if (options_.indifference) test.emplace(*options_.indifference);
    bool enough = false, ran_out = false;
    while (complete && !enough && trial->next_sample() <= options_.runs) {
      trial->submit_to(last_wanted(trial->next_sample()));
      const auto sample = trial->next();
      if (!sample) return sink_.already_reported();
      ran_out = !*sample && trial->ran_out();
      lost_too_often_ = *sample && (*sample)->verdict == SampleVerdict::kLostTooOften;
      complete = *sample && !lost_too_often_;
      if (*sample) {
        const auto& plan = trial->plan_of((*sample)->record);
        law.add(plan.sampler, plan.campaign_seed, plan.trace_key, (*sample)->record);
        count(*trial, **sample, rates, causes);
        if (test) test->add(result_of(**sample));
      }
      if (test) rates.sequential = test->answer();
      enough = is_narrow(rates) || is_known(rates);
      report_progress(trace.number, trial->next_sample() - 1);
    }
    trial->end();
    rates.starts.states_hash = trial->starts().digest();
    trial->starts().describe(rates.starts, trial->next_sample() - (ran_out ? 0 : 1));
    rates.law = law.result();
    rates.left_out = law.drawn().left_out;
    // Bounds that hold at any time do not depend on runs that were not made.
    rates.unseen = runs_are_fixed() && lost_too_often_ ? options_.runs - rates.runs : rates.lost;
    finish(rates, causes);
    return rates;
  }

  bool runs_are_fixed() const { return options_.until_width <= 0.0 && !options_.until_known; }

  /// The last run to submit. Workers run ahead of the counted runs; where the count may end the
  /// runs, only a little.
  std::int64_t last_wanted(std::int64_t next) const {
    if (runs_are_fixed()) return options_.runs;
    return std::min(options_.runs, next + 2 * options_.jobs - 1);
  }

  bool is_narrow(const TraceRates& rates) const {
    if (options_.until_width <= 0.0 || rates.runs == 0) return false;
    CauseRate any = rates.any;
    set_anytime_interval(any, rates.runs, rates.lost, options_.confidence);
    return any.upper - any.lower <= options_.until_width;
  }

  bool is_known(const TraceRates& rates) const {
    if (options_.indifference) return rates.sequential != SequentialAnswer::kOpen;
    if (!options_.until_known) return false;
    const RateCounts counts{rates.runs + rates.lost, rates.any.count, rates.lost, false};
    return weigh(*options_.until_known, counts) != RateVerdict::kTooLittle;
  }

  static RunResult result_of(const TrialSample& sample) {
    switch (sample.verdict) {
      case SampleVerdict::kLost:
      case SampleVerdict::kLostTooOften:
        return RunResult::kLost;
      case SampleVerdict::kAsPredicted:
      case SampleVerdict::kAdmitted:
        return RunResult::kClean;
      case SampleVerdict::kDiscrepancy:
        break;
    }
    return RunResult::kFailure;
  }

  void report_progress(std::int64_t trace, std::int64_t done) const {
    if (!options_.progress) return;
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - started_;
    const auto made = static_cast<double>(bench_.runs_made());
    options_.progress(
        {trace, done, options_.runs, elapsed.count() > 0.0 ? made / elapsed.count() : 0.0});
  }

  void count(const Trial& trial, const TrialSample& sample, TraceRates& rates,
             std::map<std::string, CauseRate>& causes) {
    const auto& record = sample.record;
    if (!record.kind.empty()) ++kinds_[record.kind];
    rates.rejected += record.rejected;
    count_start(trial.starts(), sample, rates.starts);
    switch (sample.verdict) {
      case SampleVerdict::kLost:
      case SampleVerdict::kLostTooOften:
        ++rates.lost;
        if (is_of_the_solver(record)) ++rates.of_the_solver;
        return tell(sample, nullptr);
      case SampleVerdict::kAsPredicted:
      case SampleVerdict::kAdmitted:
        ++rates.runs;
        return tell(sample, nullptr);
      case SampleVerdict::kDiscrepancy:
        break;
    }
    ++rates.runs;
    ++rates.any.count;
    const Cause cause = cause_of(*trial.plan_of(record).trace, sample.judgement,
                                 scenario_.comparison(), record.outcomes);
    tell(sample, &cause);
    CauseRate& rate = causes[cause.text];
    if (rate.count++ == 0) {
      rate.cause = cause.text;
      rate.example = record.sample;
      rate.reason = cause.reason;
      rate.start = record.initial;
      rate.event = cause.event;
      rate.fluents = cause.fluents;
    }
    std::erase_if(rate.fluents, [&](const std::string& fluent) {
      return std::find(cause.fluents.begin(), cause.fluents.end(), fluent) == cause.fluents.end();
    });
  }

  void tell(const TrialSample& sample, const Cause* cause) const {
    if (options_.on_sample) {
      options_.on_sample(judged_row(sample, scenario_.comparison(), cause));
    }
  }

  void finish(TraceRates& rates, const std::map<std::string, CauseRate>& causes) const {
    for (const auto& [text, rate] : causes) rates.causes.push_back(rate);
    std::stable_sort(rates.causes.begin(), rates.causes.end(),
                     [](const CauseRate& a, const CauseRate& b) { return a.count > b.count; });
    const auto set = runs_are_fixed() ? set_interval : set_anytime_interval;
    for (CauseRate& rate : rates.causes) set(rate, rates.runs, rates.unseen, options_.confidence);
    rates.any.cause = "any";
    set(rates.any, rates.runs, rates.unseen, options_.confidence);
  }

  const Scenario& scenario_;
  TraceFeed& traces_;
  const RatesOptions& options_;
  base::DiagnosticSink& sink_;
  std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
  bool lost_too_often_ = false;                // which ended the runs
  std::map<std::string, std::int64_t> kinds_;  // simulations by kind of worker
  TrialBench bench_;
};

}  // namespace

RateVerdict RatesResult::evidence(const TraceRates& trace) const {
  if (indifference) {
    const bool is_below = trace.sequential == SequentialAnswer::kBelow;
    if (!is_below && trace.sequential != SequentialAnswer::kAbove) return RateVerdict::kTooLittle;
    return is_below == (until_known->upper < 1.0) ? RateVerdict::kSupports : RateVerdict::kRefutes;
  }
  return weigh(*until_known, {trace.runs + trace.lost, trace.any.count, trace.lost, false});
}

bool RatesResult::is_too_wide(const TraceRates& trace) const {
  return until_width > 0.0 && trace.any.upper - trace.any.lower > until_width;
}

bool RatesResult::is_answered() const {
  // Where initial states cannot be drawn, the one that was sampled says nothing of the others.
  if (std::any_of(traces.begin(), traces.end(),
                  [](const TraceRates& trace) { return trace.starts.only_first; })) {
    return false;
  }
  if (fixed_runs) return true;
  return std::all_of(traces.begin(), traces.end(), [this](const TraceRates& trace) {
    const bool narrow = until_width > 0.0 && !is_too_wide(trace);
    return narrow || (until_known && evidence(trace) != RateVerdict::kTooLittle);
  });
}

base::Result<RatesResult> estimate_rates(const Scenario& scenario, TraceFeed& traces,
                                         const SimulatorFactory& make_simulator,
                                         const RatesOptions& options, base::DiagnosticSink& sink) {
  return Estimator(scenario, traces, make_simulator, options, sink).run();
}

}  // namespace parallax::harness
