#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "runtime/proof/proof_clauses.h"

namespace parallax::runtime {

/// Unit propagation over a proof's clauses with two watched literals. Clauses that took part in
/// an earlier conflict ("core") are visited before the others, because they are the ones that lead
/// to the next conflict (Heule, Hunt and Wetzler 2013, "Trimming while checking clausal proofs").
///
/// What is assigned while no mark is open stays for good.
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

  /// Watches a new clause and assigns what it forces. False: all its literals are false.
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
