#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "compiler/artifact/literal.h"

namespace parallax::runtime {

using compiler::Literal;

/// The valuations of some variables that a set of clauses admits, one by one, by search: the
/// variables in order, false first, with unit propagation over two watched literals and
/// chronological backtracking (Davis, Logemann and Loveland 1962). Nothing is learned and no clause
/// is added, so that an answer costs what it propagates, however many there were before; where many
/// choices end in a conflict a solver that learns is the better tool, and the budget says when to
/// turn to it.
class ClauseSearch {
 public:
  enum class Status : std::uint8_t {
    kFound,   // value() has the next valuation
    kNoMore,  // every valuation was found
    kGaveUp,  // more conflicts than the budget admits; a further call goes on
  };

  /// Over the variables 1 .. `variables`. Valuations are told apart by `projected` and come in
  /// lexicographic order of it, each once.
  ClauseSearch(std::int32_t variables, std::span<const Literal> projected);
  /// Before the first begin().
  void add_clause(std::span<const Literal> clause);

  /// A new search, under these assumptions.
  void begin(std::span<const Literal> assumptions);
  Status next(std::int64_t budget);
  bool value(Literal literal) const { return is_true(code(literal)); }
  /// Choices that led nowhere, of all searches.
  std::int64_t conflicts() const { return conflicts_; }

 private:
  using Code = std::uint32_t;  // 2 * (variable - 1), and 1 more for the negative literal
  struct Watch {
    std::uint32_t clause;  // where it begins in `literals_`
    Code blocker;          // another of its literals: if it is true there is nothing to do
  };
  struct Level {
    std::size_t trail;    // its length before the decision
    std::size_t decided;  // index into `order_`
    bool is_second;       // both values have been tried
  };

  static Code code(Literal literal) {
    return 2 * (static_cast<Code>(literal.var()) - 1) + (literal.is_positive() ? 0 : 1);
  }
  bool is_true(Code c) const { return values_[c >> 1U] == ((c & 1U) != 0 ? -1 : 1); }
  bool is_open(Code c) const { return values_[c >> 1U] == 0; }
  void set(Code c);
  bool assume(Code c);
  bool propagate();
  bool visit(Code falsified);
  void undo(std::size_t trail);
  bool decide();
  bool flip();
  void leave_unprojected();

  std::vector<Code> literals_;               // of clauses of two and more, each ended by kEnd
  std::vector<Code> units_;                  // clauses of one literal
  bool has_empty_ = false;                   // there is a clause of none
  std::vector<std::vector<Watch>> watches_;  // by literal: clauses to visit when it becomes false
  std::vector<std::int8_t> values_;          // by variable: 1, 0, -1
  std::vector<Code> trail_;
  std::size_t head_ = 0;              // of the trail that is not propagated yet
  std::vector<std::uint32_t> order_;  // variables, the projected ones first
  std::size_t projected_ = 0;         // so many
  std::vector<Level> levels_;
  bool is_over_ = true;    // there are no more valuations
  bool is_found_ = false;  // value() has one
  std::int64_t conflicts_ = 0;
};

}  // namespace parallax::runtime
