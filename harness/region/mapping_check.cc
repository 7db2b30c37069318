#include <fmt/core.h>

#include <set>

#include "compiler/base/diagnostic_codes.h"
#include "compiler/base/suggest.h"
#include "harness/region/state_mapping.h"

namespace parallax::harness {
namespace {

using base::DiagnosticCode;

std::vector<std::string> region_names(const RegionMap& regions) {
  std::vector<std::string> names;
  for (const auto& region : regions.regions()) names.push_back(region.name);
  return names;
}

void report_unmapped(const std::string& symbol, const std::vector<std::string>& known,
                     base::SourceRange blame, base::DiagnosticSink& sink) {
  auto report = sink.error(DiagnosticCode::kFluentNotMapped, blame, symbol);
  if (const auto near = base::nearest_name(symbol, known)) {
    report.note(fmt::format("`{}` is mapped; is that the one?", *near));
  }
}

void check_region(const FluentBinding& binding, const GroundFluent& fluent,
                  const RegionMap& regions, base::DiagnosticSink& sink) {
  const auto* inside = binding.inside();
  if (inside == nullptr) return;
  if (inside->region_argument >= fluent.arguments.size()) {
    sink.error(DiagnosticCode::kMappingArity, binding.source, binding.fluent,
               inside->region_argument + 1, fluent.text, fluent.arguments.size());
    return;
  }
  const auto& name = fluent.arguments[inside->region_argument];
  if (regions.find(name) != nullptr) return;
  auto report = sink.error(DiagnosticCode::kMappingNoRegion, binding.source, fluent.text, name);
  if (const auto near = base::nearest_name(name, region_names(regions))) {
    report.note(fmt::format("there is a region `{}`", *near));
  }
}

}  // namespace

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
      sink.error(DiagnosticCode::kMappingArity, binding->source, binding->fluent, binding->arity,
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
