#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "compiler/base/diagnostic_codes.h"
#include "harness/config/sections.h"

namespace parallax::harness {
namespace {

using base::DiagnosticCode;

Region read_region(const YamlEntry& entry, base::DiagnosticSink& sink) {
  Region region;
  region.name = entry.key;
  region.source = entry.key_range;
  YamlFields fields(entry.value, fmt::format("the region `{}`", entry.key), sink);
  fields.only({"x", "y", "z", "yaw"});
  for (const auto axis : kAxes) {
    const auto* bounds = fields.find(to_string(axis));
    if (bounds == nullptr) continue;
    const auto name = fmt::format("`{}` of the region `{}`", to_string(axis), entry.key);
    if (!bounds->is_list()) {
      sink.error(DiagnosticCode::kWrongYamlKind, bounds->range, name, describe(*bounds),
                 "a list of a lower and an upper bound");
    } else if (const auto interval = read_interval(*bounds, name, sink)) {
      region.on(axis) = *interval;
    }
  }
  return region;
}

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
    fields.only({"flag"});
    FlagBinding flag;
    fields.text("flag", flag.variable);
    flag.variable = with_positions(flag.variable, *pattern, fields.find("flag")->range, sink);
    binding.condition = flag;
    return binding;
  }
  fields.only({"inside", "body", "unless", "only_if", "flag"});
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

std::vector<Region> read_regions(const YamlNode& node, bool& gaps_allowed,
                                 base::DiagnosticSink& sink) {
  static constexpr std::array<std::string_view, 2> kGaps = {"error", "allowed"};
  std::vector<Region> regions;
  YamlFields fields(node, "`regions`", sink);
  fields.only({"cells", "gaps"});
  gaps_allowed = fields.choice("gaps", "value of `gaps`", kGaps) == std::size_t{1};
  const auto* cells = fields.require("cells");
  if (cells == nullptr) return regions;
  const YamlFields all(*cells, "`cells`", sink);
  for (const auto& entry : cells->entries) regions.push_back(read_region(entry, sink));
  return regions;
}

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
    scenario.sampling.push_back({entry.key, *interval});
  }
  std::sort(scenario.sampling.begin(), scenario.sampling.end(),
            [](const auto& a, const auto& b) { return a.variable < b.variable; });
}

}  // namespace parallax::harness
