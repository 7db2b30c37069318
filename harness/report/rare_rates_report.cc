#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "compiler/base/json.h"
#include "compiler/base/shown_text.h"
#include "harness/campaign/start_words.h"
#include "harness/confidence/rounding.h"
#include "harness/report/law_json.h"
#include "harness/report/report.h"

namespace parallax::harness {
namespace {

using RareJson = nlohmann::ordered_json;

std::string what_it_rests_on(const RareRatesResult& result) {
  return result.method == RareEventMethod::kImportance
             ? "they hold whatever the simulator does, supposing that no run affects another"
             : "they suppose that moves reach every place with discrepancies";
}

std::string importance_text(const RareEventResult& estimate) {
  return fmt::format(
      "  from {} runs, {} of them uniform, after {} to find where to look; {} discrepancies, worth "
      "{:.0f}\n  standard error {:.1e} where discrepancies were found; the interval is also about "
      "elsewhere\n",
      estimate.runs - estimate.exploring, estimate.uniform, estimate.exploring, estimate.found,
      estimate.effective, estimate.standard_error);
}

std::string splitting_text(const RareEventResult& estimate) {
  return fmt::format(
      "  from {} independent estimates, {:.0f} % of moves made; their variance is {:.1f} times "
      "what "
      "it is at best\n",
      estimate.estimates.size(), 100.0 * estimate.acceptance, estimate.excess);
}

RareJson interval_object(const RareEventResult& estimate, RareEventMethod method) {
  const bool estimated = estimate.end == RareEventEnd::kEstimated;
  RareJson object = {{"rate", estimated ? RareJson(estimate.probability) : RareJson(nullptr)},
                     {"lower", estimate.lower},
                     {"upper", estimate.upper}};
  if (estimated) object["standard_error"] = estimate.standard_error;
  if (method == RareEventMethod::kImportance) {
    object["exploring"] = estimate.exploring;
    object["uniform"] = estimate.uniform;
    object["discrepancies"] = estimate.found;
    object["effective"] = estimate.effective;
  } else {
    object["estimates"] = estimate.estimates;
    object["acceptance"] = estimate.acceptance;
    object["excess"] = estimate.excess;
  }
  return object;
}

/// Something is said of p.
bool has_interval(const RareEventResult& estimate, RareEventMethod method) {
  return estimate.end == RareEventEnd::kEstimated ||
         (estimate.end == RareEventEnd::kUnreached && method == RareEventMethod::kImportance);
}

/// The initial states with a discrepancy. The method chose where to begin, so counts would say
/// nothing of rates.
std::string seen_states(const StartResult& starts) {
  constexpr std::size_t kMostShown = 6;
  std::string out;
  std::size_t failing = 0;
  for (const auto& [number, counts] : starts.states) {
    if (counts.discrepancies == 0) continue;
    if (++failing <= kMostShown) out += "  a discrepancy from " + counts.text + "\n";
  }
  if (failing > kMostShown) {
    out += fmt::format("  and from {} more initial states\n", failing - kMostShown);
  }
  return out;
}

}  // namespace

std::string rates_text(const RareRatesResult& result) {
  std::string out = fmt::format(
      "{}, seed {}; {} compared; intervals with {} confidence by {}: {}\n",
      base::printable(result.scenario), result.seed,
      result.comparison == Comparison::kFinal ? "last states" : "every step",
      level_text(result.confidence), to_string(result.method), what_it_rests_on(result));
  for (const RareTraceRate& trace : result.traces) {
    const auto& estimate = trace.estimate;
    out += fmt::format("\ntrace {}: {} runs, {} starts rejected, {} lost\n  {}\n", trace.number,
                       estimate.runs, estimate.invalid, estimate.lost, trace.trace);
    if (!trace.starts.is_single()) {
      out += fmt::format("  {}\n", tried_text(trace.starts));
      out += seen_states(trace.starts);
    }
    if (!trace.law.empty()) out += fmt::format("  starts: {}\n", trace.law);
    if (!trace.left_out.empty()) out += fmt::format("  left out: {}\n", trace.left_out);
    const auto why = why_unanswered(trace, result);
    if (!why.empty()) {
      out += fmt::format("  {}\n", why);
    } else {
      out += fmt::format(
          "  {}  [{}, {}]  any discrepancy\n", small_figure(estimate.probability, Round::kNearest),
          small_figure(estimate.lower, Round::kDown), small_figure(estimate.upper, Round::kUp));
      out += result.method == RareEventMethod::kImportance ? importance_text(estimate)
                                                           : splitting_text(estimate);
    }
    for (const auto& part : trace.contradicting) {
      out += fmt::format("  left out, as it is below zero where all went as predicted: {}\n", part);
    }
  }
  for (const auto& bound : result.bounds) out += fmt::format("\nbound: {}\n", bound);
  if (result.complete && result.traces.empty()) out += "\nno trace, so nothing was simulated\n";
  for (const auto& bound : result.bounds) out += fmt::format("\nnot all traces: {}\n", bound);
  return out;
}

std::string rates_json(const RareRatesResult& result) {
  RareJson document = {{"status", "ok"},
                       {"scenario", result.scenario},
                       {"seed", result.seed},
                       {"confidence", result.confidence},
                       {"method", to_string(result.method)},
                       {"compare", to_string(result.comparison)},
                       {"complete", result.complete},
                       {"traces", RareJson::array()}};
  for (const RareTraceRate& trace : result.traces) {
    const auto& estimate = trace.estimate;
    RareJson object = {{"trace", trace.number},          {"events", trace.trace},
                       {"runs", estimate.runs},          {"rejected", estimate.invalid},
                       {"lost", estimate.lost},          {"end", to_string(estimate.end)},
                       {"left_out", trace.contradicting}};
    object["initial_states"] = starts_json<RareJson>(trace.starts);
    object["initial_states"]["chosen_by"] = to_string(result.method);
    if (!trace.law.empty()) object["law"] = trace.law;
    if (!trace.left_out.empty()) object["left_out"] = trace.left_out;
    if (has_interval(estimate, result.method)) {
      object["any"] = interval_object(estimate, result.method);
    } else {
      object["reason"] = why_unanswered(trace, result);
    }
    document["traces"].push_back(std::move(object));
  }
  if (!result.bounds.empty()) document["bounds"] = result.bounds;
  return base::json_text(document) + "\n";
}

}  // namespace parallax::harness
