#include "compiler/formula/formula.h"

#include <algorithm>

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
    if (!part.negated() && kind(part) == FormulaNodeKind::kAnd) {
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
  for (std::size_t i = 1; i < flat.size(); ++i) {
    if (flat[i] == ~flat[i - 1]) return falsity();
  }
  if (flat.empty()) return truth();
  if (flat.size() == 1) return flat.front();
  return intern_and(flat);
}

FormulaId FormulaStore::disjunction(std::vector<FormulaId> parts) {
  for (auto& part : parts) part = ~part;
  return ~conjunction(std::move(parts));
}

FormulaId FormulaStore::equivalence(FormulaId a, FormulaId b) {
  if (a == b) return truth();
  if (a == ~b) return falsity();
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

}  // namespace parallax::compiler
