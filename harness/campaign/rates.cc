#include "harness/campaign/rates.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <set>

#include "compiler/base/diagnostic_codes.h"
#include "harness/campaign/judge.h"
#include "harness/campaign/sample_runner.h"
#include "harness/campaign/start_blame.h"
#include "harness/campaign/worker_pool.h"
#include "harness/confidence/quantiles.h"

namespace parallax::harness {
namespace {

using base::DiagnosticCode;

void set_interval(CauseRate& rate, std::int64_t runs, double confidence) {
  const auto k = static_cast<double>(rate.count), n = static_cast<double>(runs);
  const double tail = 0.5 * (1.0 - confidence);
  rate.rate = runs == 0 ? 0.0 : k / n;
  rate.lower = rate.count == 0 ? 0.0 : beta_quantile(tail, k, n - k + 1.0);
  rate.upper = rate.count == runs ? 1.0 : beta_quantile(1.0 - tail, k + 1.0, n - k);
}

class Estimator {
 public:
  Estimator(const Scenario& scenario, TraceFeed& traces, const SimulatorFactory& make_simulator,
            const RatesOptions& options, base::DiagnosticSink& sink)
      : scenario_(scenario),
        traces_(traces),
        options_(options),
        sink_(sink),
        pool_(
            options.jobs, make_simulator, [](const SampleRecord&) {}, options.stop) {
    for (const auto& text : traces.fluents()) fluents_.push_back(ground_fluent(text));
  }

  base::Result<RatesResult> run() {
    RatesResult result{scenario_.name, options_.seed, options_.confidence, true, {}};
    const auto info = pool_.info();
    result.complete = info.has_value();
    if (info && info->name.empty()) {
      return sink_.error(DiagnosticCode::kSimulatorNotStarted, scenario_.simulator.source,
                         info->version);
    }
    repeats_losses_ = info && may_repeat_losses(*info);
    if (info && !check_against_simulator(scenario_, *info, sink_)) return sink_.already_reported();
    std::int64_t last = 0;
    bool seen_all = false;
    while (result.complete) {
      auto trace = traces_.next();
      if (!trace) return sink_.already_reported();
      seen_all = !*trace;
      if (seen_all) break;
      const std::int64_t number = last = (*trace)->number;
      if (options_.trace != 0 && number != options_.trace) continue;
      auto rates = one_trace(std::move(**trace), result.complete);
      if (!rates) return sink_.already_reported();
      result.traces.push_back(std::move(*rates));
      if (number == options_.trace) break;
    }
    pool_.close();
    if (seen_all) result.complete = traces_.exploration() != "stopped";
    if (seen_all && result.complete && last < options_.trace) {
      return sink_.error_about(DiagnosticCode::kNoSuchTrace, scenario_.name, options_.trace,
                               last == 0   ? "the scenario has none"
                               : last == 1 ? "the scenario has only one"
                                           : fmt::format("the scenario has {}", last));
    }
    return result;
  }

 private:
  base::Result<TraceRates> one_trace(CampaignTrace trace, bool& complete) {
    const auto& start = trace.holds.front();
    const auto cuboid =
        scenario_.mapping->start_cuboid(fluents_, std::set<std::string>(start.begin(), start.end()),
                                        scenario_.sampling, scenario_.sampling_source, sink_);
    if (!cuboid) return sink_.already_reported();
    auto calls = action_calls(scenario_, trace, sink_);
    auto sampler =
        Sampler::make(*cuboid, scenario_.sampling_inset_m, scenario_.sampling_source, sink_);
    if (!calls || !sampler) return sink_.already_reported();
    const auto key = hash64(trace.key);
    const auto plan = std::make_shared<const TracePlan>(
        TracePlan{std::move(trace), std::move(*calls), std::move(*sampler), options_.seed, key,
                  scenario_.limits.max_rejected_starts, repeats_losses_});
    TraceRates rates;
    rates.number = plan->trace.number;
    for (const auto& event : plan->trace.events) {
      rates.trace += (rates.trace.empty() ? "" : " ") + event.text;
    }
    for (std::int64_t sample = 1; sample <= options_.runs; ++sample) pool_.submit(plan, sample);
    std::map<std::string, CauseRate> causes;
    for (std::int64_t sample = 1; sample <= options_.runs && complete; ++sample) {
      const auto record = pool_.wait(sample, Phase::kCertify);
      complete = record.has_value();
      if (record && !count(*plan, *record, rates, causes, complete))
        return sink_.already_reported();
    }
    pool_.abandon();
    finish(rates, causes);
    return rates;
  }

  base::Status count(const TracePlan& plan, const SampleRecord& record, TraceRates& rates,
                     std::map<std::string, CauseRate>& causes, bool& complete) {
    rates.rejected += record.rejected;
    switch (record.status) {
      case SampleStatus::kRejected:
        return report_rejected(scenario_, plan.trace, record.rejected, record.sample, record.reason,
                               sink_);
      case SampleStatus::kRefused:
        return sink_.error(DiagnosticCode::kSimulatorRefused, scenario_.actions_source, "a request",
                           record.reason);
      case SampleStatus::kLost:
        ++rates.lost;
        return base::Unit{};
      case SampleStatus::kOk:
        break;
    }
    const auto judgement = judge(*scenario_.mapping, fluents_, plan.trace, record.observations);
    auto admitted = judgement.matches() ? base::Known::kYes : base::Known::kNo;
    const bool open = scenario_.match_model && !judgement.in_no_state && plan.trace.other_outcomes;
    if (!judgement.matches() && open) admitted = traces_.admits(plan.trace, judgement.last_state);
    complete = admitted != base::Known::kUndecided;
    if (!complete) return base::Unit{};
    ++rates.runs;
    if (admitted == base::Known::kYes) return base::Unit{};
    if (judgement.first_divergence == 0) {
      const auto& fluent = judgement.first.front();
      return sink_.error(DiagnosticCode::kMappingNotInverse, scenario_.mapping_source,
                         record.sample, record.trace,
                         fluent.observed ? "a state with" : "a state without", fluent.fluent);
    }
    const Cause cause = cause_of(plan.trace, judgement, record.outcomes);
    CauseRate& rate = causes[cause.text];
    ++rates.any.count;
    if (rate.count++ == 0) {
      rate.cause = cause.text;
      rate.example = record.sample;
      rate.reason = cause.reason;
      rate.start = record.initial;
    }
    return base::Unit{};
  }

  void finish(TraceRates& rates, const std::map<std::string, CauseRate>& causes) const {
    for (const auto& [text, rate] : causes) rates.causes.push_back(rate);
    std::stable_sort(rates.causes.begin(), rates.causes.end(),
                     [](const CauseRate& a, const CauseRate& b) { return a.count > b.count; });
    for (CauseRate& rate : rates.causes) set_interval(rate, rates.runs, options_.confidence);
    rates.any.cause = "any";
    set_interval(rates.any, rates.runs, options_.confidence);
  }

  const Scenario& scenario_;
  TraceFeed& traces_;
  const RatesOptions& options_;
  base::DiagnosticSink& sink_;
  std::vector<GroundFluent> fluents_;
  bool repeats_losses_ = false;
  WorkerPool pool_;
};

}  // namespace

base::Result<RatesResult> estimate_rates(const Scenario& scenario, TraceFeed& traces,
                                         const SimulatorFactory& make_simulator,
                                         const RatesOptions& options, base::DiagnosticSink& sink) {
  return Estimator(scenario, traces, make_simulator, options, sink).run();
}

}  // namespace parallax::harness
