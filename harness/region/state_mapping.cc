#include "harness/region/state_mapping.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "compiler/base/codes/scenarios.h"
#include "compiler/base/contract.h"
#include "compiler/base/suggest.h"

namespace parallax::harness {
namespace {

std::vector<std::string> region_names(const RegionMap& regions) {
  std::vector<std::string> names;
  for (const auto& region : regions.regions()) names.push_back(region.name);
  return names;
}

void report_unmapped(const std::string& symbol, const std::vector<std::string>& known,
                     base::SourceRange blame, base::DiagnosticSink& sink) {
  auto report = sink.error(codes::kFluentNotMapped, blame, symbol);
  if (const auto near = base::nearest_name(symbol, known)) {
    report.note(fmt::format("`{}` is mapped; is that the one?", *near));
  }
}

void report_no_region(const FluentBinding& binding, const std::string& asks,
                      const std::string& name, const RegionMap& regions,
                      base::DiagnosticSink& sink) {
  auto report = sink.error(codes::kMappingNoRegion, binding.source, asks, name);
  if (const auto near = base::nearest_name(name, region_names(regions))) {
    report.note(fmt::format("there is a region `{}`", *near));
  }
}

void check_region(const FluentBinding& binding, const GroundFluent& fluent,
                  const RegionMap& regions, base::DiagnosticSink& sink) {
  const auto* inside = binding.inside();
  if (inside == nullptr) return;
  for (const auto& name : inside->upright_except) {
    if (regions.find(name) == nullptr)
      report_no_region(binding, fluent.symbol, name, regions, sink);
  }
  if (inside->region_argument >= fluent.arguments.size()) {
    sink.error(codes::kMappingArity, binding.source, binding.fluent, inside->region_argument + 1,
               fluent.text, fluent.arguments.size());
    return;
  }
  const auto& name = fluent.arguments[inside->region_argument];
  if (regions.find(name) == nullptr) report_no_region(binding, fluent.text, name, regions, sink);
}

}  // namespace

bool is_angle(std::string_view variable) { return variable.ends_with(".yaw"); }

StateMapping::StateMapping(RegionMap regions, std::vector<FluentBinding> bindings)
    : regions_(std::move(regions)), bindings_(std::move(bindings)) {
  std::stable_sort(
      bindings_.begin(), bindings_.end(),
      [](const FluentBinding& a, const FluentBinding& b) { return a.fluent < b.fluent; });
}

const FluentBinding* StateMapping::find(std::string_view symbol) const {
  const auto found = std::lower_bound(
      bindings_.begin(), bindings_.end(), symbol,
      [](const FluentBinding& binding, std::string_view name) { return binding.fluent < name; });
  return found == bindings_.end() || found->fluent != symbol ? nullptr : &*found;
}

std::optional<Reading> StateMapping::read(const GroundFluent& fluent, const State& state,
                                          std::set<std::string>* missing) const {
  const FluentBinding* binding = find(fluent.symbol);
  PARALLAX_REQUIRE(binding != nullptr, "the mapping was checked against the model's fluents");
  return binding->read(fluent, state, regions_, missing);
}

std::optional<bool> StateMapping::holds(const GroundFluent& fluent, const State& state,
                                        std::set<std::string>* missing) const {
  const auto result = read(fluent, state, missing);
  if (!result) return std::nullopt;
  return *result == Reading::kHolds;
}

std::string StateMapping::outside_text(const GroundFluent& fluent) const {
  const FluentBinding* binding = find(fluent.symbol);
  const auto* inside = binding == nullptr ? nullptr : binding->inside();
  if (inside == nullptr) return {};
  std::vector<std::string> arguments = fluent.arguments;
  arguments.at(inside->region_argument) = "outside";
  return fmt::format("{}({})", fluent.symbol, fmt::join(arguments, ","));
}

std::vector<std::string> StateMapping::outside(const std::vector<GroundFluent>& fluents,
                                               const State& state) const {
  // By text: is the body in some region?
  std::map<std::string, bool> found;
  for (const GroundFluent& fluent : fluents) {
    const FluentBinding* binding = find(fluent.symbol);
    if (binding == nullptr) continue;
    const auto* inside = binding->inside();
    if (inside == nullptr || !inside->flags_allow(fluent, state, nullptr)) continue;
    const std::string text = outside_text(fluent);
    const auto reading = binding->read(fluent, state, regions_, nullptr);
    found[text] = found[text] || reading == Reading::kHolds;
  }
  std::vector<std::string> bodies;
  for (const auto& [text, in_some] : found) {
    if (!in_some) bodies.push_back(text);
  }
  return bodies;
}

base::Status StateMapping::check(const std::vector<GroundFluent>& fluents, base::SourceRange blame,
                                 base::DiagnosticSink& sink) const {
  const auto errors_before = sink.error_count();
  std::vector<std::string> known;
  for (const auto& binding : bindings_) known.push_back(binding.fluent);
  std::set<std::string> faulty;  // symbols that were reported as a whole
  for (const auto& fluent : fluents) {
    if (faulty.contains(fluent.symbol)) continue;
    const FluentBinding* binding = find(fluent.symbol);
    if (binding == nullptr) {
      report_unmapped(fluent.symbol, known, blame, sink);
      faulty.insert(fluent.symbol);
    } else if (binding->arity != fluent.arguments.size()) {
      sink.error(codes::kMappingArity, binding->source, binding->fluent, binding->arity,
                 fluent.text, fluent.arguments.size());
      faulty.insert(fluent.symbol);
    } else {
      check_region(*binding, fluent, regions_, sink);
    }
  }
  if (sink.error_count() != errors_before) return sink.already_reported();
  return base::Unit{};
}

}  // namespace parallax::harness
