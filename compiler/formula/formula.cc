// Formulas as a graph in which equal ones are stored once (hash consing).
//
// The only connective is And, of any number of parts; an id is a node and a sign, so a negation
// costs nothing and Or is a negated And (as in and-inverter graphs). A conjunction is flattened,
// sorted and freed of repetitions and constants; with a formula and its complement it is false,
// unless the store keeps complements. It is then looked up in a table with linear probing, so
// formulas that are equal after these steps have equal ids and can be compared as numbers.
// Evaluation, rewriting and printing walk the graph on stacks of their own, so that deep
// formulas need no recursion.
//
// Cost: n log n for a conjunction of n parts. A walk is linear in the graph, but a rewritten
// part is flattened anew.

#include "compiler/formula/formula.h"

#include <algorithm>
#include <unordered_map>
#include <utility>
#include <vector>

namespace parallax::compiler {
namespace {

constexpr std::size_t kFirstTableSize = 1024;  // a power of two

std::size_t hash_children(std::span<const FormulaId> children) {
  std::uint64_t h = 0x9e3779b97f4a7c15ULL;
  for (const auto child : children) {
    h ^= child.bits();
    h *= 0xbf58476d1ce4e5b9ULL;
    h ^= h >> 29U;
  }
  return static_cast<std::size_t>(h);
}

Truth signed_value(Truth value, bool negated) {
  if (!negated || value == Truth::kUnknown) return value;
  return value == Truth::kTrue ? Truth::kFalse : Truth::kTrue;
}

}  // namespace

FormulaStore::FormulaStore() : nodes_(1), table_(kFirstTableSize, 0) {}

FormulaId FormulaStore::atom(std::int32_t variable) {
  PARALLAX_REQUIRE(variable > 0, "an atom is a SAT variable");
  const auto index = static_cast<std::size_t>(variable);
  if (atom_nodes_.size() <= index) atom_nodes_.resize(index + 1, 0);
  if (atom_nodes_[index] == 0) {
    atom_nodes_[index] = static_cast<std::uint32_t>(nodes_.size());
    nodes_.push_back({FormulaNodeKind::kAtom, variable, 0, 0});
  }
  return FormulaId(atom_nodes_[index] << 1U);
}

std::span<const FormulaId> FormulaStore::children(FormulaId id) const {
  const auto& node = nodes_[id.node()];
  return std::span(child_pool_).subspan(node.first_child, node.child_count);
}

FormulaId FormulaStore::conjunction(std::vector<FormulaId> parts) {
  std::vector<FormulaId> flat;
  flat.reserve(parts.size());
  for (const auto part : parts) {
    if (!part.negated() && kind(part) == FormulaNodeKind::kAnd && !is_kept(part)) {
      const auto inner = children(part);
      flat.insert(flat.end(), inner.begin(), inner.end());
    } else {
      flat.push_back(part);
    }
  }
  std::sort(flat.begin(), flat.end());
  flat.erase(std::unique(flat.begin(), flat.end()), flat.end());
  // The constants have the smallest ids; a formula and its complement are neighbours.
  if (!flat.empty() && flat.front() == truth()) flat.erase(flat.begin());
  if (!flat.empty() && flat.front() == falsity()) return falsity();
  for (std::size_t i = 1; i < flat.size() && !keeps_complements_; ++i) {
    if (flat[i] == ~flat[i - 1]) return falsity();
  }
  if (flat.empty()) return truth();
  if (flat.size() == 1) return flat.front();
  return intern_and(flat);
}

FormulaId FormulaStore::kept_conjunction(FormulaId a, FormulaId b) {
  if (a > b) std::swap(a, b);  // the constants come first
  if (a == falsity() || a == b) return a;
  if (a == truth()) return b;
  if (b == ~a && !keeps_complements_) return falsity();
  const auto before = nodes_.size();
  const auto made = intern_and({a, b});
  if (nodes_.size() != before) nodes_.back().kept = true;
  return made;
}

FormulaId FormulaStore::disjunction(std::vector<FormulaId> parts) {
  for (auto& part : parts) part = ~part;
  return ~conjunction(std::move(parts));
}

FormulaId FormulaStore::equivalence(FormulaId a, FormulaId b) {
  if (!keeps_complements_ && a == b) return truth();
  if (!keeps_complements_ && a == ~b) return falsity();
  return conjunction(disjunction(~a, b), disjunction(a, ~b));
}

std::size_t FormulaStore::slot_of(std::span<const FormulaId> wanted, std::size_t hash) const {
  const std::size_t mask = table_.size() - 1;
  std::size_t slot = hash & mask;
  while (table_[slot] != 0) {
    const auto& node = nodes_[table_[slot]];
    const auto have = std::span(child_pool_).subspan(node.first_child, node.child_count);
    if (std::equal(have.begin(), have.end(), wanted.begin(), wanted.end())) break;
    slot = (slot + 1) & mask;
  }
  return slot;
}

void FormulaStore::grow_table() {
  std::vector<std::uint32_t> old(table_.size() * 2, 0);
  std::swap(old, table_);
  for (const auto entry : old) {
    if (entry == 0) continue;
    const auto& node = nodes_[entry];
    const auto have = std::span(child_pool_).subspan(node.first_child, node.child_count);
    table_[slot_of(have, hash_children(have))] = entry;
  }
}

FormulaId FormulaStore::intern_and(const std::vector<FormulaId>& wanted) {
  if (2 * and_count_ >= table_.size()) grow_table();
  const auto slot = slot_of(wanted, hash_children(wanted));
  if (table_[slot] == 0) {
    table_[slot] = static_cast<std::uint32_t>(nodes_.size());
    nodes_.push_back({FormulaNodeKind::kAnd, 0, static_cast<std::uint32_t>(child_pool_.size()),
                      static_cast<std::uint32_t>(wanted.size())});
    child_pool_.insert(child_pool_.end(), wanted.begin(), wanted.end());
    ++and_count_;
  }
  return FormulaId(table_[slot] << 1U);
}

std::vector<std::int32_t> atoms_of(const FormulaStore& store, std::span<const FormulaId> formulas) {
  std::vector<std::int32_t> found;
  std::vector<bool> seen(store.node_count(), false);
  std::vector<FormulaId> todo(formulas.begin(), formulas.end());
  while (!todo.empty()) {
    const auto id = todo.back();
    todo.pop_back();
    if (seen[id.node()]) continue;
    seen[id.node()] = true;
    if (store.kind(id) == FormulaNodeKind::kAtom) {
      found.push_back(store.variable(id));
    } else if (store.kind(id) == FormulaNodeKind::kAnd) {
      const auto children = store.children(id);
      todo.insert(todo.end(), children.begin(), children.end());
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

std::vector<std::int32_t> positive_atoms(const FormulaStore& store, FormulaId root) {
  std::vector<std::int32_t> found;
  std::unordered_map<std::uint32_t, bool> seen;  // by bits
  std::vector<FormulaId> todo = {root};
  while (!todo.empty()) {
    const auto id = todo.back();
    todo.pop_back();
    if (!seen.emplace(id.bits(), true).second) continue;
    if (store.kind(id) == FormulaNodeKind::kAtom) {
      if (!id.negated()) found.push_back(store.variable(id));
    } else if (store.kind(id) == FormulaNodeKind::kAnd) {
      for (const auto child : store.children(id)) {
        todo.push_back(id.negated() ? ~child : child);
      }
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

Truth evaluate(const FormulaStore& store, FormulaId root,
               const std::function<Truth(std::int32_t)>& atom) {
  std::unordered_map<std::uint32_t, Truth> done;  // by node
  std::vector<std::uint32_t> todo = {root.node()};
  while (!todo.empty()) {
    const auto id = store.at(todo.back());
    if (done.contains(id.node())) {
      todo.pop_back();
      continue;
    }
    if (store.kind(id) == FormulaNodeKind::kTrue) done.emplace(id.node(), Truth::kTrue);
    if (store.kind(id) == FormulaNodeKind::kAtom) done.emplace(id.node(), atom(store.variable(id)));
    if (store.kind(id) != FormulaNodeKind::kAnd) continue;
    bool ready = true;
    auto value = Truth::kTrue;
    for (const auto child : store.children(id)) {
      const auto found = done.find(child.node());
      if (found == done.end()) {
        ready = false;
        todo.push_back(child.node());
        continue;
      }
      const auto part = signed_value(found->second, child.negated());
      if (part == Truth::kFalse) value = Truth::kFalse;
      if (part == Truth::kUnknown && value == Truth::kTrue) value = Truth::kUnknown;
    }
    if (ready) done.emplace(id.node(), value);
  }
  return signed_value(done.at(root.node()), root.negated());
}

FormulaId rewrite_atoms(FormulaStore& store, FormulaId root,
                        const std::function<FormulaId(std::int32_t)>& atom, RewriteMemo& memo) {
  std::vector<std::uint32_t> todo = {root.node()};
  while (!todo.empty()) {
    const auto node = todo.back();
    const auto id = store.at(node);
    if (memo.contains(node)) {
      todo.pop_back();
      continue;
    }
    if (store.kind(id) != FormulaNodeKind::kAnd) {
      const bool is_atom = store.kind(id) == FormulaNodeKind::kAtom;
      memo.emplace(node, is_atom ? atom(store.variable(id)) : id);
      todo.pop_back();
      continue;
    }
    bool ready = true;
    for (const auto child : store.children(id)) {
      if (memo.contains(child.node())) continue;
      todo.push_back(child.node());
      ready = false;
    }
    if (!ready) continue;
    std::vector<FormulaId> parts;
    for (const auto child : store.children(id)) {
      const auto part = memo.at(child.node());
      parts.push_back(child.negated() ? ~part : part);
    }
    memo.emplace(node, store.is_kept(id) ? store.kept_conjunction(parts[0], parts[1])
                                         : store.conjunction(std::move(parts)));
    todo.pop_back();
  }
  const auto result = memo.at(root.node());
  return root.negated() ? ~result : result;
}

FormulaId substitute(FormulaStore& store, FormulaId root, std::int32_t variable, bool value) {
  RewriteMemo memo;
  return rewrite_atoms(
      store, root,
      [&](std::int32_t v) { return v == variable ? store.constant(value) : store.atom(v); }, memo);
}

FormulaText::FormulaText(const FormulaStore& store,
                         std::function<std::string(std::int32_t)> atom_name)
    : store_(store), atom_name_(std::move(atom_name)) {}

void FormulaText::know_nodes() {
  uses_.resize(store_.node_count(), 0);
  numbers_.resize(store_.node_count(), 0);
}

void FormulaText::count(FormulaId formula) {
  know_nodes();
  std::vector<FormulaId> todo = {formula};
  while (!todo.empty()) {
    const auto id = todo.back();
    todo.pop_back();
    if (++uses_[id.node()] > 1 || store_.kind(id) != FormulaNodeKind::kAnd) continue;
    const auto children = store_.children(id);
    todo.insert(todo.end(), children.begin(), children.end());
  }
}

std::string FormulaText::part_name(FormulaId id) {
  auto& number = numbers_[id.node()];
  if (number == 0) {
    named_.push_back(id.negated() ? ~id : id);
    number = static_cast<std::uint32_t>(named_.size());
  }
  return (id.negated() ? "!#" : "#") + std::to_string(number);
}

std::string FormulaText::text(FormulaId formula) {
  know_nodes();
  struct Piece {
    FormulaId id;
    const char* fixed = nullptr;  // instead of a formula
  };
  std::string out;
  std::vector<Piece> todo = {{formula}};
  bool outermost = true;
  while (!todo.empty()) {
    const auto [id, fixed] = todo.back();
    todo.pop_back();
    const bool whole = std::exchange(outermost, false);
    if (fixed != nullptr) {
      out += fixed;
    } else if (store_.kind(id) == FormulaNodeKind::kTrue) {
      out += id.negated() ? "false" : "true";
    } else if (store_.kind(id) == FormulaNodeKind::kAtom) {
      out += (id.negated() ? "!" : "") + atom_name_(store_.variable(id));
    } else if (!whole && uses_[id.node()] > 1) {
      out += part_name(id);
    } else {
      const auto children = store_.children(id);
      if (!whole) todo.push_back({{}, ")"});
      for (std::size_t i = children.size(); i-- > 0;) {
        todo.push_back({id.negated() ? ~children[i] : children[i]});
        if (i > 0) todo.push_back({{}, id.negated() ? " | " : " & "});
      }
      if (!whole) todo.push_back({{}, "("});
    }
  }
  return out;
}

std::string FormulaText::definitions() {
  std::string out;
  // The list grows with the parts that the definitions name.
  for (std::size_t i = 0; i < named_.size(); ++i) {
    out += "#" + std::to_string(i + 1) + " = " + text(named_[i]) + '\n';
  }
  return out;
}

}  // namespace parallax::compiler
