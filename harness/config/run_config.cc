#include <fmt/format.h>

#include <array>

#include "compiler/base/codes/scenarios.h"
#include "harness/config/sections.h"
#include "harness/engine/engine_module.h"

namespace parallax::harness {
namespace {

constexpr std::int64_t kMaxPerforms = 10'000;

/// Those of kCriterionWords, then readings of the paper's.
constexpr std::array<std::string_view, 6> kKinds = {
    "clean-runs", "paper", "anytime", "clopper-pearson", "paper-literal", "paper-repaired"};
constexpr std::array<std::string_view, 2> kPresets = {"paper-literal", "paper-repaired"};

/// A preset, and single readings laid over it; the report then calls the result "custom".
void read_paper_rule(const YamlFields& fields, PaperRuleSpec& rule) {
  const auto preset = fields.choice(Key::kPreset, Key::kPreset, kPresets);
  if (preset) rule = *preset == 1 ? paper_repaired() : paper_literal();
  bool changed = fields.word(Key::kSigma, kSigmaWords, rule.sigma);
  changed = fields.word(Key::kRoot, kRootWords, rule.root) || changed;
  changed = fields.word(Key::kIntercept, kInterceptWords, rule.intercept) || changed;
  changed = fields.word(Key::kInterval, kIntervalWords, rule.interval) || changed;
  changed = changed || fields.find(Key::kExtraRuns) != nullptr ||
            fields.find(Key::kExemptInherited) != nullptr ||
            fields.find(Key::kToleranceM) != nullptr || fields.find(Key::kBonferroni) != nullptr;
  fields.integer(Key::kExtraRuns, 0, kMaxRuns, rule.extra_runs);
  fields.boolean(Key::kExemptInherited, rule.exempt_inherited);
  fields.number(Key::kToleranceM, kNotNegative, rule.tolerance_m);
  fields.boolean(Key::kBonferroni, rule.bonferroni);
  if (changed) rule.preset = "custom, from " + rule.preset;
}

}  // namespace

std::optional<Comparison> read_comparison(const YamlFields& fields) {
  // Without it other keys say how it is compared, so it has no default of its own.
  const auto choice =
      fields.choice(Key::kCompare, "value of " + key_text(Key::kCompare), kComparisons);
  if (!choice) return std::nullopt;
  return static_cast<Comparison>(*choice);
}

std::vector<StartWeight> read_start_weights(const YamlNode& node, base::DiagnosticSink& sink) {
  // Sums of weights stay finite.
  constexpr NumberBounds kWeight{0.0, 1e12, false, false};
  std::vector<StartWeight> out;
  const auto add = [&](const YamlNode& entry) {
    YamlFields fields(entry, "an entry of " + key_text(Key::kStartWeights), sink);
    fields.only({Key::kWhen, Key::kWeight});
    StartWeight weight;
    const auto* when = fields.require(Key::kWhen);
    const bool has_weight = fields.require(Key::kWeight) != nullptr;
    fields.number(Key::kWeight, kWeight, weight.weight);
    if (when == nullptr || !has_weight) return;
    auto text = read_text(*when, Key::kWhen, sink);
    if (!text) return;
    weight.when = {*std::move(text), when->range};
    out.push_back(std::move(weight));
  };
  if (node.is_list()) {
    for (const auto& entry : node.items) add(entry);
  } else {
    add(node);
  }
  return out;
}

SearchSpec read_search(const YamlNode& node, base::DiagnosticSink& sink) {
  SearchSpec search;
  // A number alone means that number of runs of the default strategy.
  const YamlNode map = with_key(node, Key::kRuns);
  YamlFields fields(map, key_text(Key::kSearch), sink);
  fields.only({Key::kRuns, Key::kStrategy});
  if (fields.require(Key::kRuns) == nullptr) return search;
  fields.integer(Key::kRuns, 0, kMaxSearchRuns, search.runs);
  fields.word(Key::kStrategy, kSearchStrategies, search.strategy);
  return search;
}

CriterionSpec read_criterion(const YamlNode& node, base::DiagnosticSink& sink) {
  CriterionSpec criterion;
  criterion.paper = paper_literal();
  // A word alone stands for a criterion with its defaults.
  const YamlNode map = with_key(node, Key::kKind);
  YamlFields fields(map, key_text(Key::kCriterion), sink);
  fields.may_be_absent();
  if (const auto kind = fields.choice(Key::kKind, Key::kCriterion, kKinds,
                                      static_cast<std::size_t>(criterion.kind))) {
    const bool reading = *kind >= kCriterionWords.size();
    criterion.kind = reading ? CriterionKind::kPaper : static_cast<CriterionKind>(*kind);
    if (kKinds[*kind] == "paper-repaired") criterion.paper = paper_repaired();
  }
  std::vector<std::string_view> keys = {
      Key::kKind,       Key::kConfidence, Key::kEpsilon,  Key::kPreset,    Key::kSigma,
      Key::kRoot,       Key::kIntercept,  Key::kInterval, Key::kExtraRuns, Key::kExemptInherited,
      Key::kToleranceM, Key::kBonferroni, Key::kFamily};
  if (criterion.kind == CriterionKind::kClopperPearson) {
    keys.push_back(Key::kRuns);
    fields.integer(Key::kRuns, 1, kMaxRuns, criterion.runs);
  }
  fields.only(std::span<const std::string_view>(keys));
  fields.number(Key::kConfidence, kOpenUnit, criterion.confidence_level);
  fields.number(Key::kEpsilon, kOpenUnit, criterion.epsilon);
  fields.word(Key::kFamily, kFamilyWords, criterion.family);
  read_paper_rule(fields, criterion.paper);
  return criterion;
}

namespace {

/// Reads the time and memory limits of a simulator in a process of its own.
void read_process_limits(YamlFields& fields, SimulatorSpec& simulator) {
  fields.number(Key::kHelloTimeoutS, kTimeout, simulator.hello_timeout_s);
  fields.number(Key::kResetTimeoutS, kTimeout, simulator.reset_timeout_s);
  fields.number(Key::kActTimeoutS, kTimeout, simulator.act_timeout_s);
  fields.number(Key::kObserveTimeoutS, kTimeout, simulator.observe_timeout_s);
  fields.number(Key::kCloseTimeoutS, kTimeout, simulator.close_timeout_s);
  fields.number(Key::kMinRealTimeFactor, kPositive, simulator.min_real_time_factor);
  fields.integer(Key::kRecycleAfter, 0, kMaxRuns, simulator.recycle_after);
  fields.integer(Key::kMemoryMb, 0, 10'000'000, simulator.memory_mb);
}

/// Reads the engine's name; reports an unknown name, or an engine that this program is built
/// without.
void read_engine(const YamlNode& node, std::string_view key, const char* known_as,
                 SimulatorSpec& simulator, base::DiagnosticSink& sink) {
  if (const auto kind = kEngineWords.find(node.text)) {
    simulator.engine = *kind;
    const std::string why = why_no_engine(*kind);
    if (!why.empty()) sink.error(codes::kEngineUnavailable, node.range, node.text, why);
    return;
  }
  auto error = sink.error(codes::kYamlUnknownChoice, node.range, node.text, key);
  const std::vector<std::string> known(kEngineWords.begin(), kEngineWords.end());
  add_suggestion(error, node.text, known, known_as);
}

}  // namespace

SimulatorSpec read_simulator(const YamlNode& node, base::DiagnosticSink& sink) {
  SimulatorSpec simulator;
  simulator.source = node.range;
  if (node.is_scalar()) {
    ReadLog::stands_for(node, Key::kEngine);
    ReadLog::fallback(node, Key::kEngine, std::string(to_string(simulator.engine)));
    read_engine(node, Key::kSimulator, "known, besides `command: [...]` and `model: FILE`",
                simulator, sink);
    return simulator;
  }
  YamlFields fields(node, key_text(Key::kSimulator), sink);
  if (const auto* model = fields.find(Key::kModel)) {
    fields.only({Key::kModel});
    simulator.models = located_texts(*model, Key::kModel, sink);
    return simulator;
  }
  if (const auto* engine = fields.find(Key::kEngine)) {
    ReadLog::fallback(node, Key::kEngine, std::string(to_string(simulator.engine)));
    fields.only({Key::kEngine, Key::kHelloTimeoutS, Key::kResetTimeoutS, Key::kActTimeoutS,
                 Key::kObserveTimeoutS, Key::kCloseTimeoutS, Key::kMinRealTimeFactor,
                 Key::kRecycleAfter, Key::kMemoryMb});
    std::optional<std::string> name;
    fields.text(Key::kEngine, name);  // reports what is no text
    fields.may_be_absent();
    if (engine->is_scalar()) read_engine(*engine, Key::kEngine, "known", simulator, sink);
    read_process_limits(fields, simulator);
    return simulator;
  }
  fields.only({Key::kCommand, Key::kModel, Key::kEngine, Key::kHelloTimeoutS, Key::kResetTimeoutS,
               Key::kActTimeoutS, Key::kObserveTimeoutS, Key::kCloseTimeoutS,
               Key::kMinRealTimeFactor, Key::kRecycleAfter, Key::kMemoryMb});
  fields.texts(Key::kCommand, simulator.command);
  const auto* command = fields.find(Key::kCommand);
  if (command != nullptr && command->is_list() && command->items.empty()) {
    sink.error(codes::kWrongYamlKind, command->range, key_text(Key::kCommand), "empty",
               "a list of a program and its arguments");
  }
  read_process_limits(fields, simulator);
  return simulator;
}

Limits read_limits(const YamlNode& node, base::DiagnosticSink& sink) {
  Limits limits;
  YamlFields fields(node, key_text(Key::kLimits), sink);
  fields.may_be_absent();
  fields.only({Key::kMaxRuns, Key::kMaxTraces, Key::kMaxRejectedStarts, Key::kMaxLostInARow,
               Key::kMaxPerforms, Key::kMaxSimulatedS});
  fields.integer(Key::kMaxRuns, 0, kMaxRuns, limits.max_runs);
  if (const auto* max_runs = fields.find(Key::kMaxRuns)) limits.max_runs_source = max_runs->range;
  fields.integer(Key::kMaxTraces, 0, kMaxRuns, limits.max_traces);
  fields.integer(Key::kMaxRejectedStarts, 1, kMaxRuns, limits.max_rejected_starts);
  fields.integer(Key::kMaxLostInARow, 1, kMaxRuns, limits.max_lost_in_a_row);
  fields.integer(Key::kMaxPerforms, 0, kMaxPerforms, limits.max_performs);
  fields.number(Key::kMaxSimulatedS, kPositive, limits.max_simulated_s);
  return limits;
}

}  // namespace parallax::harness
