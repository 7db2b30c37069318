#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "compiler/base/json.h"
#include "compiler/base/shown_text.h"
#include "harness/campaign/run_setup.h"
#include "harness/campaign/start_words.h"
#include "harness/confidence/criterion.h"
#include "harness/confidence/rounding.h"
#include "harness/report/law_json.h"
#include "harness/report/report.h"
#include "harness/simulator/state_json.h"

namespace parallax::harness {
namespace {

using OrderedJson = nlohmann::ordered_json;

OrderedJson rate_object(const CauseRate& rate) {
  OrderedJson object = {{"cause", rate.cause},
                        {"count", rate.count},
                        {"rate", rate.rate},
                        {"lower", rate.lower},
                        {"upper", rate.upper}};
  if (rate.example > 0) object["example"] = rate.example;
  if (!rate.reason.empty()) object["reason"] = rate.reason;
  if (!rate.start.empty()) object["start"] = state_json<OrderedJson>(rate.start);
  if (rate.example > 0) {
    object["event"] = rate.event;
    object["fluents"] = rate.fluents;
  }
  if (!rate.kind.empty()) object["kind"] = rate.kind;
  return object;
}

std::string percent(const CauseRate& rate, std::int64_t runs) {
  if (runs == 0) return "nothing is known";
  return fmt::format("{:>7}  [{}, {}]", percent_about(rate.rate),
                     percent_figure(rate.lower, Round::kDown),
                     percent_figure(rate.upper, Round::kUp));
}

/// Whether it came out, before all runs were made, that the rate is as asked.
std::string known_text(const RateClaim& claim, Evidence evidence) {
  const auto* is = evidence == Evidence::kSupports ? "it is" : "it is not";
  return fmt::format("  {} {} (with {} confidence)\n",
                     evidence == Evidence::kTooLittle ? "not known whether it is" : is,
                     to_string(claim), level_text(claim.confidence_level));
}

}  // namespace

std::string rates_text(const RatesResult& result) {
  std::string out =
      fmt::format("{}, seed {}; {} compared; intervals with {} confidence ({}{})\n",
                  base::printable(result.scenario), result.seed,
                  result.comparison == Comparison::kFinal ? "last states" : "every step",
                  level_text(result.confidence), interval_name(result), kSupposition);
  for (const TraceRates& trace : result.traces) {
    out += fmt::format("\ntrace {}: {} runs, {} starts rejected, {} lost\n  {}\n", trace.number,
                       trace.runs, trace.rejected, trace.lost, trace.trace);
    if (!trace.starts.is_single()) {
      out += fmt::format("  {}\n", tried_text(trace.starts));
      for (const auto& text : failing_states(trace.starts)) out += "  fails: " + text + "\n";
    }
    if (trace.law) {
      out += fmt::format("  starts: {}\n", trace.law->text());
      const auto refused = trace.law->refused_text();
      if (!refused.empty()) out += fmt::format("  refused: {}\n", refused);
    }
    if (!trace.left_out.empty()) out += fmt::format("  left out: {}\n", trace.left_out);
    if (trace.of_the_solver > 0) {
      out += fmt::format(
          "  {} of the lost ones showed what the solver made up, and are no discrepancies\n",
          trace.of_the_solver);
    }
    if (trace.unseen > 0) out += "  " + unseen_text(trace.unseen) + "\n";
    out += fmt::format("  {:>6} of {:<6} {:<26} any discrepancy\n", trace.any.count, trace.runs,
                       percent(trace.any, trace.runs));
    if (result.until_known) out += known_text(*result.until_known, result.evidence(trace));
    if (result.is_too_wide(trace)) {
      out += fmt::format("  not as narrow as asked, {:g} points; give more --runs\n",
                         100.0 * result.until_width);
    }
    for (const CauseRate& rate : trace.causes) {
      out += fmt::format("  {:>6} of {:<6} {:<26} {}\n", rate.count, trace.runs,
                         percent(rate, trace.runs), rate.cause);
      out += fmt::format("{:46}first in sample {}{}{}\n", "", rate.example,
                         rate.reason.empty() ? "" : ": ", rate.reason);
      if (!rate.kind.empty()) out += fmt::format("{:46}kind of cause: {}\n", "", rate.kind);
    }
  }
  if (result.complete && result.traces.empty()) out += "\nno trace, so nothing was simulated\n";
  if (!result.complete) out += "\nstopped before all runs were made\n";
  return out;
}

std::string_view interval_name(const RatesResult& result) {
  return result.fixed_runs ? "Clopper-Pearson" : "valid whenever one looks";
}

std::string rates_json(const RatesResult& result) {
  OrderedJson document = {{"status", "ok"},
                          {"scenario", result.scenario},
                          {"seed", result.seed},
                          {"confidence", result.confidence},
                          {"intervals", result.fixed_runs ? "clopper-pearson" : "anytime"},
                          {"compare", to_string(result.comparison)},
                          {"complete", result.complete},
                          {"traces", OrderedJson::array()}};
  for (const TraceRates& trace : result.traces) {
    OrderedJson causes = OrderedJson::array();
    for (const CauseRate& rate : trace.causes) causes.push_back(rate_object(rate));
    document["traces"].push_back({{"trace", trace.number},
                                  {"events", trace.trace},
                                  {"runs", trace.runs},
                                  {"rejected", trace.rejected},
                                  {"lost", trace.lost},
                                  {"unseen", trace.unseen},
                                  {"any", rate_object(trace.any)},
                                  {"causes", std::move(causes)}});
    auto& object = document["traces"].back();
    if (trace.of_the_solver > 0) object["of_the_solver"] = trace.of_the_solver;
    object["initial_states"] = starts_json<OrderedJson>(trace.starts);
    if (trace.law) object["law"] = law_json<OrderedJson>(*trace.law);
    if (!trace.left_out.empty()) object["left_out"] = trace.left_out;
    if (result.until_width > 0.0) object["narrow"] = !result.is_too_wide(trace);
    if (!result.until_known) continue;
    const auto evidence = result.evidence(trace);
    object["claim"] = {{"rate", to_string(*result.until_known)}, {"holds", nullptr}};
    if (evidence != Evidence::kTooLittle) {
      object["claim"]["holds"] = evidence == Evidence::kSupports;
    }
  }
  return base::json_text(document) + "\n";
}

}  // namespace parallax::harness
