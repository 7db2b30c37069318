// Unit propagation by two watched literals (Moskewicz et al. 2001).
//
// A clause is visited only when one of its two watched literals becomes false. It then watches
// another literal that is not false, or its other watched literal must be true, or it is in
// conflict. A blocker, some other literal of the clause, often shows without a look at the
// clause that it is true. Taking values back needs no change of the watches. Clauses lie one
// behind the other in one array, each ended by a mark, so a clause is a place in it.
//
// Cost: for each literal that becomes false, the clauses that watch it, and their literals as
// far as a new watch is sought.

#include "runtime/enumerate/clause_propagation.h"

#include <algorithm>

namespace parallax::runtime {

ClausePropagation::ClausePropagation(std::int32_t variables)
    : watches_(2 * static_cast<std::size_t>(variables)),
      values_(static_cast<std::size_t>(variables), 0),
      reasons_(static_cast<std::size_t>(variables), kNone) {}

ClausePropagation::Clause ClausePropagation::add(std::span<const Code> literals) {
  const auto begin = end();
  literals_.insert(literals_.end(), literals.begin(), literals.end());
  literals_.push_back(kEnd);
  watch(begin);
  return begin;
}

void ClausePropagation::watch(Clause clause) {
  const auto* literals = &literals_[clause];
  if (literals[0] == kEnd || literals[1] == kEnd) return;
  watches_[literals[0]].push_back({clause, literals[1]});
  watches_[literals[1]].push_back({clause, literals[0]});
}

std::vector<ClausePropagation::Clause> ClausePropagation::retain(Clause first,
                                                                 std::span<const Clause> keep) {
  for (auto& watches : watches_) {
    std::erase_if(watches, [&](const Watch& watch) { return watch.clause >= first; });
  }
  std::vector<Clause> moved;
  moved.reserve(keep.size());
  auto to = first;
  for (const auto from : keep) {
    moved.push_back(to);
    auto at = from;
    do literals_[to++] = literals_[at];
    while (literals_[at++] != kEnd);
  }
  literals_.resize(to);
  const auto now = [&](Clause clause) {
    if (clause == kNone || clause < first) return clause;
    const auto found = std::lower_bound(keep.begin(), keep.end(), clause);
    return found != keep.end() && *found == clause
               ? moved[static_cast<std::size_t>(found - keep.begin())]
               : kNone;
  };
  for (const auto c : trail_) reasons_[c >> 1U] = now(reasons_[c >> 1U]);
  conflict_ = now(conflict_);
  for (const auto clause : moved) watch(clause);
  return moved;
}

bool ClausePropagation::propagate() {
  while (head_ < trail_.size()) {
    if (!visit(trail_[head_++] ^ 1U)) return false;
  }
  return true;
}

bool ClausePropagation::visit(Code falsified) {
  auto& watches = watches_[falsified];
  std::size_t kept = 0;
  bool is_consistent = true;
  for (std::size_t i = 0; i < watches.size(); ++i) {
    const auto watch = watches[i];
    watches[kept++] = watch;
    if (!is_consistent || is_true(watch.blocker)) continue;
    auto* clause = &literals_[watch.clause];
    if (clause[0] == falsified) std::swap(clause[0], clause[1]);
    const auto other = clause[0];
    watches[kept - 1].blocker = other;
    if (is_true(other)) continue;
    auto* next = clause + 2;
    while (*next != kEnd && !is_open(*next) && !is_true(*next)) ++next;
    if (*next != kEnd) {
      std::swap(clause[1], *next);
      watches_[clause[1]].push_back({watch.clause, other});
      --kept;
    } else if (is_open(other)) {
      set(other, watch.clause);
    } else {
      conflict_ = watch.clause;
      is_consistent = false;
    }
  }
  watches.resize(kept);
  return is_consistent;
}

void ClausePropagation::undo(std::size_t trail) {
  if (trail_.size() > trail) undone_ += static_cast<std::int64_t>(trail_.size() - trail);
  while (trail_.size() > trail) {
    values_[trail_.back() >> 1U] = 0;
    trail_.pop_back();
  }
  head_ = trail;
}

}  // namespace parallax::runtime
