#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <span>
#include <vector>

namespace parallax::runtime::proof_literal {

/// A literal as binary DRAT writes it: 2v for the variable v, 2v + 1 for its negation. The checker
/// has a type of its own, because it shares nothing with the program that it checks.
using Code = std::uint32_t;

inline constexpr std::int64_t kMaxVariable = (std::int64_t{1} << 31U) - 1;

inline Code from_dimacs(std::int64_t value) {
  return static_cast<Code>(2 * std::abs(value)) + (value < 0 ? 1U : 0U);
}
inline Code negated(Code code) { return code ^ 1U; }
inline std::uint32_t variable(Code code) { return code >> 1U; }

}  // namespace parallax::runtime::proof_literal

namespace parallax::runtime {

/// The clauses of a proof in one array, found by their literals in any order. A clause that was
/// added twice has to be removed twice. Clauses keep the order of their addition.
class ProofClauses {
 public:
  using Code = proof_literal::Code;
  using Ref = std::uint32_t;
  static constexpr Ref kNone = UINT32_MAX;

  /// `max_bytes`: size limit of the array.
  explicit ProofClauses(std::size_t max_bytes);

  /// None: there is no room. The literals are distinct.
  std::optional<Ref> add(std::span<const Code> literals);
  /// The last added clause with these literals; kNone if there is none.
  Ref find(std::span<const Code> literals) const;
  void remove(Ref clause);

  /// The literals of a clause; the propagator that watches them may reorder them.
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

/// Unit propagation over a proof's clauses with two watched literals. Clauses that took part in an
/// earlier conflict ("core") are visited before the others, because they are the ones that lead to
/// the next conflict (Heule, Hunt and Wetzler 2013, "Trimming while checking clausal proofs").
///
/// Assignments made while no mark is open are permanent.
class ProofPropagator {
 public:
  using Code = proof_literal::Code;
  using Ref = ProofClauses::Ref;

  /// `clauses` outlives the object; `stop` may be null.
  ProofPropagator(ProofClauses& clauses, const std::atomic<bool>* stop)
      : clauses_(clauses), stop_(stop) {}

  /// Makes room for the variables 1 .. count.
  void resize(std::uint32_t count);

  bool is_true(Code literal) const { return value_[literal] > 0; }
  bool is_false(Code literal) const { return value_[literal] < 0; }
  bool is_open(Code literal) const { return value_[literal] == 0; }
  void assign(Code literal, Ref reason = ProofClauses::kNone);

  /// Watches a new clause and assigns the literal that it forces. False: all its literals are
  /// false.
  bool attach(Ref clause);
  /// Is this clause the last support of a literal: one literal true, the others false?
  bool is_support(Ref clause) const;
  /// Watches everything anew, after the clauses were compacted.
  void rebuild();

  /// The clause that became false, or kNone: nothing more follows, or the flag was raised.
  Ref propagate();
  bool stopped() const { return stopped_; }

  std::size_t mark() const { return trail_.size(); }
  void backtrack(std::size_t mark);
  /// Marks what led to the conflict from the assignments after `mark` as core.
  void mark_core(Ref conflict, std::size_t mark);

 private:
  struct Watch {
    Ref clause;
    Code blocker;  // another literal of the clause: if it is true there is nothing to do
  };
  using Watches = std::vector<Watch>;

  void watch(Ref clause);
  Ref visit(Code falsified, bool core);

  ProofClauses& clauses_;
  const std::atomic<bool>* stop_;
  bool stopped_ = false;
  std::uint32_t visits_ = 0;
  std::vector<std::int8_t> value_;      // by literal: 1, 0, -1
  std::vector<Ref> reason_;             // by variable
  std::vector<bool> seen_;              // by variable
  std::vector<Watches> core_, others_;  // by literal: clauses to visit when it becomes false
  std::vector<Code> trail_;
  std::size_t core_head_ = 0, other_head_ = 0;
};

}  // namespace parallax::runtime
