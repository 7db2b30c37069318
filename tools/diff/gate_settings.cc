// Rules of a gate about the settings of scenarios, beside model and plan.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <string>
#include <vector>

#include "harness/confidence/criterion.h"
#include "harness/config/scenario_settings.h"
#include "tools/diff/gate.h"

namespace parallax::tools {
namespace {

using harness::Effect;
using Demand = harness::GateRules::Demand;

std::optional<double> number_in(std::string_view text) {
  double value = 0.0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || rest != text.data() + text.size()) return std::nullopt;
  return value;
}

/// "[0, 1]", or a number as the interval of this one value.
std::optional<std::array<double, 2>> interval_in(const std::string& text) {
  if (const auto one = number_in(text)) return std::array{*one, *one};
  const auto comma = text.find(", ");
  if (!text.starts_with('[') || !text.ends_with(']') || comma == text.npos) return std::nullopt;
  const auto low = number_in(std::string_view(text).substr(1, comma - 1));
  const auto high = number_in(std::string_view(text).substr(comma + 2, text.size() - comma - 3));
  if (!low || !high) return std::nullopt;
  return std::array{*low, *high};
}

}  // namespace

bool is_about(const harness::GateRules::SettingRule& rule, const SettingChange& change) {
  const auto& effects = change.effects;
  if (rule.name == "settings") return effects != std::vector{Effect::kWords};
  if (rule.name == change.path.front() && effects != std::vector{Effect::kWords}) return true;
  return std::any_of(effects.begin(), effects.end(),
                     [&](Effect effect) { return to_string(effect) == rule.name; });
}

namespace {

/// Broken, kept, or not decidable, where the change has no direction.
RuleOutcome by_number(const SettingChange& change, bool may_grow) {
  const auto before = number_in(change.before), after = number_in(change.after);
  if (!before || !after) return RuleOutcome::kUndecided;
  return (may_grow ? *after >= *before : *after <= *before) ? RuleOutcome::kKept
                                                            : RuleOutcome::kBroken;
}

/// The runs of a criterion, where a default stands for as many as suffice if all are clean.
std::optional<std::int64_t> runs_of(const std::optional<harness::ScenarioSettings>& settings) {
  if (!settings) return std::nullopt;
  const auto number = [&](const char* key) -> std::optional<double> {
    for (const auto& setting : settings->all) {
      if (setting.path == std::vector<std::string>{"criterion", key}) {
        return number_in(setting.value);
      }
    }
    return std::nullopt;
  };
  harness::CriterionSpec spec;
  spec.kind = harness::CriterionKind::kClopperPearson;
  spec.confidence_level = number("confidence").value_or(spec.confidence_level);
  spec.epsilon = number("epsilon").value_or(spec.epsilon);
  spec.runs = static_cast<std::int64_t>(number("runs").value_or(0.0));
  if (spec.confidence_level <= 0.0 || spec.confidence_level >= 1.0 || spec.epsilon <= 0.0) {
    return std::nullopt;
  }
  return harness::planned_runs(spec);
}

/// Confidence and runs may grow, epsilon may shrink; all traces may share the error.
RuleOutcome not_weaker(const SettingChange& change, const ModelDifference& found) {
  const auto& key = change.path.back();
  if (key == "confidence") return by_number(change, true);
  if (key == "runs") {
    const auto before = runs_of(found.old_side.settings), after = runs_of(found.new_side.settings);
    if (!before || !after) return RuleOutcome::kUndecided;
    return *after >= *before ? RuleOutcome::kKept : RuleOutcome::kBroken;
  }
  if (key == "epsilon") return by_number(change, false);
  if (key == "family") {
    return change.after == "all-traces" ? RuleOutcome::kKept : RuleOutcome::kBroken;
  }
  return RuleOutcome::kUndecided;
}

bool is_axis(const std::string& key) { return harness::kRegionAxisWords.find(key).has_value(); }

/// Bounds may move inwards, and regions may go; a bound that goes opens the region.
RuleOutcome not_wider(const SettingChange& change) {
  const bool of_axis = is_axis(change.path.back());
  if (change.after.empty()) {
    if (of_axis) return RuleOutcome::kBroken;
    return change.path.size() > 2 && *(change.path.end() - 2) == "cells" ? RuleOutcome::kKept
                                                                         : RuleOutcome::kUndecided;
  }
  if (change.before.empty()) return of_axis ? RuleOutcome::kKept : RuleOutcome::kBroken;
  const auto before = interval_in(change.before), after = interval_in(change.after);
  if (!of_axis || !before || !after) return RuleOutcome::kUndecided;
  const bool is_inside = (*after)[0] >= (*before)[0] && (*after)[1] <= (*before)[1];
  return is_inside ? RuleOutcome::kKept : RuleOutcome::kBroken;
}

RuleOutcome outcome_of(Demand demand, const SettingChange& change, const ModelDifference& found) {
  switch (demand) {
    case Demand::kNotShorter:
      return by_number(change, true);
    case Demand::kNotWeaker:
      return not_weaker(change, found);
    case Demand::kNotWider:
      return not_wider(change);
    case Demand::kForbidden:
      break;
  }
  return RuleOutcome::kBroken;
}

RuleOutcome worse_of(RuleOutcome a, RuleOutcome b) {
  if (a == RuleOutcome::kBroken || b == RuleOutcome::kBroken) return RuleOutcome::kBroken;
  return a == RuleOutcome::kUndecided ? a : b;
}

}  // namespace

std::vector<std::string> changed_facts(const ModelDifference& found, bool of_world) {
  std::vector<std::string> out;
  const auto add = [&](char mark, const compiler::Fact& fact) {
    if (fact.text.starts_with(kWorldFact) == of_world)
      out.push_back(fmt::format("  {} {}\n", mark, fact.shown));
  };
  const auto &before = found.old_side.facts, &after = found.new_side.facts;
  for (const auto i : found.facts.removed) add('-', before[i]);
  for (const auto i : found.facts.added) add('+', after[i]);
  for (const auto& [i, j] : found.facts.changed) add('~', after[j]);
  return out;
}

namespace {

/// The last timepoint of a model, as it was compiled or else as its text says.
std::optional<std::int64_t> horizon_of(const ModelRevision& side, std::int64_t compiled) {
  if (side.compiled) return compiled;
  for (const auto& fact : side.facts) {
    if (fact.key != "range time") continue;
    const auto number = number_in(std::string_view(fact.text).substr(fact.text.rfind(' ') + 1));
    if (number) return static_cast<std::int64_t>(*number);
  }
  return std::nullopt;
}

/// The rule for two models that are no scenarios.
RuleResult horizon_rule(const ModelDifference& found, const harness::GateRules::SettingRule& rule) {
  RuleResult out{"models." + rule.name, RuleOutcome::kKept, "none changed"};
  const auto before = horizon_of(found.old_side, found.old_horizon);
  const auto after = horizon_of(found.new_side, found.new_horizon);
  if (before == after) return out;
  if (!before || !after) {
    out.outcome = RuleOutcome::kUndecided;
    out.words = "only one of the two says its last timepoint";
    return out;
  }
  const bool is_allowed = rule.demand == Demand::kNotShorter && *after > *before;
  out.outcome = is_allowed ? RuleOutcome::kKept : RuleOutcome::kBroken;
  out.words = fmt::format("horizon {} -> {}", *before, *after);
  return out;
}

}  // namespace

RuleResult setting_rule(const ModelDifference& found, const harness::GateRules::SettingRule& rule) {
  RuleResult out{"models." + rule.name, RuleOutcome::kKept, "none changed"};
  if (!found.settings) {
    const bool mixed = found.old_side.settings || found.new_side.settings;
    if (!mixed && rule.name == "horizon") return horizon_rule(found, rule);
    out.outcome = mixed ? RuleOutcome::kUndecided : RuleOutcome::kKept;
    out.words = mixed ? "only one of the two is a scenario" : "neither is a scenario";
    return out;
  }
  std::vector<SettingChange> changes;
  for (const auto& change : *found.settings) {
    if (!is_about(rule, change)) continue;
    out.outcome = worse_of(out.outcome, outcome_of(rule.demand, change, found));
    changes.push_back(change);
  }
  const bool of_world =
      rule.name == "physics" || rule.name == "simulator" || rule.name == "settings";
  // They change what is simulated as much as a setting does.
  const auto facts = of_world ? changed_facts(found, true) : std::vector<std::string>();
  if (!facts.empty()) {
    out.outcome =
        worse_of(out.outcome, rule.demand == Demand::kForbidden ? RuleOutcome::kBroken
                                                                : RuleOutcome::kUndecided);
    const auto count = changes.size() + facts.size();
    out.words =
        fmt::format("{} changed, {} of them in the model that is the world", count, facts.size());
    out.witness = settings_text(changes, false) + fmt::format("{}", fmt::join(facts, ""));
    return out;
  }
  if (changes.empty()) return out;
  out.words = changes.size() == 1 ? change_text(changes.front())
                                  : fmt::format("{} changed", changes.size());
  if (out.outcome == RuleOutcome::kUndecided) out.words += ", which has no order";
  out.witness = settings_text(changes, false);
  return out;
}

}  // namespace parallax::tools
