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
  fields.text("inside", parameter);
  const auto& names = pattern.parameters;
  const auto found = std::find(names.begin(), names.end(), parameter);
  if (found != names.end()) {
    binding.region_argument = static_cast<std::size_t>(found - names.begin());
  } else if (!parameter.empty()) {
    auto error = sink.error(DiagnosticCode::kUnknownPatternParameter, fields.find("inside")->range,
                            parameter, pattern.symbol);
    add_suggestion(error, parameter, names, "parameters");
  }
  if (const auto* body = fields.require("body")) {
    fields.text("body", binding.body);
    binding.body = with_positions(binding.body, pattern, body->range, sink);
  }
  read_flag_name(fields, "unless", pattern, binding.unless);
  read_flag_name(fields, "only_if", pattern, binding.only_if);
  fields.boolean("drawn", binding.drawn);
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
  fields.only({"flag", "at_start"});
  FlagBinding binding;
  binding.variable = read_pattern_text(fields, "flag", pattern);
  fields.boolean("at_start", binding.at_start);
  return binding;
}

RangeBinding read_range(YamlFields& fields, const SymbolPattern& pattern) {
  fields.only({"range", "holds", "fails", "at_start"});
  RangeBinding binding;
  binding.variable = read_pattern_text(fields, "range", pattern);
  for (const auto& [key, interval] :
       {std::pair{"holds", &binding.holds}, std::pair{"fails", &binding.fails}}) {
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
      fields.find("fails") != nullptr) {
    fields.sink().error(DiagnosticCode::kYamlOutOfBounds, fields.find("fails")->range, "`fails`",
                        "an interval that meets `holds`", "apart from it");
  }
  fields.number("at_start", kAnyNumber, binding.at_start);
  return binding;
}

EqualsBinding read_equals(YamlFields& fields, const SymbolPattern& pattern) {
  fields.only({"equals", "text"});
  EqualsBinding binding;
  binding.variable = read_pattern_text(fields, "equals", pattern);
  fields.require("text");
  binding.text = read_pattern_text(fields, "text", pattern);
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
  if (fields.find("flag") != nullptr) {
    binding.condition = read_flag(fields, *pattern);
    return binding;
  }
  if (fields.find("range") != nullptr) {
    binding.condition = read_range(fields, *pattern);
    return binding;
  }
  if (fields.find("equals") != nullptr) {
    binding.condition = read_equals(fields, *pattern);
    return binding;
  }
  fields.only({"inside", "body", "unless", "only_if", "drawn", "flag", "range", "equals"});
  if (fields.require("inside") == nullptr) return std::nullopt;
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
  const YamlFields all(node, "`mapping`", sink);
  for (const auto& entry : node.entries) {
    if (auto binding = read_binding(entry, sink)) bindings.push_back(std::move(*binding));
  }
  refuse_repeated(
      bindings, [](const FluentBinding& b) { return b.fluent; }, sink);
  return bindings;
}

void read_sampling(const YamlNode& node, Scenario& scenario, base::DiagnosticSink& sink) {
  YamlFields fields(node, "`sampling`", sink);
  fields.only({"inset_m", "variables"});
  fields.number("inset_m", kNotNegative, scenario.sampling_inset_m);
  const auto* variables = fields.find("variables");
  if (variables == nullptr) return;
  const YamlFields all(*variables, "`variables`", sink);
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
