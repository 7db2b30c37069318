#include "compiler/sema/typed_model.h"

#include <algorithm>
#include <unordered_set>

namespace parallax::compiler {
namespace {

template <typename IdType, typename T>
std::optional<IdType> find_in(const base::Store<IdType, T>& store, const NameIndex& index,
                              std::string_view name) {
  if (index.size() == store.size()) {
    const auto found = index.find(name, [&](std::uint32_t position) {
      return std::string_view(store[IdType(position)].name);
    });
    if (!found) return std::nullopt;
    return IdType(*found);
  }
  for (std::size_t i = 0; i < store.size(); ++i) {
    if (store[store.id_at(i)].name == name) return store.id_at(i);
  }
  return std::nullopt;
}

/// `sort` and everything above it, each once.
std::vector<SortId> ancestors(const TypedModel& model, SortId sort) {
  std::vector<SortId> found = {sort};
  std::unordered_set<std::uint32_t> seen = {sort.index()};
  for (std::size_t i = 0; i < found.size(); ++i) {
    for (const auto parent : model.sorts[found[i]].parents) {
      if (seen.insert(parent.index()).second) found.push_back(parent);
    }
  }
  return found;
}

}  // namespace

CompareOp mirrored(CompareOp op) {
  switch (op) {
    case CompareOp::kEqual:
    case CompareOp::kNotEqual:
      return op;
    case CompareOp::kLess:
      return CompareOp::kGreater;
    case CompareOp::kLessEqual:
      return CompareOp::kGreaterEqual;
    case CompareOp::kGreater:
      return CompareOp::kLess;
    case CompareOp::kGreaterEqual:
      return CompareOp::kLessEqual;
  }
  return op;
}

bool compares(std::int64_t left, CompareOp op, std::int64_t right) {
  switch (op) {
    case CompareOp::kEqual:
      return left == right;
    case CompareOp::kNotEqual:
      return left != right;
    case CompareOp::kLess:
      return left < right;
    case CompareOp::kLessEqual:
      return left <= right;
    case CompareOp::kGreater:
      return left > right;
    case CompareOp::kGreaterEqual:
      return left >= right;
  }
  return false;
}

std::optional<SortId> TypedModel::find_sort(std::string_view name) const {
  return find_in(sorts, sort_index, name);
}

std::optional<ObjectId> TypedModel::find_object(std::string_view name) const {
  return find_in(objects, object_index, name);
}

std::optional<SymbolId> TypedModel::find_symbol(std::string_view name) const {
  return find_in(symbols, symbol_index, name);
}

bool TypedModel::is_subsort(SortId sort, SortId ancestor) const {
  // Nearly every chain is short and has one parent a level: no set is needed then.
  for (int level = 0; level < 16; ++level) {
    if (sort == ancestor) return true;
    const auto& parents = sorts[sort].parents;
    if (parents.empty()) return false;
    if (parents.size() > 1) break;
    sort = parents.front();
  }
  const auto above = ancestors(*this, sort);
  return std::find(above.begin(), above.end(), ancestor) != above.end();
}

bool TypedModel::sorts_overlap(SortId a, SortId b) const {
  if (is_subsort(a, b) || is_subsort(b, a)) return true;
  if (sorts[a].integer && sorts[b].integer) return true;
  // Two sorts side by side share elements only through a sort with two parents ...
  for (std::size_t i = 0; i < sorts.size(); ++i) {
    const auto sort = sorts.id_at(i);
    if (sorts[sort].parents.size() > 1 && is_subsort(sort, a) && is_subsort(sort, b)) return true;
  }
  // ... or through a constant with two sorts.
  for (const auto& object : objects) {
    if (object.sorts.size() < 2) continue;
    const auto below = [&](SortId ancestor) {
      return std::any_of(object.sorts.begin(), object.sorts.end(),
                         [&](SortId sort) { return is_subsort(sort, ancestor); });
    };
    if (below(a) && below(b)) return true;
  }
  return false;
}

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
