#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "compiler/artifact/literal.h"

namespace parallax::runtime {

using compiler::Literal;

/// Clauses and a partial valuation that unit propagation extends (two watched literals: Moskewicz
/// et al. 2001). Remembers why a literal was set, so that conflicts can be traced back. Literals
/// are codes: 2 * (variable - 1), and 1 more for the negative literal.
class ClausePropagation {
 public:
  using Code = std::uint32_t;
  using Clause = std::uint32_t;  // where its literals begin, the last one followed by kEnd
  static constexpr std::uint32_t kEnd = std::numeric_limits<std::uint32_t>::max();
  static constexpr Clause kNone = kEnd;

  explicit ClausePropagation(std::int32_t variables);
  static Code code(Literal literal) {
    return 2 * (static_cast<Code>(literal.var()) - 1) + (literal.is_positive() ? 0 : 1);
  }

  /// Two of its literals are watched, the first two, unless it is shorter. While literals are set,
  /// these must be the ones that a return from the trail frees first.
  Clause add(std::span<const Code> literals);
  /// Removes the clauses from `first` on that are not in `keep`. Reasons and conflict are updated
  /// to the new places; a literal whose reason is removed keeps no reason. Returns the new places
  /// of the clauses that stay, in the order of `keep`, which is ascending.
  std::vector<Clause> retain(Clause first, std::span<const Clause> keep);
  Clause end() const { return static_cast<Clause>(literals_.size()); }

  std::size_t variables() const { return values_.size(); }
  bool is_true(Code c) const { return values_[c >> 1U] == ((c & 1U) != 0 ? -1 : 1); }
  bool is_open(Code c) const { return values_[c >> 1U] == 0; }
  /// An open literal becomes true; `reason`: the clause whose other literals are false.
  void set(Code c, Clause reason = kNone) {
    values_[c >> 1U] = (c & 1U) != 0 ? -1 : 1;
    reasons_[c >> 1U] = reason;
    trail_.push_back(c);
  }
  /// False: it is false already.
  bool assume(Code c) {
    if (is_open(c)) set(c);
    return is_true(c);
  }
  /// False: all literals of conflict() are false.
  bool propagate();
  void undo(std::size_t trail);

  Clause conflict() const { return conflict_; }
  Clause reason(Code c) const { return reasons_[c >> 1U]; }
  const std::vector<Code>& trail() const { return trail_; }
  /// Literals set so far, those that were taken back included: a measure of work.
  std::int64_t assignments() const { return undone_ + static_cast<std::int64_t>(trail_.size()); }
  const Code* literals(Clause clause) const { return &literals_[clause]; }

 private:
  struct Watch {
    Clause clause;
    Code blocker;  // another of its literals: if it is true there is nothing to do
  };
  bool visit(Code falsified);
  void watch(Clause clause);

  std::vector<Code> literals_;
  std::vector<std::vector<Watch>> watches_;  // by literal: clauses to visit when it becomes false
  std::vector<std::int8_t> values_;          // by variable: 1, 0, -1
  std::vector<Clause> reasons_;              // by variable
  std::vector<Code> trail_;
  std::int64_t undone_ = 0;  // literals that were set and taken back
  std::size_t head_ = 0;     // of the trail that is not propagated yet
  Clause conflict_ = kNone;
};

}  // namespace parallax::runtime
