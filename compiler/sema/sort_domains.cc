#include "compiler/sema/sort_domains.h"

#include <algorithm>

namespace parallax::compiler {

SortDomains::SortDomains(const TypedModel& model)
    : model_(model), children_(model.sorts.size()), has_constructor_(model.sorts.size()) {
  for (std::size_t i = 0; i < model.sorts.size(); ++i) {
    const auto sort = model.sorts.id_at(i);
    for (const auto parent : model.sorts[sort].parents) children_[parent.index()].push_back(sort);
  }
  for (const auto& symbol : model.symbols) {
    if (symbol.kind == SymbolKind::kFunction || !symbol.result) continue;
    has_constructor_[symbol.result->index()] = true;
  }
}

bool SortDomains::overlap(SortId a, SortId b) {
  if (a == b) return true;
  const auto key = (std::uint64_t{std::min(a, b).index()} << 32U) | std::max(a, b).index();
  const auto found = overlaps_.find(key);
  if (found != overlaps_.end()) return found->second;
  return overlaps_[key] = model_.sorts_overlap(a, b);
}

std::vector<SortId> SortDomains::below(SortId sort) const {
  std::vector<SortId> found = {sort};
  std::vector<bool> seen(children_.size());
  seen[sort.index()] = true;
  for (std::size_t i = 0; i < found.size(); ++i) {
    for (const auto child : children_[found[i].index()]) {
      if (seen[child.index()]) continue;
      seen[child.index()] = true;
      found.push_back(child);
    }
  }
  return found;
}

const std::vector<Sort::Range>& SortDomains::ranges(SortId sort) {
  const auto found = ranges_.find(sort.index());
  if (found != ranges_.end()) return found->second;
  auto& all = ranges_[sort.index()];
  for (const auto part : below(sort)) {
    const auto& own = model_.sorts[part].ranges;
    all.insert(all.end(), own.begin(), own.end());
  }
  return all;
}

bool SortDomains::contains(SortId sort, std::int64_t value) {
  const auto& all = ranges(sort);
  return std::any_of(all.begin(), all.end(), [value](const Sort::Range& range) {
    return range.lower <= value && value <= range.upper;
  });
}

bool SortDomains::has_elements(SortId sort) {
  const auto found = has_elements_.find(sort.index());
  if (found != has_elements_.end()) return found->second;
  bool any = false;
  for (const auto part : below(sort)) {
    const auto& own = model_.sorts[part];
    any = any || !own.constants.empty() || !own.ranges.empty() || has_constructor_[part.index()];
  }
  return has_elements_[sort.index()] = any;
}

}  // namespace parallax::compiler
