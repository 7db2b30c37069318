#include "harness/campaign/rare_rates.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "compiler/base/codes/campaigns.h"
#include "harness/campaign/asked_traces.h"
#include "harness/campaign/sample_margin.h"
#include "harness/campaign/search_phase.h"
#include "harness/campaign/start_law.h"
#include "harness/campaign/start_words.h"
#include "harness/campaign/trial.h"
#include "harness/confidence/rounding.h"

namespace parallax::harness {
namespace {

/// Points for each job that are simulated before the next ones are made ready, and progress is
/// shown; results do not depend on it.
constexpr std::size_t kPointsOfJob = 8;

class RareEstimator {
 public:
  RareEstimator(const Scenario& scenario, TraceFeed& traces, const SimulatorFactory& make_simulator,
                const RatesOptions& options, RareEventMethod method, base::DiagnosticSink& sink)
      : scenario_(scenario),
        traces_(traces),
        options_(options),
        method_(method),
        sink_(sink),
        bench_(
            scenario, traces, make_simulator, {options.seed, options.jobs, options.stop},
            [](const SampleRecord&) {}, sink) {}

  base::Result<RareRatesResult> run() {
    RareRatesResult result;
    result.scenario = scenario_.name;
    result.seed = options_.seed;
    result.confidence = options_.confidence;
    result.method = method_;
    result.budget = options_.runs;
    result.comparison = scenario_.comparison();
    const auto visit = [&](CampaignTrace trace) -> base::Result<bool> {
      auto rate = one_trace(std::move(trace));
      if (!rate) return sink_.already_reported();
      const bool complete = rate->estimate.end != RareEventEnd::kStopped;
      result.traces.push_back(std::move(*rate));
      return complete;
    };
    const auto complete =
        visit_asked_traces(bench_, traces_, options_.trace, scenario_.name, visit, sink_);
    if (!complete) return sink_.already_reported();
    result.complete = *complete;
    if (options_.trace == 0) result.bounds = traces_.bounds();
    return result;
  }

 private:
  base::Result<RareTraceRate> one_trace(CampaignTrace found) {
    auto trial = Trial::prepare(bench_, std::move(found));
    if (!trial) return sink_.already_reported();
    const auto& trace = *trial->plan().trace;
    RareTraceRate rate;
    rate.number = trace.number;
    rate.trace = trace.events();
    LawCounter law;
    law.name(trial->plan().sampler);
    rate.law = law.drawn().law;
    rate.left_out = law.drawn().left_out;
    trial->starts().describe(rate.starts, trial->next_sample() - 1);
    if (!trial->starts().count()) {
      return sink_.error(codes::kTooManyInitialStates, base::SourceRange{scenario_.source, 0, 0},
                         kMostInitialStates);
    }
    const auto made = StartCube::make(trial->starts(), scenario_, bench_.fluents(), sink_);
    if (!made) return sink_.already_reported();
    const auto& cube = *made;
    RareEventOptions options;
    options.method = method_;
    options.dimensions = std::max<std::size_t>(1, cube.dimensions());
    options.budget = options_.runs;
    options.confidence = options_.confidence;
    options.seed = search_seed(trial->plan());
    MarginScale scale;
    std::int64_t next = 1;
    bool failed = false;
    RareEventResult unfinished;  // counts of a batch that was not simulated to its end
    rate.estimate = estimate_rare_event(options, [&](std::span<const UnitPoint> points) {
      return simulated(*trial, cube, points, next, scale, failed, unfinished, rate.starts);
    });
    trial->end();
    if (failed) return sink_.already_reported();
    rate.estimate.runs += unfinished.runs;
    rate.estimate.lost += unfinished.lost;
    rate.estimate.invalid += unfinished.invalid;
    rate.contradicting.assign(scale.contradicting().begin(), scale.contradicting().end());
    // Initial states are equally likely, and a start that is not valid is drawn again within its
    // state. Points of the cube are drawn anew in all states together, so where some lose more
    // starts they would count for less.
    const bool has_answer = rate.estimate.end == RareEventEnd::kEstimated ||
                            rate.estimate.end == RareEventEnd::kUnreached;
    if (has_answer && rate.estimate.invalid > 0 && !rate.starts.is_single()) {
      rate.estimate.end = RareEventEnd::kUnequal;
    }
    return rate;
  }

  std::optional<std::vector<Evaluation>> simulated(Trial& trial, const StartCube& cube,
                                                   std::span<const UnitPoint> points,
                                                   std::int64_t& next, MarginScale& scale,
                                                   bool& failed, RareEventResult& unfinished,
                                                   StartResult& starts_seen) const {
    const bool is_first = scale.size() == 0;
    const auto at_once = kPointsOfJob * static_cast<std::size_t>(options_.jobs);
    std::vector<Evaluation> out;
    std::vector<MarginParts> parts;
    for (std::size_t begin = 0; begin < points.size(); begin += at_once) {
      const auto count = std::min(at_once, points.size() - begin);
      std::vector<std::optional<ChosenStart>> starts;
      for (const auto& point : points.subspan(begin, count)) starts.push_back(cube.start_at(point));
      const auto tried = trial.try_starts(next, std::move(starts));
      failed = !tried;
      if (failed) return std::nullopt;
      if (!*tried) {
        count_runs(out, unfinished);
        return std::nullopt;
      }
      next += static_cast<std::int64_t>(count);
      report_progress(trial.plan().trace->number, next - 1);
      for (std::size_t i = 0; i < (**tried).size(); ++i) {
        const auto& sample = (**tried)[i];
        Evaluation answer{points[begin + i], evaluation_kind(sample)};
        if (answer.kind != EvaluationKind::kInvalid) {
          count_start(trial.starts(), sample, starts_seen);
        }
        parts.emplace_back();
        if (sample.verdict == SampleVerdict::kLostTooOften) {
          out.push_back(std::move(answer));
          count_runs(out, unfinished);
          return std::nullopt;
        }
        if (answer.kind == EvaluationKind::kClean || answer.kind == EvaluationKind::kDiscrepancy) {
          parts.back() = margin_parts(*scenario_.mapping, bench_.fluents(),
                                      *trial.plan_of(sample.record).trace, scenario_.comparison(),
                                      sample.record);
          if (is_first) scale.add(parts.back(), answer.kind == EvaluationKind::kDiscrepancy);
        }
        out.push_back(std::move(answer));
      }
    }
    for (std::size_t i = 0; i < out.size(); ++i) {
      const bool discrepancy = out[i].kind == EvaluationKind::kDiscrepancy;
      // Where no part of a margin counts all clean simulations are alike.
      if (discrepancy || out[i].kind == EvaluationKind::kClean) {
        out[i].margin = scale.margin_of(parts[i], discrepancy).value_or(1.0);
      }
    }
    return out;
  }

  void report_progress(std::int64_t trace, std::int64_t done) const {
    if (!options_.progress) return;
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - started_;
    const auto made = static_cast<double>(bench_.runs_made());
    options_.progress(
        {trace, done, options_.runs, elapsed.count() > 0.0 ? made / elapsed.count() : 0.0});
  }

  const Scenario& scenario_;
  TraceFeed& traces_;
  const RatesOptions& options_;
  RareEventMethod method_;
  base::DiagnosticSink& sink_;
  std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
  TrialBench bench_;
};

}  // namespace

bool RareRatesResult::is_answered() const {
  return complete && std::all_of(traces.begin(), traces.end(), [](const auto& trace) {
           return trace.estimate.end == RareEventEnd::kEstimated;
         });
}

base::Result<RareRatesResult> estimate_rare_rates(const Scenario& scenario, TraceFeed& traces,
                                                  const SimulatorFactory& make_simulator,
                                                  const RatesOptions& options,
                                                  RareEventMethod method,
                                                  base::DiagnosticSink& sink) {
  return RareEstimator(scenario, traces, make_simulator, options, method, sink).run();
}

std::string why_unanswered(const RareTraceRate& rate, const RareRatesResult& result) {
  const auto& estimate = rate.estimate;
  switch (estimate.end) {
    case RareEventEnd::kEstimated:
      break;
    case RareEventEnd::kUnreached:
      if (result.method == RareEventMethod::kSplitting) {
        return fmt::format(
            "{} runs did not lead to discrepancies: they are rarer than one start in so many, or "
            "margins do not lead there; give more --runs",
            result.budget);
      }
      return fmt::format(
          "not resolved: none of the {} runs that count gave a discrepancy, so with {} "
          "confidence fewer than {} of the starts do; give more --runs",
          estimate.runs - estimate.exploring, level_text(result.confidence),
          small_figure(estimate.upper, Round::kUp));
    case RareEventEnd::kFlat:
      return "no margin of the first runs changed, so none leads to discrepancies; --method "
             "importance needs none, nor does counting (no --method)";
    case RareEventEnd::kUnresolved:
      return fmt::format(
          "not resolved: {} (estimates from {:.2g} to {:.2g}); give more --runs, or --method "
          "importance",
          estimate.excess > 0.0 && estimate.acceptance >= 0.05
              ? "independent estimates differ by too much to make an interval of them"
              : "hardly any move was made",
          *std::min_element(estimate.estimates.begin(), estimate.estimates.end()),
          *std::max_element(estimate.estimates.begin(), estimate.estimates.end()));
    case RareEventEnd::kLost:
      return "runs were lost, for which splitting has no worst case; --method importance has one";
    case RareEventEnd::kInvalid:
      return "hardly any start is valid";
    case RareEventEnd::kUnequal:
      return fmt::format(
          "{} of the drawn starts were not valid, and initial states need not lose equally many of "
          "theirs, so this is no rate over equally likely states; count (without --method), or fix "
          "the initial state in the model",
          estimate.invalid);
    case RareEventEnd::kStopped:
      return "stopped before all runs were made";
  }
  return {};
}

}  // namespace parallax::harness
