#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "runtime/proof/proof_literal.h"

namespace parallax::runtime {

/// The clauses that a proof stands on: one array, found again by their literals in any order. A
/// clause that is there twice has to be removed twice. Clauses keep the order of their addition.
class ProofClauses {
 public:
  using Code = proof_literal::Code;
  using Ref = std::uint32_t;
  static constexpr Ref kNone = UINT32_MAX;

  /// `max_bytes`: what the array may grow to.
  explicit ProofClauses(std::size_t max_bytes);

  /// None: there is no room. The literals are distinct.
  std::optional<Ref> add(std::span<const Code> literals);
  /// A clause with these literals, the one added last; kNone if there is none.
  Ref find(std::span<const Code> literals) const;
  void remove(Ref clause);

  /// The literals may be reordered by whoever watches them.
  std::span<Code> literals(Ref clause) {
    return std::span(words_).subspan(clause + kHeader, words_[clause]);
  }
  std::span<const Code> literals(Ref clause) const {
    return std::span(words_).subspan(clause + kHeader, words_[clause]);
  }
  bool is_removed(Ref clause) const { return (words_[clause + 1] & kRemoved) != 0; }
  bool is_core(Ref clause) const { return (words_[clause + 1] & kCore) != 0; }
  void mark_core(Ref clause) { words_[clause + 1] |= kCore; }

  /// first() .. next() visits all clauses, also removed ones, until end().
  Ref first() const { return 0; }
  Ref next(Ref clause) const { return clause + kHeader + words_[clause]; }
  Ref end() const { return static_cast<Ref>(words_.size()); }

  /// More than half of the array is removed clauses. Compacting makes all references invalid.
  bool is_sparse() const { return removed_words_ > kSparse && removed_words_ * 2 > words_.size(); }
  void compact();

 private:
  // A clause: its size, its flags, the next clause of the same bucket, its literals.
  static constexpr std::uint32_t kHeader = 3, kRemoved = 1, kCore = 2;
  static constexpr std::size_t kSparse = std::size_t{1} << 20U;

  std::size_t bucket(std::span<const Code> literals) const;
  void link(Ref clause);
  void rehash(std::size_t buckets);

  std::size_t max_words_;
  std::vector<std::uint32_t> words_;
  std::vector<Ref> buckets_;
  std::size_t live_ = 0, removed_words_ = 0;
};

}  // namespace parallax::runtime
