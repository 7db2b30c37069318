#include <algorithm>

#include "compiler/reference/reference_evaluator.h"

namespace parallax::compiler {
namespace {

using Domain = std::vector<std::string>;

Domain domain_of(const TypedModel& model, SortId sort);

/// `Name(a,b)` for every combination of arguments.
Domain instances(const TypedModel& model, const Symbol& symbol) {
  Domain prefixes = {symbol.name + "("};
  for (std::size_t i = 0; i < symbol.arguments.size(); ++i) {
    Domain longer;
    for (const auto& prefix : prefixes) {
      for (const auto& value : domain_of(model, symbol.arguments[i])) {
        longer.push_back(prefix + (i > 0 ? "," : "") + value);
      }
    }
    prefixes = std::move(longer);
  }
  for (auto& text : prefixes) text += ")";
  return prefixes;
}

Domain domain_of(const TypedModel& model, SortId sort) {
  Domain domain;
  for (std::size_t i = 0; i < model.sorts.size(); ++i) {
    const auto below = model.sorts.id_at(i);
    if (below == sort || !model.is_subsort(below, sort)) continue;
    const auto inner = domain_of(model, below);
    domain.insert(domain.end(), inner.begin(), inner.end());
  }
  for (const auto object : model.sorts[sort].constants)
    domain.push_back(model.objects[object].name);
  for (const auto& range : model.sorts[sort].ranges) {
    for (auto value = range.lower; value <= range.upper; ++value) {
      domain.push_back(std::to_string(value));
    }
  }
  for (const auto& symbol : model.symbols) {
    if (symbol.result != sort || symbol.kind == SymbolKind::kFunction) continue;
    const auto terms = instances(model, symbol);
    domain.insert(domain.end(), terms.begin(), terms.end());
  }
  std::sort(domain.begin(), domain.end());
  domain.erase(std::unique(domain.begin(), domain.end()), domain.end());
  return domain;
}

}  // namespace

std::map<std::uint32_t, std::vector<std::string>> reference_domains(const TypedModel& model) {
  std::map<std::uint32_t, Domain> domains;
  for (std::size_t i = 0; i < model.sorts.size(); ++i) {
    const auto sort = model.sorts.id_at(i);
    domains[sort.index()] = domain_of(model, sort);
  }
  return domains;
}

}  // namespace parallax::compiler
