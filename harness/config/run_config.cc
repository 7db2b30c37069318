#include <fmt/format.h>

#include <array>
#include <limits>

#include "compiler/base/diagnostic_codes.h"
#include "harness/config/sections.h"

namespace parallax::harness {
namespace {

using base::DiagnosticCode;

constexpr std::int64_t kMaxRuns = 1'000'000;
constexpr double kMaxTimeoutS = 86400.0;
constexpr NumberBounds kTimeout{0.0, kMaxTimeoutS, true, false};

constexpr std::array<std::string_view, 2> kKinds = {"clean-runs", "paper"};
constexpr std::array<std::string_view, 2> kPresets = {"paper-literal", "paper-repaired"};
constexpr std::array<std::string_view, 3> kSigmas = {"sse", "rmse", "residual-sd"};
constexpr std::array<std::string_view, 2> kRoots = {"initial", "final"};
constexpr std::array<std::string_view, 3> kIntercepts = {"none", "centred", "free"};
constexpr std::array<std::string_view, 2> kIntervals = {"mean", "prediction"};

/// Takes the position of a word as the enumerator, which stands at the same one in its enum.
template <typename Enum, std::size_t Count>
bool read_enum(const YamlFields& fields, std::string_view key,
               const std::array<std::string_view, Count>& words, Enum& out) {
  const auto choice = fields.choice(key, fmt::format("value of `{}`", key), words);
  if (choice) out = static_cast<Enum>(*choice);
  return choice.has_value();
}

/// A preset, and single readings laid over it; the report then calls the result "custom".
void read_paper_rule(const YamlFields& fields, PaperRuleSpec& rule) {
  const auto preset = fields.choice("preset", "preset", kPresets);
  if (preset == std::size_t{1}) rule = paper_repaired();
  bool changed = read_enum(fields, "sigma", kSigmas, rule.sigma);
  changed = read_enum(fields, "root", kRoots, rule.root) || changed;
  changed = read_enum(fields, "intercept", kIntercepts, rule.intercept) || changed;
  changed = read_enum(fields, "interval", kIntervals, rule.interval) || changed;
  changed = changed || fields.find("extra_runs") != nullptr ||
            fields.find("exempt_inherited") != nullptr || fields.find("tolerance_m") != nullptr ||
            fields.find("bonferroni") != nullptr;
  fields.integer("extra_runs", 0, kMaxRuns, rule.extra_runs);
  fields.boolean("exempt_inherited", rule.exempt_inherited);
  fields.number("tolerance_m", kNotNegative, rule.tolerance_m);
  fields.boolean("bonferroni", rule.bonferroni);
  if (changed) rule.preset = "custom, from " + rule.preset;
}

}  // namespace

CriterionSpec read_criterion(const YamlNode& node, base::DiagnosticSink& sink) {
  CriterionSpec criterion;
  criterion.paper = paper_literal();
  // A word alone stands for a criterion with its defaults.
  YamlNode map = node;
  if (node.is_scalar()) {
    map = YamlNode{YamlNode::Kind::kMap, node.range, {}, false, {}, {}};
    map.entries.push_back({"kind", node.range, node});
  }
  YamlFields fields(map, "`criterion`", sink);
  fields.only({"kind", "confidence", "epsilon", "preset", "sigma", "root", "intercept", "interval",
               "extra_runs", "exempt_inherited", "tolerance_m", "bonferroni"});
  if (fields.choice("kind", "criterion", kKinds) == std::size_t{1}) {
    criterion.kind = CriterionKind::kPaper;
  }
  fields.number("confidence", kOpenUnit, criterion.confidence_level);
  fields.number("epsilon", kOpenUnit, criterion.epsilon);
  read_paper_rule(fields, criterion.paper);
  return criterion;
}

SimulatorSpec read_simulator(const YamlNode& node, base::DiagnosticSink& sink) {
  SimulatorSpec simulator;
  simulator.source = node.range;
  if (node.is_scalar()) {
    if (node.text == "ode") return simulator;
    auto error = sink.error(DiagnosticCode::kYamlUnknownChoice, node.range, node.text, "simulator");
    const std::vector<std::string> known = {"ode"};
    add_suggestion(error, node.text, known, "known, besides `command: [...]`");
    return simulator;
  }
  YamlFields fields(node, "`simulator`", sink);
  fields.only({"command", "hello_timeout_s", "reset_timeout_s", "act_timeout_s",
               "observe_timeout_s", "close_timeout_s", "min_real_time_factor", "recycle_after"});
  fields.texts("command", simulator.command);
  const auto* command = fields.find("command");
  if (command != nullptr && command->is_list() && command->items.empty()) {
    sink.error(DiagnosticCode::kWrongYamlKind, command->range, "`command`", "empty",
               "a list of a program and its arguments");
  }
  fields.number("hello_timeout_s", kTimeout, simulator.hello_timeout_s);
  fields.number("reset_timeout_s", kTimeout, simulator.reset_timeout_s);
  fields.number("act_timeout_s", kTimeout, simulator.act_timeout_s);
  fields.number("observe_timeout_s", kTimeout, simulator.observe_timeout_s);
  fields.number("close_timeout_s", kTimeout, simulator.close_timeout_s);
  fields.number("min_real_time_factor", kPositive, simulator.min_real_time_factor);
  fields.integer("recycle_after", 0, kMaxRuns, simulator.recycle_after);
  return simulator;
}

Limits read_limits(const YamlNode& node, base::DiagnosticSink& sink) {
  Limits limits;
  YamlFields fields(node, "`limits`", sink);
  fields.only({"max_runs", "max_traces", "max_rejected_starts", "max_lost_in_a_row"});
  fields.integer("max_runs", 0, kMaxRuns, limits.max_runs);
  if (const auto* max_runs = fields.find("max_runs")) limits.max_runs_source = max_runs->range;
  fields.integer("max_traces", 0, kMaxRuns, limits.max_traces);
  fields.integer("max_rejected_starts", 1, kMaxRuns, limits.max_rejected_starts);
  fields.integer("max_lost_in_a_row", 1, kMaxRuns, limits.max_lost_in_a_row);
  return limits;
}

namespace {

RateExpectation read_rate(const YamlNode& node, base::DiagnosticSink& sink) {
  RateExpectation rate;
  YamlFields fields(node, "`rate`", sink);
  fields.only({"between", "trace", "runs"});
  fields.integer("trace", 1, kMaxRuns, rate.trace);
  fields.integer("runs", 1, kMaxRuns, rate.runs);
  const auto* between = fields.require("between");
  const auto bounds = fields.numbers("between", 2);
  if (between == nullptr || !bounds) return rate;
  rate.lower = (*bounds)[0];
  rate.upper = (*bounds)[1];
  if (!(rate.lower >= 0.0 && rate.lower <= rate.upper && rate.upper <= 1.0)) {
    sink.error(DiagnosticCode::kYamlOutOfBounds, between->range, "`between`",
               fmt::format("{:g} and {:g}", rate.lower, rate.upper),
               "two numbers from 0 to 1, the lower first");
  }
  return rate;
}

}  // namespace

Expectation read_expectation(const YamlNode& node, base::DiagnosticSink& sink) {
  static constexpr std::array<std::string_view, 3> kVerdicts = {"discrepancy", "no-discrepancy",
                                                                "inconclusive"};
  const auto errors_before = sink.error_count();
  Expectation expect;
  YamlFields fields(node, "`expect`", sink);
  fields.only(
      {"verdict", "iterations", "max_simulations", "fluents", "rate", "time_limit_s", "fast"});
  if (const auto verdict = fields.choice("verdict", "verdict", kVerdicts)) {
    expect.verdict = std::string(kVerdicts[*verdict]);
  }
  fields.integer("iterations", 0, kMaxRuns, expect.iterations);
  fields.integer("max_simulations", 0, std::numeric_limits<std::int64_t>::max(),
                 expect.max_simulations);
  fields.texts("fluents", expect.fluents);
  if (const auto* fluents = fields.find("fluents")) expect.fluents_source = fluents->range;
  if (const auto* rate = fields.find("rate")) expect.rate = read_rate(*rate, sink);
  fields.number("time_limit_s", kTimeout, expect.time_limit_s);
  fields.boolean("fast", expect.fast);
  if (!expect.of_run() && !expect.rate && sink.error_count() == errors_before) {
    sink.error(DiagnosticCode::kCaseExpectsNothing, node.range, "expect");
  }
  return expect;
}

}  // namespace parallax::harness
