#include "compiler/ground/old_clauses.h"

#include <algorithm>
#include <unordered_map>
#include <utility>

namespace parallax::compiler {
namespace {

using Clauses = std::vector<std::vector<FormulaId>>;

/// The formula's parts with their signs as they stand after pushing negations inside, children
/// before parents.
std::vector<FormulaId> signed_parts(const FormulaStore& store, FormulaId root) {
  std::vector<FormulaId> order;
  std::unordered_map<std::uint32_t, bool> done;  // by bits; false: children are being visited
  std::vector<FormulaId> todo = {root};
  while (!todo.empty()) {
    const auto id = todo.back();
    const auto [entry, is_new] = done.emplace(id.bits(), false);
    if (!is_new) {
      todo.pop_back();
      if (!std::exchange(entry->second, true)) order.push_back(id);
      continue;
    }
    if (store.kind(id) != FormulaNodeKind::kAnd) continue;
    for (const auto child : store.children(id)) todo.push_back(id.negated() ? ~child : child);
  }
  return order;
}

std::vector<FormulaId> signed_children(const FormulaStore& store, FormulaId id) {
  std::vector<FormulaId> children;
  for (const auto child : store.children(id)) children.push_back(id.negated() ? ~child : child);
  return children;
}

/// Clauses after distribution, and what naming adds for the part and everything in it.
struct Size {
  double distributed = 1.0;
  double named = 0.0;
};

Clauses product(const Clauses& left, const Clauses& right) {
  Clauses all;
  for (const auto& a : left) {
    for (const auto& b : right) {
      auto clause = a;
      clause.insert(clause.end(), b.begin(), b.end());
      std::sort(clause.begin(), clause.end());
      clause.erase(std::unique(clause.begin(), clause.end()), clause.end());
      all.push_back(std::move(clause));
    }
  }
  return all;
}

}  // namespace

OldClauseForm old_clause_form(const FormulaStore& store, FormulaId root) {
  const auto order = signed_parts(store, root);
  std::unordered_map<std::uint32_t, Size> sizes;  // by bits
  for (const auto id : order) {
    Size size;
    if (store.kind(id) == FormulaNodeKind::kAnd) {
      const auto children = signed_children(store, id);
      size.distributed = id.negated() ? 1.0 : 0.0;
      size.named = 1.0 + static_cast<double>(children.size());
      for (const auto child : children) {
        const auto& part = sizes.at(child.bits());
        size.distributed = id.negated() ? size.distributed * part.distributed
                                        : size.distributed + part.distributed;
        size.named += part.named;
      }
    }
    sizes.emplace(id.bits(), size);
  }
  OldClauseForm form;
  const auto& whole = sizes.at(root.bits());
  form.named = whole.distributed > 1.0 + whole.named;
  if (form.named) return form;

  // No part has more clauses than the whole.
  std::unordered_map<std::uint32_t, Clauses> made;  // by bits
  for (const auto id : order) {
    Clauses clauses;
    if (store.kind(id) != FormulaNodeKind::kAnd) {
      clauses = {{id}};
    } else if (id.negated()) {
      clauses = {{}};
      for (const auto child : signed_children(store, id)) {
        clauses = product(clauses, made.at(child.bits()));
      }
    } else {
      for (const auto child : signed_children(store, id)) {
        const auto& part = made.at(child.bits());
        clauses.insert(clauses.end(), part.begin(), part.end());
      }
    }
    made.emplace(id.bits(), std::move(clauses));
  }
  form.clauses = std::move(made.at(root.bits()));
  return form;
}

}  // namespace parallax::compiler
