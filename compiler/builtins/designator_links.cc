#include "compiler/builtins/designator_links.h"

#include <algorithm>

namespace parallax::compiler {

std::optional<std::size_t> DesignatorLinks::chain_of(ValueId designator) const {
  for (std::size_t i = 0; i < chains.size(); ++i) {
    if (std::find(chains[i].begin(), chains[i].end(), designator) != chains[i].end()) return i;
  }
  return std::nullopt;
}

ValueId DesignatorLinks::first(ValueId designator) const {
  const auto chain = chain_of(designator);
  return chain ? chains[*chain].front() : designator;
}

ValueId DesignatorLinks::current(ValueId designator) const {
  const auto chain = chain_of(designator);
  return chain ? chains[*chain].back() : designator;
}

bool DesignatorLinks::equate(ValueId parent, ValueId successor) {
  if (same(parent, successor)) return false;
  const auto take = [&](ValueId member) {
    const auto at = chain_of(member);
    if (!at) return std::vector{member};
    auto out = std::move(chains[*at]);
    chains.erase(chains.begin() + static_cast<std::ptrdiff_t>(*at));
    return out;
  };
  // The parent's whole chain comes before the successor in the successor's.
  const auto before = take(parent);
  auto joined = take(successor);
  joined.insert(std::find(joined.begin(), joined.end(), successor), before.begin(), before.end());
  chains.push_back(std::move(joined));
  return true;
}

ValueId DesignatorLinks::make(ValueStore& values, DesignatorKind kind, DesignatorKeys keys) {
  Value value;
  value.kind = ValueKind::kDesignator;
  value.designator = kind;
  value.keys = std::move(keys);
  if (identities) value.identity = next++;
  return values.intern(std::move(value));
}

ValueId DesignatorLinks::make_cell(ValueStore& values, std::string what, ValueId content) {
  Value value;
  value.kind = ValueKind::kCell;
  value.text = std::move(what);
  value.identity = next++;
  heap.cells.emplace_back(value.identity, content);
  return values.intern(std::move(value));
}

namespace {

/// The entry of a number, or where it would stand.
template <typename Entries>
auto entry_of(Entries& entries, std::uint32_t number) {
  return std::lower_bound(
      entries.begin(), entries.end(), number,
      [](const auto& entry, std::uint32_t wanted) { return entry.first < wanted; });
}

}  // namespace

std::optional<ValueId> PlanHeap::content(const ValueStore& values, ValueId cell) const {
  if (values.kind(cell) != ValueKind::kCell) return std::nullopt;
  const auto number = values[cell].identity;
  const auto found = entry_of(cells, number);
  if (found == cells.end() || found->first != number) return std::nullopt;
  return found->second;
}

void PlanHeap::change(const ValueStore& values, ValueId cell, ValueId content) {
  const auto number = values[cell].identity;
  const auto found = entry_of(cells, number);
  if (found != cells.end() && found->first == number) found->second = content;
}

std::optional<ValueId> PlanHeap::global(std::uint32_t number) const {
  const auto found = entry_of(globals, number);
  if (found == globals.end() || found->first != number) return std::nullopt;
  return found->second;
}

void PlanHeap::set_global(std::uint32_t number, ValueId value) {
  const auto found = entry_of(globals, number);
  if (found != globals.end() && found->first == number) {
    found->second = value;
  } else {
    globals.insert(found, {number, value});
  }
}

bool is_designator(const Value& value) {
  return value.kind == ValueKind::kDesignator || value.kind == ValueKind::kModel;
}

std::optional<DesignatorKind> designator_class(std::string_view name) {
  const auto kind = kDesignatorKindWords.find(name);
  return kind == DesignatorKind::kAllObjects ? std::nullopt : kind;
}

std::optional<bool> has_designator_type(const Value& value, std::string_view type) {
  constexpr std::string_view kEnd = "designator";
  if (type == kEnd) return is_designator(value);
  if (!type.ends_with("-designator")) return std::nullopt;
  const auto kind = designator_class(type.substr(0, type.size() - kEnd.size() - 1));
  if (!kind) return std::nullopt;
  if (value.kind == ValueKind::kModel) return *kind == DesignatorKind::kObject;
  return value.kind == ValueKind::kDesignator && value.designator == *kind;
}

ValueId property_list(ValueStore& values, ValueId designator) {
  const auto keys = values[designator].keys;
  std::vector<ValueId> out;
  for (const auto& [key, value] : keys) out.push_back(values.list({values.keyword(key), value}));
  if (values.kind(designator) == ValueKind::kModel) {
    out.push_back(values.list({values.keyword("name"), designator}));
  }
  return values.list(out);
}

std::optional<DesignatorKeys> keys_of_list(const ValueStore& values, ValueId list) {
  const auto pairs = values.elements(list);
  if (!pairs) return std::nullopt;
  DesignatorKeys out;
  for (const auto pair : *pairs) {
    const auto parts = values.elements(pair);
    const bool keyed =
        parts && parts->size() == 2 && values.kind(parts->front()) == ValueKind::kSymbol;
    if (!keyed) return std::nullopt;
    out.emplace_back(values[parts->front()].text, parts->back());
  }
  return out;
}

std::optional<ValueId> property_value(const ValueStore& values, ValueId designator,
                                      std::string_view key) {
  for (const auto& [name, value] : values[designator].keys) {
    if (name == key) return value;
  }
  if (values.kind(designator) == ValueKind::kModel && key == "name") return designator;
  return std::nullopt;
}

ValueId resolve_links(const DesignatorLinks& links, ValueStore& values, ValueId designator) {
  if (links.chains.empty()) return designator;
  // Recursion depth: the nesting of designators. A designator that is equated with a part of itself
  // is resolved once.
  const auto resolve = [&](const auto& self, ValueId id, int depth) -> ValueId {
    if (depth > 100) return id;
    auto value = values[links.current(id)];
    if (value.kind != ValueKind::kDesignator) return links.current(id);
    for (auto& [key, part] : value.keys) part = self(self, part, depth + 1);
    return values.intern(std::move(value));
  };
  return resolve(resolve, designator, 0);
}

}  // namespace parallax::compiler
