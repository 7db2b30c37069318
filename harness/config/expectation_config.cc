// Reads the expectations of a scenario, and checks that they can be met at all.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

#include "compiler/base/codes/scenarios.h"
#include "harness/confidence/clean_runs.h"
#include "harness/confidence/rate_evidence.h"
#include "harness/config/sections.h"

namespace parallax::harness {
namespace {

constexpr std::int64_t kDefaultRuns = 100;
constexpr double kDefaultEvidence = 0.95;

CauseExpectation read_cause(const YamlNode& node, base::DiagnosticSink& sink) {
  static constexpr std::array<std::string_view, 5> kCauseKinds = {"always", "region", "random",
                                                                  "simulator", "state"};
  const auto errors_before = sink.error_count();
  CauseExpectation cause;
  cause.source = node.range;
  YamlFields fields(node, key_text(Key::kCause), sink);
  fields.only({Key::kEvent, Key::kFluent, Key::kReason, Key::kKind});
  fields.text(Key::kEvent, cause.event);
  fields.text(Key::kFluent, cause.fluent);
  fields.text(Key::kReason, cause.reason);
  if (const auto* event = fields.find(Key::kEvent)) cause.event_source = event->range;
  if (const auto* fluent = fields.find(Key::kFluent)) cause.fluent_source = fluent->range;
  if (const auto kind = fields.choice(Key::kKind, "kind of cause", kCauseKinds)) {
    cause.kind = kCauseKinds[*kind];
  }
  if (node.is_map() && node.entries.empty() && sink.error_count() == errors_before) {
    sink.error(codes::kCaseExpectsNothing, node.range, Key::kCause);
  }
  return cause;
}

/// `below: B`, `above: A` or `between: [A, B]`, one of them.
void read_rate_bounds(const YamlFields& fields, RateExpectation& rate) {
  auto& sink = fields.sink();
  const auto* between = fields.find(Key::kBetween);
  const auto* below = fields.find(Key::kBelow);
  const auto* above = fields.find(Key::kAbove);
  if ((between != nullptr) + (below != nullptr) + (above != nullptr) > 1) {
    const auto* second = above != nullptr ? above : below;
    sink.error(codes::kYamlOutOfBounds, second->range, key_text(Key::kRate), "bounded twice",
               "given by one of `below`, `above` and `between`");
    return;
  }
  std::optional<double> upper, lower;
  fields.number(Key::kBelow, kOpenUnit, upper);
  fields.number(Key::kAbove, kOpenUnit, lower);
  rate.upper = upper.value_or(rate.upper);
  rate.lower = lower.value_or(rate.lower);
  if (below != nullptr || above != nullptr) return;
  if (fields.require(Key::kBetween) == nullptr) return;
  const auto bounds = fields.numbers(Key::kBetween, 2);
  if (!bounds) return;
  rate.lower = (*bounds)[0];
  rate.upper = (*bounds)[1];
  if (!(rate.lower >= 0.0 && rate.lower <= rate.upper && rate.upper <= 1.0)) {
    sink.error(codes::kYamlOutOfBounds, between->range, key_text(Key::kBetween),
               fmt::format("{:g} and {:g}", rate.lower, rate.upper),
               "two numbers from 0 to 1, the lower first");
  }
}

/// Is the evidence asked for such that the runs can give it? Sets their number where none is given.
void settle_runs(const YamlNode& node, const YamlFields& fields, RateExpectation& rate,
                 base::DiagnosticSink& sink) {
  const RateClaim claim{rate.lower, rate.upper, *rate.confidence};
  if (claim.bounds_nothing()) {
    sink.error(codes::kYamlOutOfBounds, node.range, key_text(Key::kBetween), "0 and 1",
               "narrower: every rate lies there");
    return;
  }
  const auto* runs = fields.find(rate.fixed_runs ? Key::kRuns : Key::kMaxRuns);
  const auto least = runs_to_support(claim, kMaxRuns, rate.fixed_runs);
  const auto refuse = [&](const std::string& why) {
    sink.error(codes::kExpectationCannotHold, runs == nullptr ? node.range : runs->range, why);
  };
  const auto what = to_string(claim);
  const auto confidence = fmt::format("with {:g} % confidence", 100.0 * claim.confidence_level);
  if (!least) {
    return refuse(
        fmt::format("not even {} runs show {} that a rate is {}", kMaxRuns, confidence, what));
  }
  if (runs == nullptr) {
    // Room for some failures.
    rate.runs = std::min(kMaxRuns, std::max(kDefaultRuns, 2 * *least));
  } else if (!can_support(claim, rate.runs, rate.fixed_runs)) {
    refuse(fmt::format("whatever {} runs come to, they do not show {} that the rate is {}; {} can",
                       rate.runs, confidence, what, *least));
  }
}

RateExpectation read_rate(const YamlNode& node, base::DiagnosticSink& sink) {
  const auto errors_before = sink.error_count();
  RateExpectation rate;
  YamlFields fields(node, key_text(Key::kRate), sink);
  fields.only({Key::kBelow, Key::kAbove, Key::kBetween, Key::kConfidence, Key::kTrace, Key::kRuns,
               Key::kMaxRuns, Key::kCause});
  fields.integer(Key::kTrace, 1, kMaxRuns, rate.trace);
  // Without either, what is to be shown says how many.
  std::optional<std::int64_t> runs;
  fields.integer(Key::kRuns, 1, kMaxRuns, runs);
  rate.runs = runs.value_or(rate.runs);
  if (const auto* most = fields.find(Key::kMaxRuns)) {
    fields.integer(Key::kMaxRuns, 1, kMaxRuns, runs);
    rate.runs = runs.value_or(rate.runs);
    rate.fixed_runs = false;
    rate.confidence = kDefaultEvidence;
    if (fields.find(Key::kRuns) != nullptr) {
      sink.error(codes::kYamlOutOfBounds, most->range, key_text(Key::kRate),
                 "given two numbers of runs", "given one of `runs` and `max_runs`");
    }
  }
  if (fields.find(Key::kBelow) != nullptr || fields.find(Key::kAbove) != nullptr) {
    rate.confidence = kDefaultEvidence;
  }
  fields.number(Key::kConfidence, {0.5, 0.999999}, rate.confidence);
  if (const auto* cause = fields.find(Key::kCause)) rate.cause = read_cause(*cause, sink);
  read_rate_bounds(fields, rate);
  if (rate.confidence && sink.error_count() == errors_before) {
    settle_runs(node, fields, rate, sink);
  }
  return rate;
}

}  // namespace

Expectation read_expectation(const YamlNode& node, base::DiagnosticSink& sink) {
  static constexpr std::array<std::string_view, 3> kVerdicts = {"discrepancy", "no-discrepancy",
                                                                "inconclusive"};
  const auto errors_before = sink.error_count();
  Expectation expect;
  expect.source = node.range;
  YamlFields fields(node, key_text(Key::kExpect), sink);
  fields.only({Key::kVerdict, Key::kIterations, Key::kMaxSimulations, Key::kFluents, Key::kCause,
               Key::kRate, Key::kTimeLimitS, Key::kFast});
  if (const auto verdict = fields.choice(Key::kVerdict, Key::kVerdict, kVerdicts)) {
    expect.verdict = std::string(kVerdicts[*verdict]);
  }
  fields.integer(Key::kIterations, 0, kMaxRuns, expect.iterations);
  fields.integer(Key::kMaxSimulations, 0, std::numeric_limits<std::int64_t>::max(),
                 expect.max_simulations);
  fields.texts(Key::kFluents, expect.fluents);
  if (const auto* fluents = fields.find(Key::kFluents)) expect.fluents_source = fluents->range;
  if (const auto* cause = fields.find(Key::kCause)) expect.cause = read_cause(*cause, sink);
  if (const auto* rate = fields.find(Key::kRate)) expect.rate = read_rate(*rate, sink);
  fields.number(Key::kTimeLimitS, kTimeout, expect.time_limit_s);
  fields.boolean(Key::kFast, expect.fast);
  if (!expect.of_run() && !expect.rate && sink.error_count() == errors_before) {
    sink.error(codes::kCaseExpectsNothing, node.range, Key::kExpect);
  }
  return expect;
}

void check_expectation(const Scenario& scenario, base::DiagnosticSink& sink) {
  if (!scenario.expect) return;
  const auto& expect = *scenario.expect;
  const auto& limits = scenario.limits;
  const auto refuse = [&](const base::SourceRange& where, const std::string& why) {
    sink.error(codes::kExpectationCannotHold, where, why);
  };
  const bool of_discrepancy = !expect.fluents.empty() || expect.cause;
  if (of_discrepancy && expect.verdict.value_or("discrepancy") != "discrepancy") {
    return refuse(expect.cause ? expect.cause->source : expect.fluents_source,
                  fmt::format("with the verdict {} nothing diverges", *expect.verdict));
  }
  const bool finds = of_discrepancy || expect.verdict == "discrepancy";
  if (finds && (expect.max_simulations == 0 || expect.iterations == 0)) {
    return refuse(expect.source, "without a simulation there is no discrepancy");
  }
  if (limits.max_traces > 0 && expect.iterations.value_or(0) > limits.max_traces) {
    return refuse(expect.source, fmt::format("{} iterations, and `max_traces` is {}",
                                             *expect.iterations, limits.max_traces));
  }
  if (expect.verdict != "no-discrepancy" || expect.iterations == 0 ||
      scenario.criterion.kind != CriterionKind::kCleanRuns) {
    return;
  }
  const auto needed = runs_needed(scenario.criterion.confidence_level, scenario.criterion.epsilon);
  if (limits.max_runs > 0 && limits.max_runs < needed) {
    return refuse(
        limits.max_runs_source.value_or(expect.source),
        fmt::format("the verdict no-discrepancy takes {} clean runs, and `max_runs` is {}", needed,
                    limits.max_runs));
  }
  const auto all = needed * std::max<std::int64_t>(1, expect.iterations.value_or(1));
  if (expect.max_simulations && *expect.max_simulations < all) {
    refuse(
        expect.source,
        fmt::format("the verdict no-discrepancy takes {} simulations, and `max_simulations` is {}",
                    all, *expect.max_simulations));
  }
}

}  // namespace parallax::harness
