#include "harness/config/gate_rules.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <initializer_list>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "compiler/base/codes/scenarios.h"
#include "compiler/base/path_gate.h"
#include "harness/config/scenario_settings.h"
#include "harness/config/sections.h"

namespace parallax::harness {
namespace {

constexpr std::array<std::string_view, 2> kPermissions = {"allowed", "forbidden"};
constexpr std::array<std::string_view, 2> kUndecided = {"fails", "passes"};

constexpr std::string_view kPhysics = to_string(Effect::kPhysics);

/// Rules with an order, by section: the word, and what it demands.
struct OrderedRule {
  std::string_view section, word;
  GateRules::Demand demand;
};
constexpr std::array<OrderedRule, 3> kOrderedRules = {
    {{Key::kHorizon, "not-shorter", GateRules::Demand::kNotShorter},
     {Key::kRegions, "not-wider", GateRules::Demand::kNotWider},
     {Key::kCriterion, "not-weaker", GateRules::Demand::kNotWeaker}}};

/// Names of rules about settings: all of them, those with one effect, those of one section. The
/// section `starts` belongs to the effect of this name.
std::vector<std::string_view> setting_rules() {
  std::vector<std::string_view> out = {Key::kSettings};
  for (const auto effect :
       {Effect::kStarts, Effect::kPhysics, Effect::kJudgement, Effect::kClaim}) {
    out.push_back(to_string(effect));
  }
  for (const auto key : kScenarioKeys) {
    const bool is_setting = key != Key::kInclude && key != Key::kName && key != Key::kModel &&
                            key != Key::kPlan && key != Key::kBind && key != Key::kConstraints &&
                            key != Key::kValidate;
    if (is_setting && std::find(out.begin(), out.end(), key) == out.end()) out.push_back(key);
  }
  return out;
}

/// Every key of `models`.
std::vector<std::string_view> model_rules() {
  auto out = setting_rules();
  out.insert(out.end(), {Key::kLostTraces, Key::kGainedTraces, Key::kDeclarations, Key::kAxioms,
                         Key::kProperties});
  return out;
}

/// A rule that is `allowed` or `forbidden`.
struct Rule {
  std::string_view key;
  bool* forbidden;
};

/// One section: what it forbids.
class RuleSection {
 public:
  /// `more`: its keys that are no such rules.
  RuleSection(const YamlNode& node, std::string_view key, std::initializer_list<Rule> rules,
              std::vector<std::string_view> more, base::DiagnosticSink& sink)
      : key_(key), fields_(node, key_text(key), sink), sink_(sink), before_(sink.error_count()) {
    auto known = std::move(more);
    for (const auto& rule : rules) known.push_back(rule.key);
    if (key != Key::kModels) fields_.belongs(Key::kModels, elsewhere_);
    fields_.only(std::span<const std::string_view>(known));
    for (const auto& rule : rules) read(rule);
  }

  YamlFields& fields() { return fields_; }

  void read(const Rule& rule) {
    const auto choice =
        fields_.choice(rule.key, fmt::format("value of `{}`", rule.key), kPermissions);
    *rule.forbidden = choice == std::size_t{1};
    forbids_ = forbids_ || *rule.forbidden;
  }
  void forbids() { forbids_ = true; }

  /// Reports a section that forbids nothing.
  void finish() const {
    if (forbids_ || sink_.error_count() != before_) return;
    sink_.error(codes::kCaseExpectsNothing, fields_.node().range, key_);
  }

 private:
  std::string_view key_;
  std::vector<std::string_view> elsewhere_ = setting_rules();
  YamlFields fields_;
  base::DiagnosticSink& sink_;
  std::size_t before_;
  bool forbids_ = false;
};

/// A limit on how much worse a rate may be.
void read_worse(const YamlFields& numbers, GateRules::Worse& out) {
  numbers.number(Key::kConfidence, {0.5, 0.999999}, out.confidence);
  numbers.number(Key::kMargin, kOpenUnit, out.margin);
}

bool asks_for_runs(const YamlFields& fields) {
  const auto* node = fields.find(kPhysics);
  return node != nullptr && (node->is_map() || (node->is_scalar() && node->text == Key::kRerun));
}

/// `physics: rerun`, or `physics: {rerun: {...}}` with its budget; none: it says something else, or
/// is wrong, which is reported.
std::optional<GateRules::Rerun> read_rerun(const YamlFields& fields, base::DiagnosticSink& sink) {
  if (!asks_for_runs(fields)) return std::nullopt;
  GateRules::Rerun out;
  const auto* node = fields.find(kPhysics);
  if (!node->is_map()) return out;
  YamlFields physics(*node, key_text(kPhysics), sink);
  physics.only({Key::kRerun});
  const auto* budget = physics.require(Key::kRerun);
  if (budget == nullptr) return std::nullopt;
  YamlFields numbers(*budget, key_text(Key::kRerun), sink);
  numbers.only({Key::kRuns, Key::kSeconds, Key::kSeed, Key::kConfidence, Key::kMargin});
  numbers.integer(Key::kRuns, 1, kMaxRuns, out.runs);
  numbers.number(Key::kSeconds, kTimeout, out.seconds);
  numbers.integer(Key::kSeed, 0, std::numeric_limits<std::int64_t>::max(), out.seed);
  read_worse(numbers, out.worse);
  return out;
}

void read_setting_rules(const YamlFields& fields, std::vector<GateRules::SettingRule>& out) {
  for (const auto name : setting_rules()) {
    if (name == kPhysics && asks_for_runs(fields)) continue;
    std::vector<std::string_view> words(kPermissions.begin(), kPermissions.end());
    if (name == kPhysics) words.push_back(Key::kRerun);
    auto demand = GateRules::Demand::kForbidden;
    for (const auto& ordered : kOrderedRules) {
      if (ordered.section != name) continue;
      words.push_back(ordered.word);
      demand = ordered.demand;
    }
    const auto choice = fields.choice(name, fmt::format("value of `{}`", name), words);
    if (choice == std::size_t{1}) out.push_back({std::string(name), {}});
    if (choice == std::size_t{2}) out.push_back({std::string(name), demand});
  }
}

GateRules::Models read_models(const YamlNode& node, base::DiagnosticSink& sink) {
  GateRules::Models out;
  auto more = setting_rules();
  more.push_back(Key::kProperties);
  RuleSection section(node, Key::kModels,
                      {{Key::kLostTraces, &out.lost_traces},
                       {Key::kGainedTraces, &out.gained_traces},
                       {Key::kDeclarations, &out.declarations},
                       {Key::kAxioms, &out.axioms}},
                      std::move(more), sink);
  read_setting_rules(section.fields(), out.settings);
  out.rerun = read_rerun(section.fields(), sink);
  if (!out.settings.empty() || out.rerun) section.forbids();
  if (const auto* list = section.fields().find(Key::kProperties)) {
    out.properties = located_texts(*list, Key::kProperties, sink);
    if (!out.properties.empty()) section.forbids();
  }
  section.finish();
  return out;
}

GateRules::Plans read_plans(const YamlNode& node, base::DiagnosticSink& sink) {
  GateRules::Plans out;
  RuleSection(node, Key::kPlans, {{Key::kForms, &out.forms}, {Key::kOrder, &out.order}}, {}, sink)
      .finish();
  return out;
}

GateRules::Traces read_traces(const YamlNode& node, base::DiagnosticSink& sink) {
  GateRules::Traces out;
  RuleSection(node, Key::kTraces, {{Key::kLost, &out.lost}, {Key::kGained, &out.gained}}, {}, sink)
      .finish();
  return out;
}

GateRules::Runs read_runs(const YamlNode& node, base::DiagnosticSink& sink) {
  GateRules::Runs out;
  RuleSection section(node, Key::kRuns,
                      {{Key::kLostTraces, &out.lost_traces},
                       {Key::kGainedDiscrepancies, &out.gained_discrepancies},
                       {Key::kWorseVerdict, &out.worse_verdict},
                       {Key::kSettings, &out.settings}},
                      {kPhysics}, sink);
  constexpr std::array<std::string_view, 2> kWords = {"allowed", Key::kRerun};
  if (!asks_for_runs(section.fields())) {
    section.fields().choice(kPhysics, "value of `physics`", kWords);
  }
  out.rerun = read_rerun(section.fields(), sink);
  if (out.rerun) section.forbids();
  section.finish();
  return out;
}

GateRules::Rates read_rates(const YamlNode& node, base::DiagnosticSink& sink) {
  GateRules::Rates out;
  RuleSection section(node, Key::kRates, {{Key::kGainedCauses, &out.gained_causes}}, {Key::kWorse},
                      sink);
  const auto* worse = section.fields().find(Key::kWorse);
  if (worse != nullptr && worse->is_map()) {
    YamlFields numbers(*worse, key_text(Key::kWorse), sink);
    numbers.only({Key::kConfidence, Key::kMargin});
    GateRules::Worse rule;
    read_worse(numbers, rule);
    out.worse = rule;
    section.forbids();
  } else {
    bool forbidden = false;
    section.read({Key::kWorse, &forbidden});
    if (forbidden) out.worse = GateRules::Worse{};
  }
  section.finish();
  return out;
}

}  // namespace

base::Result<GateRules> load_gate_rules(const std::filesystem::path& path, base::SourceFiles& files,
                                        base::DiagnosticSink& sink) {
  const auto errors_before = sink.error_count();
  base::PathGate gate(false);
  gate.admit_beside(path);
  const auto root = load_yaml(path, gate, files, sink);
  if (!root) return sink.already_reported();
  YamlFields fields(*root, "the file of rules", sink);
  const auto of_models = model_rules();
  fields.belongs(Key::kModels, of_models);
  fields.only({Key::kModels, Key::kPlans, Key::kTraces, Key::kRuns, Key::kRates, Key::kUndecided});
  GateRules out;
  out.source = root->range;
  if (const auto* node = fields.find(Key::kModels)) out.models = read_models(*node, sink);
  if (const auto* node = fields.find(Key::kPlans)) out.plans = read_plans(*node, sink);
  if (const auto* node = fields.find(Key::kTraces)) out.traces = read_traces(*node, sink);
  if (const auto* node = fields.find(Key::kRuns)) out.runs = read_runs(*node, sink);
  if (const auto* node = fields.find(Key::kRates)) out.rates = read_rates(*node, sink);
  out.undecided_passes =
      fields.choice(Key::kUndecided, "value of `undecided`", kUndecided) == std::size_t{1};
  const bool is_empty = !out.models && !out.plans && !out.traces && !out.runs && !out.rates;
  if (is_empty && sink.error_count() == errors_before) {
    sink.error(codes::kCaseExpectsNothing, root->range, path.filename().string());
  }
  if (sink.error_count() != errors_before) return sink.already_reported();
  return out;
}

}  // namespace parallax::harness
