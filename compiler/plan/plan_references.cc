// Objects that a plan describes without naming or detecting them.
#include <utility>

#include "compiler/plan/perform_resolver.h"

namespace parallax::compiler {
namespace {

bool is_undetected(const ValueStore& values, ValueId id) {
  const auto& value = values[id];
  return value.kind == ValueKind::kDesignator && value.designator == DesignatorKind::kObject &&
         !values.key(id, "name");
}

}  // namespace

std::optional<std::size_t> leading_key(const Value& location) {
  for (std::size_t i = 0; i < location.keys.size(); ++i) {
    if (normalise_key(location.keys[i].first) == "target") return i;
  }
  for (std::size_t i = 0; i < location.keys.size(); ++i) {
    const auto& key = location.keys[i].first;
    const bool narrows = key == "side" || key == "reachable-for" || key == "visible-for";
    if (!narrows && key != kSolutionKey) return i;
  }
  return std::nullopt;
}

std::optional<PerformResolver::Reference> PerformResolver::reference(const BindingEntry& entry,
                                                                     ValueId designator) const {
  const auto& keys = values_[designator].keys;
  for (const auto& wanted : entry.keys) {
    if (wanted.property) continue;  // of the designator itself, as `:object type ?y`
    std::size_t at = 0;
    while (at < keys.size() && normalise_key(keys[at].first) != wanted.key) ++at;
    if (at == keys.size()) continue;
    Reference out;
    out.path.emplace_back(designator, at);
    out.object = keys[at].second;
    // Every step goes into a part of a finite value.
    while (values_.kind(out.object) == ValueKind::kDesignator &&
           values_[out.object].designator == DesignatorKind::kLocation) {
      const auto next = leading_key(values_[out.object]);
      if (!next) break;
      out.path.emplace_back(out.object, *next);
      out.object = values_[out.object].keys[*next].second;
    }
    if (!is_undetected(values_, out.object)) continue;
    for (const auto& binding : binding_.objects) {
      bool fits = true;
      for (const auto& key : binding.keys) fits = fits && key_value(out.object, key.key);
      if (!fits) continue;
      out.binding = &binding;
      return out;
    }
  }
  return std::nullopt;
}

base::Result<FormulaTree> PerformResolver::candidate(const Reference& reference,
                                                     std::string_view name,
                                                     base::SourceRange source) {
  Variables variables;
  for (const auto& key : reference.binding->keys) {
    variables.emplace(key.variable, *key_value(reference.object, key.key));
  }
  variables.emplace(reference.binding->variable, values_.symbol(name));
  return fill(reference.binding->formula, variables, source);
}

}  // namespace parallax::compiler
