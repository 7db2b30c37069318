#include "compiler/ground/ground_term.h"

#include <algorithm>
#include <vector>

namespace parallax::compiler {

namespace {

constexpr std::size_t kFirstTableSize = 256;  // a power of two

std::size_t hash_of(const GroundTerm& term, std::span<const GroundTermId> arguments) {
  auto h = static_cast<std::uint64_t>(term.integer) ^ (std::uint64_t{term.object.index()} << 20U) ^
           (std::uint64_t{term.symbol.index()} << 40U) ^ static_cast<std::uint64_t>(term.kind);
  const auto mix = [&](std::uint64_t value) {
    h ^= value;
    h *= 0xbf58476d1ce4e5b9ULL;
    h ^= h >> 29U;
  };
  mix(0x9e3779b97f4a7c15ULL);
  for (const auto argument : arguments) mix(argument.index());
  return static_cast<std::size_t>(h);
}

}  // namespace

GroundTermStore::GroundTermStore() : table_(kFirstTableSize, 0) {}

bool GroundTermStore::equal(const GroundTerm& a, const GroundTerm& b,
                            std::span<const GroundTermId> arguments) const {
  const auto mine = std::span(pool_).subspan(a.first_argument, a.argument_count);
  return a.kind == b.kind && a.integer == b.integer && a.object == b.object &&
         a.symbol == b.symbol &&
         std::equal(mine.begin(), mine.end(), arguments.begin(), arguments.end());
}

void GroundTermStore::grow() {
  std::vector<std::uint32_t> larger(table_.size() * 2, 0);
  const std::size_t mask = larger.size() - 1;
  for (std::uint32_t i = 0; i < terms_.size(); ++i) {
    auto slot = hash_of(terms_[i], arguments(GroundTermId(i))) & mask;
    while (larger[slot] != 0) slot = (slot + 1) & mask;
    larger[slot] = i + 1;
  }
  table_ = std::move(larger);
}

GroundTermId GroundTermStore::intern(const GroundTerm& term,
                                     std::span<const GroundTermId> arguments) {
  if (2 * terms_.size() >= table_.size()) grow();
  const std::size_t mask = table_.size() - 1;
  auto slot = hash_of(term, arguments) & mask;
  while (table_[slot] != 0) {
    const GroundTermId id(table_[slot] - 1);
    if (equal(terms_[id.index()], term, arguments)) return id;
    slot = (slot + 1) & mask;
  }
  terms_.push_back(term);
  terms_.back().first_argument = static_cast<std::uint32_t>(pool_.size());
  terms_.back().argument_count = static_cast<std::uint32_t>(arguments.size());
  // The arguments may lie in the pool itself.
  const std::vector<GroundTermId> copy(arguments.begin(), arguments.end());
  pool_.insert(pool_.end(), copy.begin(), copy.end());
  table_[slot] = static_cast<std::uint32_t>(terms_.size());
  return GroundTermId(table_[slot] - 1);
}

GroundTermId GroundTermStore::object(ObjectId id) {
  GroundTerm term;
  term.kind = TermKind::kObject;
  term.object = id;
  return intern(term, {});
}

GroundTermId GroundTermStore::integer(std::int64_t value) {
  GroundTerm term;
  term.kind = TermKind::kInteger;
  term.integer = value;
  return intern(term, {});
}

GroundTermId GroundTermStore::apply(SymbolId symbol, std::span<const GroundTermId> arguments) {
  GroundTerm term;
  term.kind = TermKind::kApply;
  term.symbol = symbol;
  return intern(term, arguments);
}

std::string GroundTermStore::text(GroundTermId id, const TypedModel& model) const {
  // Pieces still to print, the last first; a term is replaced by its parts.
  struct Piece {
    bool is_term = false;
    GroundTermId term;
    const char* text = "";
  };
  std::string out;
  std::vector<Piece> todo = {{true, id, ""}};
  while (!todo.empty()) {
    const auto piece = todo.back();
    todo.pop_back();
    if (!piece.is_term) {
      out += piece.text;
      continue;
    }
    const auto& term = terms_[piece.term.index()];
    if (term.kind == TermKind::kObject) {
      out += model.objects[term.object].name;
    } else if (term.kind == TermKind::kInteger) {
      out += std::to_string(term.integer);
    } else {
      out += model.symbols[term.symbol].name + "(";
      todo.push_back({false, {}, ")"});
      const auto parts = arguments(piece.term);
      for (std::size_t i = parts.size(); i-- > 0;) {
        todo.push_back({true, parts[i], ""});
        if (i > 0) todo.push_back({false, {}, ","});
      }
    }
  }
  return out;
}

}  // namespace parallax::compiler
