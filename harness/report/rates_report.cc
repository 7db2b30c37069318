#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "compiler/base/json.h"
#include "compiler/base/shown_text.h"
#include "harness/campaign/run_setup.h"
#include "harness/campaign/start_words.h"
#include "harness/confidence/criterion.h"
#include "harness/confidence/rounding.h"
#include "harness/report/law_json.h"
#include "harness/report/report.h"
#include "harness/report/report_words.h"
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

std::string number_text(std::optional<double> value, int decimals, Round round) {
  return value ? decimal_figure(*value, decimals, round) : std::string("-");
}

/// Mean and quantiles of one reported number.
std::string value_text(const ReportedValue& value, const TraceRates& trace) {
  const auto name = base::printable(value.name);
  if (!value.summary) return fmt::format("  {}: no run reported it\n", name);
  const auto& found = *value.summary;
  // Four significant digits of the largest number.
  const double largest = std::max(std::abs(found.least), std::abs(found.most));
  const int decimals =
      largest > 0.0 ? std::clamp(3 - static_cast<int>(std::floor(std::log10(largest))), 0, 12) : 0;
  const auto interval = [&](std::optional<double> lower, std::optional<double> upper) {
    return fmt::format("[{}, {}]", number_text(lower, decimals, Round::kDown),
                       number_text(upper, decimals, Round::kUp));
  };
  const auto about = [&](double number) {
    return decimal_figure(number, decimals, Round::kNearest);
  };
  auto out = fmt::format("  {}{} in {} runs: {} to {}, sd {}\n", name,
                         value.name == "duration" ? " [s]" : "", found.count, about(found.least),
                         about(found.most), about(found.sd));
  out += fmt::format(
      "    {:<6} {:>10}  {}\n", "mean", about(found.mean),
      found.mean_lower ? interval(found.mean_lower, found.mean_upper) + "  Student's t, approximate"
                       : std::string());
  for (const auto& quantile : found.quantiles) {
    out += fmt::format("    {:<6} {:>10}  {}\n",
                       fmt::format("{:.0f} %", 100.0 * quantile.probability), about(quantile.value),
                       quantile.lower || quantile.upper ? interval(quantile.lower, quantile.upper) +
                                                              "  order statistics, any distribution"
                                                        : std::string());
  }
  if (value.without > 0) out += fmt::format("    {} runs did not report it\n", value.without);
  if (trace.unseen > 0) {
    out += fmt::format(
        "    {} lost or missing runs: not in the mean; intervals of quantiles allow "
        "for any value\n",
        trace.unseen);
  }
  return out;
}

OrderedJson value_json(const ReportedValue& value, const TraceRates& trace) {
  OrderedJson out = {
      {"name", value.name}, {"runs", 0}, {"without", value.without}, {"lost", trace.unseen}};
  if (!value.summary) return out;
  const auto& found = *value.summary;
  const auto number = [](std::optional<double> of) {
    return of ? OrderedJson(*of) : OrderedJson(nullptr);
  };
  out["runs"] = found.count;
  out["mean"] = {{"value", found.mean},
                 {"lower", number(found.mean_lower)},
                 {"upper", number(found.mean_upper)},
                 {"interval", "student-t"}};
  out["sd"] = found.sd;
  out["least"] = found.least;
  out["most"] = found.most;
  out["quantiles"] = OrderedJson::array();
  for (const auto& one : found.quantiles) {
    out["quantiles"].push_back({{"probability", one.probability},
                                {"value", one.value},
                                {"lower", number(one.lower)},
                                {"upper", number(one.upper)},
                                {"interval", "order-statistics"}});
  }
  return out;
}

/// The answer of the sequential test: each is guaranteed up to the far end of the region only.
std::string sequential_text(const IndifferenceRegion& region, SequentialAnswer answer) {
  const auto level = level_text(region.confidence_level);
  const auto from = 100.0 * region.lower, to = 100.0 * region.upper;
  switch (answer) {
    case SequentialAnswer::kBelow:
      return fmt::format("  sequential test: below {:.10g} % (with {} confidence)\n", to, level);
    case SequentialAnswer::kAbove:
      return fmt::format("  sequential test: above {:.10g} % (with {} confidence)\n", from, level);
    case SequentialAnswer::kUnsettled:
      return fmt::format(
          "  sequential test: undecided between below {:.10g} % and above {:.10g} %; it depends on "
          "what the lost "
          "runs would have shown\n",
          to, from);
    case SequentialAnswer::kOpen:
      break;
  }
  return fmt::format(
      "  sequential test: undecided between below {:.10g} % and above {:.10g} %; give more "
      "--runs\n",
      to, from);
}

/// Whether it came out, before all runs were made, that the rate is as asked.
std::string known_text(const RateClaim& claim, RateVerdict evidence) {
  const auto* is = evidence == RateVerdict::kSupports ? "it is" : "it is not";
  return fmt::format("  {} {} (with {} confidence)\n",
                     evidence == RateVerdict::kTooLittle ? "not known whether it is" : is,
                     to_string(claim), level_text(claim.confidence_level));
}

void add_sequential(const IndifferenceRegion& region, SequentialAnswer answer, OrderedJson& claim) {
  claim["test"] = "sequential-probability-ratio";
  claim["indifference"] = {region.lower, region.upper};
  // 1 - 0.95 is 0.05, whatever its last bits say.
  const double error = std::round((1.0 - region.confidence_level) * 1e12) / 1e12;
  claim["errors"] = {{"below", error}, {"above", error}};
  claim["answer"] = to_string(answer);
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
    if (result.indifference) {
      out += sequential_text(*result.indifference, trace.sequential);
    } else if (result.until_known) {
      out += known_text(*result.until_known, result.evidence(trace));
    }
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
    for (const auto& value : trace.values) out += value_text(value, trace);
  }
  for (const auto& bound : result.bounds) out += fmt::format("\nbound: {}\n", bound);
  if (!result.kinds.empty()) out += fmt::format("\nworkers: {}\n", kinds_text(result.kinds));
  if (result.complete && result.traces.empty()) out += "\nno trace, so nothing was simulated\n";
  for (const auto& bound : result.bounds) out += fmt::format("\nnot all traces: {}\n", bound);
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
                          {"compared", OrderedJson::array()},
                          {"match", result.match_model ? "model" : "trace"},
                          {"complete", result.complete},
                          {"traces", OrderedJson::array()}};
  for (const auto& entry : result.compared) {
    document["compared"].push_back({{"fluent", entry.fluent}, {"compared", to_string(entry.how)}});
  }
  const auto add_name = [&](const char* name, const std::string& value) {
    if (!value.empty()) document[name] = value;
  };
  add_name("simulator", result.simulator);
  add_name("scenario_hash", result.scenario_hash);
  add_name("starts_hash", result.starts_hash);
  add_name("judging_hash", result.judging_hash);
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
    if (!trace.starts.states_hash.empty()) {
      object["initial_states"]["states_hash"] = trace.starts.states_hash;
    }
    if (trace.law) object["law"] = law_json<OrderedJson>(*trace.law);
    if (!trace.left_out.empty()) object["left_out"] = trace.left_out;
    for (const auto& value : trace.values) object["values"].push_back(value_json(value, trace));
    for (const auto& one : trace.outcomes) {
      object["samples"].push_back({{"outcome", one.outcome}, {"start", one.start}});
    }
    if (result.until_width > 0.0) object["narrow"] = !result.is_too_wide(trace);
    if (!result.until_known) continue;
    const auto evidence = result.evidence(trace);
    object["claim"] = {{"rate", to_string(*result.until_known)}, {"holds", nullptr}};
    if (evidence != RateVerdict::kTooLittle) {
      object["claim"]["holds"] = evidence == RateVerdict::kSupports;
    }
    if (result.indifference)
      add_sequential(*result.indifference, trace.sequential, object["claim"]);
  }
  for (const auto& one : result.kinds) {
    document["kinds"].push_back({{"kind", one.kind}, {"simulations", one.simulations}});
  }
  if (!result.bounds.empty()) document["bounds"] = result.bounds;
  return base::json_text(document) + "\n";
}

}  // namespace parallax::harness
