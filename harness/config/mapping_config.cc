#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "compiler/base/diagnostic_codes.h"
#include "harness/config/sections.h"
#include "harness/world/structure_check.h"

namespace parallax::harness {
namespace {

using base::DiagnosticCode;

void read_flag_name(const YamlFields& fields, std::string_view key, const SymbolPattern& pattern,
                    std::optional<std::string>& out) {
  fields.text(key, out);
  if (out) out = with_positions(*out, pattern, fields.find(key)->range, fields.sink());
}

InsideBinding read_inside(const YamlFields& fields, const SymbolPattern& pattern) {
  InsideBinding binding;
  auto& sink = fields.sink();
  std::string parameter;
  fields.text(Key::kInside, parameter);
  const auto& names = pattern.parameters;
  const auto found = std::find(names.begin(), names.end(), parameter);
  if (found != names.end()) {
    binding.region_argument = static_cast<std::size_t>(found - names.begin());
  } else if (!parameter.empty()) {
    auto error = sink.error(DiagnosticCode::kUnknownPatternParameter,
                            fields.find(Key::kInside)->range, parameter, pattern.symbol);
    add_suggestion(error, parameter, names, "parameters");
  }
  if (const auto* body = fields.require(Key::kBody)) {
    fields.text(Key::kBody, binding.body);
    binding.body = with_positions(binding.body, pattern, body->range, sink);
  }
  read_flag_name(fields, Key::kUnless, pattern, binding.unless);
  read_flag_name(fields, Key::kOnlyIf, pattern, binding.only_if);
  fields.boolean(Key::kDrawn, binding.drawn);
  return binding;
}

/// The text under `key`, with the names of parameters replaced by their positions.
std::string read_pattern_text(const YamlFields& fields, std::string_view key,
                              const SymbolPattern& pattern) {
  std::string text;
  fields.text(key, text);
  const auto* node = fields.find(key);
  return node == nullptr ? text : with_positions(text, pattern, node->range, fields.sink());
}

FlagBinding read_flag(YamlFields& fields, const SymbolPattern& pattern) {
  fields.only({Key::kFlag, Key::kAtStart});
  FlagBinding binding;
  binding.variable = read_pattern_text(fields, Key::kFlag, pattern);
  fields.boolean(Key::kAtStart, binding.at_start);
  return binding;
}

RangeBinding read_range(YamlFields& fields, const SymbolPattern& pattern) {
  fields.only({Key::kRange, Key::kHolds, Key::kFails, Key::kAtStart});
  RangeBinding binding;
  binding.variable = read_pattern_text(fields, Key::kRange, pattern);
  for (const auto& [key, interval] :
       {std::pair{Key::kHolds, &binding.holds}, std::pair{Key::kFails, &binding.fails}}) {
    const auto* node = fields.require(key);
    if (node == nullptr) continue;
    if (const auto read = read_interval(*node, fmt::format("`{}`", key), fields.sink())) {
      *interval = *read;
    }
    if (interval->lower > interval->upper) {
      fields.sink().error(DiagnosticCode::kReversedSampling, node->range, fmt::format("`{}`", key),
                          interval->lower, interval->upper);
    }
  }
  if (binding.holds.lower <= binding.fails.upper && binding.fails.lower <= binding.holds.upper &&
      fields.find(Key::kFails) != nullptr) {
    fields.sink().error(DiagnosticCode::kYamlOutOfBounds, fields.find(Key::kFails)->range,
                        key_text(Key::kFails), "an interval that meets " + key_text(Key::kHolds),
                        "apart from it");
  }
  fields.number(Key::kAtStart, kAnyNumber, binding.at_start);
  return binding;
}

EqualsBinding read_equals(YamlFields& fields, const SymbolPattern& pattern) {
  fields.only({Key::kEquals, Key::kText});
  EqualsBinding binding;
  binding.variable = read_pattern_text(fields, Key::kEquals, pattern);
  fields.require(Key::kText);
  binding.text = read_pattern_text(fields, Key::kText, pattern);
  return binding;
}

std::optional<FluentBinding> read_binding(const YamlEntry& entry, base::DiagnosticSink& sink) {
  const auto pattern = parse_pattern(entry.key);
  if (!pattern) {
    sink.error(DiagnosticCode::kBadPattern, entry.key_range, entry.key);
    return std::nullopt;
  }
  FluentBinding binding;
  binding.fluent = pattern->symbol;
  binding.arity = pattern->parameters.size();
  binding.source = entry.key_range;
  const auto& value = entry.value;
  if (value.is_scalar() && value.text == "ignored") {
    binding.condition = IgnoredBinding{};
    return binding;
  }
  YamlFields fields(value, fmt::format("the mapping of `{}`", pattern->symbol), sink);
  if (!value.is_map()) return std::nullopt;
  if (fields.find(Key::kFlag) != nullptr) {
    binding.condition = read_flag(fields, *pattern);
    return binding;
  }
  if (fields.find(Key::kRange) != nullptr) {
    binding.condition = read_range(fields, *pattern);
    return binding;
  }
  if (fields.find(Key::kEquals) != nullptr) {
    binding.condition = read_equals(fields, *pattern);
    return binding;
  }
  fields.only({Key::kInside, Key::kBody, Key::kUnless, Key::kOnlyIf, Key::kDrawn, Key::kFlag,
               Key::kRange, Key::kEquals});
  if (fields.require(Key::kInside) == nullptr) return std::nullopt;
  binding.condition = read_inside(fields, *pattern);
  return binding;
}

/// A symbol may have one entry only, whatever its parameters are called.
template <typename Bindings, typename Name>
void refuse_repeated(Bindings& bindings, Name name, base::DiagnosticSink& sink) {
  std::map<std::string, base::SourceRange> seen;
  for (const auto& binding : bindings) {
    const auto [at, fresh] = seen.emplace(name(binding), binding.source);
    if (fresh) continue;
    sink.error(DiagnosticCode::kDuplicateKey, binding.source, at->first)
        .note(at->second, "first given here");
  }
}

}  // namespace

std::vector<FluentBinding> read_mapping(const YamlNode& node, base::DiagnosticSink& sink) {
  std::vector<FluentBinding> bindings;
  const YamlFields all(node, key_text(Key::kMapping), sink);
  for (const auto& entry : node.entries) {
    if (auto binding = read_binding(entry, sink)) bindings.push_back(std::move(*binding));
  }
  refuse_repeated(
      bindings, [](const FluentBinding& b) { return b.fluent; }, sink);
  return bindings;
}

void read_sampling(const YamlNode& node, Scenario& scenario, base::DiagnosticSink& sink) {
  YamlFields fields(node, key_text(Key::kSampling), sink);
  fields.only({Key::kInsetM, Key::kVariables});
  fields.number(Key::kInsetM, kNotNegative, scenario.sampling_inset_m);
  const auto* variables = fields.find(Key::kVariables);
  if (variables == nullptr) return;
  const YamlFields all(*variables, key_text(Key::kVariables), sink);
  for (const auto& entry : variables->entries) {
    const auto name = fmt::format("`{}`", entry.key);
    const auto interval = read_interval(entry.value, name, sink);
    if (!interval) continue;
    if (interval->lower > interval->upper) {
      sink.error(DiagnosticCode::kReversedSampling, entry.key_range, name, interval->lower,
                 interval->upper);
    }
    const bool built_in = scenario.simulator.command.empty();
    if (built_in && entry.key.ends_with(".mass") &&
        !(interval->lower > 0.0 && interval->upper <= kMaxMass_kg)) {
      sink.error(DiagnosticCode::kYamlOutOfBounds, entry.value.range, name,
                 fmt::format("from {} to {} kg", interval->lower, interval->upper),
                 fmt::format("above 0 and at most {:g} kg", kMaxMass_kg));
    }
    scenario.sampling.push_back({entry.key, *interval});
  }
  std::sort(scenario.sampling.begin(), scenario.sampling.end(),
            [](const auto& a, const auto& b) { return a.variable < b.variable; });
}

}  // namespace parallax::harness
