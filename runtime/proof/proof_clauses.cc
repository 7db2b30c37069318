#include "runtime/proof/proof_clauses.h"

#include <algorithm>

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

}  // namespace parallax::runtime
