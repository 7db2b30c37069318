// Clauses of a proof, and unit propagation that prefers those that proofs use.
//
// All clauses lie in one array of words; a hash over the literals, in any order, finds one for
// deletion, and the array is compacted when more than half of it is deleted. Propagation watches
// two literals of each clause. Clauses that took part in a conflict are marked as core and
// watched in lists of their own; the trail is first propagated over these lists and only then
// over the others (core-first propagation, as in drat-trim: Wetzler, Heule and Hunt 2014). So
// most checks touch few clauses. It shares no code with the solvers whose proofs it checks.

#include "runtime/proof/proof_clauses.h"

#include <algorithm>
#include <utility>

namespace parallax::runtime {

ProofClauses::ProofClauses(std::size_t max_bytes)
    : max_words_(std::min(max_bytes / sizeof(std::uint32_t), std::size_t{kNone})),
      buckets_(1024, kNone) {}

/// The same for every order of the literals.
std::size_t ProofClauses::bucket(std::span<const Code> literals) const {
  std::uint64_t sum = 0, mix = 0;
  for (const auto literal : literals) {
    const auto spread = (std::uint64_t{literal} + 1) * 0x9E3779B97F4A7C15U;
    sum += spread;
    mix ^= spread ^ (spread >> 29U);
  }
  auto hash = (sum ^ (mix << 1U) ^ literals.size()) * 0xBF58476D1CE4E5B9U;
  hash ^= hash >> 32U;
  return static_cast<std::size_t>(hash) & (buckets_.size() - 1);
}

void ProofClauses::link(Ref clause) {
  auto& head = buckets_[bucket(literals(clause))];
  words_[clause + 2] = head;
  head = clause;
}

void ProofClauses::rehash(std::size_t buckets) {
  buckets_.assign(buckets, kNone);
  for (Ref clause = first(); clause != end(); clause = next(clause)) {
    if (!is_removed(clause)) link(clause);
  }
}

std::optional<ProofClauses::Ref> ProofClauses::add(std::span<const Code> literals) {
  if (literals.size() + kHeader > max_words_ - words_.size()) return std::nullopt;
  const auto clause = static_cast<Ref>(words_.size());
  words_.push_back(static_cast<std::uint32_t>(literals.size()));
  words_.push_back(0);
  words_.push_back(kNone);
  words_.insert(words_.end(), literals.begin(), literals.end());
  if (++live_ > buckets_.size()) {
    rehash(buckets_.size() * 2);
  } else {
    link(clause);
  }
  return clause;
}

ProofClauses::Ref ProofClauses::find(std::span<const Code> literals) const {
  std::vector<Code> wanted, candidate;
  for (Ref clause = buckets_[bucket(literals)]; clause != kNone; clause = words_[clause + 2]) {
    if (words_[clause] != literals.size()) continue;
    if (wanted.empty()) {
      wanted.assign(literals.begin(), literals.end());
      std::sort(wanted.begin(), wanted.end());
    }
    const auto held = this->literals(clause);
    candidate.assign(held.begin(), held.end());
    std::sort(candidate.begin(), candidate.end());
    if (candidate == wanted) return clause;
  }
  return kNone;
}

void ProofClauses::remove(Ref clause) {
  Ref* place = &buckets_[bucket(literals(clause))];
  while (*place != clause) place = &words_[*place + 2];
  *place = words_[clause + 2];
  words_[clause + 1] |= kRemoved;
  --live_;
  removed_words_ += kHeader + words_[clause];
}

void ProofClauses::compact() {
  std::size_t to = 0;
  const auto old_end = end();
  for (Ref clause = first(); clause != old_end;) {
    const auto size = kHeader + words_[clause];
    const auto following = clause + size;
    if (!is_removed(clause)) {
      std::copy_n(words_.begin() + clause, size, words_.begin() + static_cast<std::ptrdiff_t>(to));
      to += size;
    }
    clause = following;
  }
  words_.resize(to);
  removed_words_ = 0;
  rehash(buckets_.size());
}

using proof_literal::negated;
using proof_literal::variable;

void ProofPropagator::resize(std::uint32_t count) {
  const auto variables = std::size_t{count} + 1;
  if (variables <= reason_.size()) return;
  value_.resize(2 * variables, 0);
  core_.resize(2 * variables);
  others_.resize(2 * variables);
  reason_.resize(variables, ProofClauses::kNone);
  seen_.resize(variables, false);
}

void ProofPropagator::assign(Code literal, Ref reason) {
  value_[literal] = 1;
  value_[negated(literal)] = -1;
  reason_[variable(literal)] = reason;
  trail_.push_back(literal);
}

void ProofPropagator::watch(Ref clause) {
  const auto literals = std::as_const(clauses_).literals(clause);
  if (literals.size() < 2) return;
  auto& lists = clauses_.is_core(clause) ? core_ : others_;
  lists[literals[0]].push_back({clause, literals[1]});
  lists[literals[1]].push_back({clause, literals[0]});
}

bool ProofPropagator::attach(Ref clause) {
  auto literals = clauses_.literals(clause);
  // Watched are two literals that are not false, as far as there are any.
  std::size_t found = 0;
  for (std::size_t i = 0; i < literals.size() && found < 2; ++i) {
    if (!is_false(literals[i])) std::swap(literals[i], literals[found++]);
  }
  watch(clause);
  if (found == 0) return false;
  if (found == 1 && is_open(literals[0])) assign(literals[0], clause);
  return true;
}

bool ProofPropagator::is_support(Ref clause) const {
  int supported = 0;
  for (const auto literal : std::as_const(clauses_).literals(clause)) {
    if (is_false(literal)) continue;
    if (is_open(literal) || ++supported > 1) return false;
  }
  return supported == 1;
}

void ProofPropagator::rebuild() {
  for (auto& list : core_) list.clear();
  for (auto& list : others_) list.clear();
  for (Ref clause = clauses_.first(); clause != clauses_.end(); clause = clauses_.next(clause)) {
    watch(clause);
  }
}

/// Looks at the clauses that watch a literal which has become false.
ProofPropagator::Ref ProofPropagator::visit(Code falsified, bool core) {
  auto& list = (core ? core_ : others_)[falsified];
  Ref conflict = ProofClauses::kNone;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < list.size(); ++i) {
    auto entry = list[i];
    if (conflict != ProofClauses::kNone || is_true(entry.blocker)) {
      list[kept++] = entry;
      continue;
    }
    if (clauses_.is_removed(entry.clause)) continue;
    auto literals = clauses_.literals(entry.clause);
    if (literals[0] == falsified) std::swap(literals[0], literals[1]);
    entry.blocker = literals[0];
    const auto end = literals.end();
    const auto other =
        is_true(literals[0]) ? end : std::find_if(literals.begin() + 2, end, [&](Code literal) {
          return !is_false(literal);
        });
    const bool is_core = clauses_.is_core(entry.clause);
    if (other != end) {
      std::swap(literals[1], *other);
      (is_core ? core_ : others_)[literals[1]].push_back(entry);
      continue;
    }
    if (is_core && !core) {
      core_[falsified].push_back(entry);
    } else {
      list[kept++] = entry;
    }
    if (is_false(literals[0])) conflict = entry.clause;
    if (is_open(literals[0])) assign(literals[0], entry.clause);
  }
  list.resize(kept);
  return conflict;
}

ProofPropagator::Ref ProofPropagator::propagate() {
  constexpr std::uint32_t kOften = 1U << 12U;
  while (other_head_ < trail_.size()) {
    if (++visits_ % kOften == 0 && stop_ != nullptr && stop_->load()) stopped_ = true;
    if (stopped_) return ProofClauses::kNone;
    const bool core = core_head_ < trail_.size();
    const auto literal = trail_[core ? core_head_++ : other_head_++];
    const auto conflict = visit(negated(literal), core);
    if (conflict != ProofClauses::kNone) return conflict;
  }
  return ProofClauses::kNone;
}

void ProofPropagator::backtrack(std::size_t mark) {
  while (trail_.size() > mark) {
    value_[trail_.back()] = 0;
    value_[negated(trail_.back())] = 0;
    trail_.pop_back();
  }
  core_head_ = std::min(core_head_, mark);
  other_head_ = std::min(other_head_, mark);
}

void ProofPropagator::mark_core(Ref conflict, std::size_t mark) {
  const auto note = [&](Ref clause) {
    clauses_.mark_core(clause);
    for (const auto literal : std::as_const(clauses_).literals(clause)) {
      seen_[variable(literal)] = true;
    }
  };
  note(conflict);
  std::vector<Ref> noted = {conflict};
  for (auto i = trail_.size(); i > mark; --i) {
    const auto about = variable(trail_[i - 1]);
    if (!seen_[about] || reason_[about] == ProofClauses::kNone) continue;
    note(reason_[about]);
    noted.push_back(reason_[about]);
  }
  for (const auto clause : noted) {
    for (const auto literal : std::as_const(clauses_).literals(clause)) {
      seen_[variable(literal)] = false;
    }
  }
}

}  // namespace parallax::runtime
