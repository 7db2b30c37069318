// Ground terms, each stored once, and the finite domain of every sort.
//
// Terms are interned in a table with linear probing (hash consing), so equal terms have equal
// ids. A sort's domain has the domains of the sorts below it, then its constants, the integers
// of its ranges and, for a reified sort, every application of its constructors to members of
// their argument sorts. Sorts are visited depth first and a sort that needs itself is an error.
// The sizes of ranges and of products are computed with a check for overflow and compared with a
// limit before they are listed. The timepoints have to be the integers from 0 to the horizon
// without a gap.
//
// Cost: linear in the terms made, n log n for a domain of n terms.

#include "compiler/ground/universe.h"

#include <algorithm>
#include <vector>

#include "compiler/base/codes/grounding.h"
#include "compiler/base/integer_range.h"

namespace parallax::compiler {

namespace {

constexpr std::size_t kFirstTableSize = 256;  // a power of two

/// Each part is mixed by itself, so that the low bits, which choose the slot, depend on all of
/// them: a model may have hundreds of symbols without arguments.
std::size_t hash_of(const GroundTerm& term, std::span<const GroundTermId> arguments) {
  std::uint64_t h = 0x9e3779b97f4a7c15ULL;
  const auto mix = [&](std::uint64_t value) {
    h ^= value;
    h *= 0xbf58476d1ce4e5b9ULL;
    h ^= h >> 29U;
  };
  mix(static_cast<std::uint64_t>(term.integer));
  mix(std::uint64_t{term.object.index()} << 32U | term.symbol.index());
  mix(static_cast<std::uint64_t>(term.kind));
  for (const auto argument : arguments) mix(argument.index());
  return static_cast<std::size_t>(h);
}

enum : std::uint8_t { kUntouched, kInWork, kDone };

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

base::Result<Universe> Universe::make(const TypedModel& model, const GroundOptions& options,
                                      GroundTermStore& terms, base::DiagnosticSink& sink) {
  Universe universe;
  const auto count = model.sorts.size();
  universe.domains_.resize(count);
  universe.members_.resize(count);
  universe.unbounded_.resize(count, false);
  universe.state_.resize(count, kUntouched);
  for (std::size_t i = 0; i < count; ++i) {
    if (!universe.add_domain(model.sorts.id_at(i), model, options, terms, sink)) {
      return sink.already_reported();
    }
  }
  PARALLAX_REQUIRE(model.core.time.has_value(), "a model loads the event calculus");
  const auto& time = model.sorts[*model.core.time];
  auto& timepoints = universe.domains_[model.core.time->index()];
  std::sort(timepoints.begin(), timepoints.end(),
            [&](GroundTermId a, GroundTermId b) { return terms[a].integer < terms[b].integer; });
  if (timepoints.empty()) return sink.error(codes::kNoTimepoints, time.declared);
  if (terms[timepoints.front()].integer != 0) {
    const auto where = time.ranges.empty() ? time.declared : time.ranges.front().declared;
    return sink.error(codes::kTimeMustStartAtZero, where, terms[timepoints.front()].integer);
  }
  for (std::size_t i = 1; i < timepoints.size(); ++i) {
    const auto before = terms[timepoints[i - 1]].integer, after = terms[timepoints[i]].integer;
    if (after == before + 1) continue;
    const auto where = time.ranges.empty() ? time.declared : time.ranges.back().declared;
    return sink.error(codes::kTimeHasGap, where, before + 1, before, after);
  }
  universe.horizon_ = static_cast<std::int32_t>(timepoints.size()) - 1;
  return universe;
}

bool Universe::add_domain(SortId sort, const TypedModel& model, const GroundOptions& options,
                          GroundTermStore& terms, base::DiagnosticSink& sink) {
  auto& state = state_[sort.index()];
  if (state == kDone) return true;
  const auto& declared = model.sorts[sort];
  if (state == kInWork) {
    sink.error(codes::kSortContainsItself, declared.declared, declared.name);
    return false;
  }
  state = kInWork;
  std::vector<GroundTermId> domain;
  bool bounded_below = !declared.ranges.empty();
  for (std::size_t i = 0; i < model.sorts.size(); ++i) {
    const auto below = model.sorts.id_at(i);
    const auto& parents = model.sorts[below].parents;
    if (std::find(parents.begin(), parents.end(), sort) == parents.end()) continue;
    if (!add_domain(below, model, options, terms, sink)) return false;
    const auto& inner = domains_[below.index()];
    domain.insert(domain.end(), inner.begin(), inner.end());
  }
  for (const auto object : declared.constants) domain.push_back(terms.object(object));
  std::int64_t total = static_cast<std::int64_t>(domain.size());
  for (const auto& range : declared.ranges) {
    std::int64_t width = 0;
    if (__builtin_sub_overflow(range.upper, range.lower, &width) ||
        __builtin_add_overflow(total, width, &total) || total >= options.max_domain) {
      sink.error(codes::kDomainTooLarge, range.declared, declared.name, options.max_domain);
      return false;
    }
    ++total;
  }
  for (const auto& range : declared.ranges) {
    for (const auto v : base::IntegerRange(range.lower, range.upper)) {
      domain.push_back(terms.integer(v));
    }
  }
  domains_[sort.index()] = std::move(domain);
  if (declared.reified && !add_constructors(sort, model, options, terms, sink)) return false;

  auto& mine = domains_[sort.index()];
  auto& members = members_[sort.index()];
  for (const auto term : mine) members.push_back(term.index());
  std::sort(members.begin(), members.end());
  if (std::adjacent_find(members.begin(), members.end()) != members.end()) {
    // Overlapping ranges or subsorts: keep the first occurrence of each term.
    members.erase(std::unique(members.begin(), members.end()), members.end());
    std::vector<bool> seen(terms.size(), false);
    std::erase_if(mine, [&](GroundTermId term) {
      const bool again = seen[term.index()];
      seen[term.index()] = true;
      return again;
    });
  }
  unbounded_[sort.index()] = declared.integer && !bounded_below && mine.empty();
  state = kDone;
  return true;
}

bool Universe::add_constructors(SortId sort, const TypedModel& model, const GroundOptions& options,
                                GroundTermStore& terms, base::DiagnosticSink& sink) {
  for (std::size_t i = 0; i < model.symbols.size(); ++i) {
    const auto symbol_id = model.symbols.id_at(i);
    const auto& symbol = model.symbols[symbol_id];
    if (symbol.result != sort || symbol.kind == SymbolKind::kFunction) continue;
    std::int64_t instances = 1;
    for (const auto argument : symbol.arguments) {
      if (!add_domain(argument, model, options, terms, sink)) return false;
      const auto size = static_cast<std::int64_t>(domains_[argument.index()].size());
      if (__builtin_mul_overflow(instances, size, &instances) || instances > options.max_domain) {
        sink.error(codes::kDomainTooLarge, symbol.declared, symbol.name, options.max_domain);
        return false;
      }
    }
    std::vector<std::size_t> odometer(symbol.arguments.size(), 0);
    for (std::int64_t k = 0; k < instances; ++k) {
      std::vector<GroundTermId> arguments;
      for (std::size_t a = 0; a < odometer.size(); ++a) {
        arguments.push_back(domains_[symbol.arguments[a].index()][odometer[a]]);
      }
      domains_[sort.index()].push_back(terms.apply(symbol_id, std::move(arguments)));
      for (std::size_t a = odometer.size(); a-- > 0;) {
        if (++odometer[a] < domains_[symbol.arguments[a].index()].size()) break;
        odometer[a] = 0;
      }
    }
  }
  return true;
}

bool Universe::contains(SortId sort, GroundTermId term, const GroundTermStore& terms) const {
  if (unbounded_[sort.index()]) return terms[term].kind == TermKind::kInteger;
  const auto& members = members_[sort.index()];
  return std::binary_search(members.begin(), members.end(), term.index());
}

}  // namespace parallax::compiler
