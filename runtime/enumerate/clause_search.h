#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "runtime/enumerate/clause_propagation.h"

namespace parallax::runtime {

/// The valuations of some variables that a set of clauses admits, one by one, by search: the
/// variables in order, false first, with unit propagation, and clauses learned from conflicts
/// (first unique implication point, Marques-Silva and Sakallah 1999). No clause excludes earlier
/// answers: the search goes back to the last variable that tells valuations apart and has another
/// value left, and while it has that value, conflicts lead no further back (Gebser, Kaufmann and
/// Schaub 2009). So an answer costs the same however many there were before. The order is fixed; a
/// solver that chooses its own order may decide quickly where the search does not, and the budget
/// says when to turn to it.
class ClauseSearch {
 public:
  enum class Status : std::uint8_t {
    kFound,   // value() has the next valuation
    kNoMore,  // every valuation was found
    kGaveUp,  // the budget does not suffice; a further call goes on
  };

  /// Over the variables 1 .. `variables`. Valuations are told apart by `projected` and come in
  /// lexicographic order of it, each once. More than `most_learned` clauses are thinned out.
  ClauseSearch(std::int32_t variables, std::span<const Literal> projected,
               std::size_t most_learned = 4000);
  /// Before the first begin().
  void add_clause(std::span<const Literal> clause);

  /// A new search, under these assumptions. What was learned stays.
  void begin(std::span<const Literal> assumptions);
  /// Stops after `conflicts`, or as soon as assignments() has reached `assignments`.
  Status next(std::int64_t conflicts,
              std::int64_t assignments = std::numeric_limits<std::int64_t>::max());
  bool value(Literal literal) const { return state_.is_true(ClausePropagation::code(literal)); }
  /// Choices that led nowhere, of all searches.
  std::int64_t conflicts() const { return conflicts_; }
  /// Literals set, of all searches.
  std::int64_t assignments() const { return state_.assignments(); }

 private:
  using Code = ClausePropagation::Code;
  using Clause = ClausePropagation::Clause;
  struct Level {
    std::size_t trail;    // its length before the decision
    std::size_t decided;  // index into `order_`
    bool is_second;       // its other value has been searched, or there is none: assumptions
  };
  struct Learned {
    Clause clause;
    std::uint32_t levels;  // number of levels of its literals (Audemard and Simon 2009)
  };

  void enter(std::size_t decided, bool is_second);
  void back_to(std::size_t level);
  void note_levels();
  bool decide();
  bool flip();
  bool assume_learned();
  void leave_unprojected();
  bool resolve_conflict();
  Clause learn();
  bool is_implied(Code c) const;
  void assert_if_unit(Clause clause);
  void forget();

  ClausePropagation state_;
  std::vector<Code> units_;   // clauses of one literal
  bool has_empty_ = false;    // there is a clause of none
  Clause first_learned_ = 0;  // the clauses behind it were learned
  std::vector<Learned> learned_;
  std::vector<Clause> learned_units_;
  std::size_t most_learned_;
  std::vector<std::uint32_t> order_;  // variables, the projected ones first
  std::size_t projected_ = 0;         // number of projected variables
  std::vector<Level> levels_;
  std::vector<std::uint32_t> level_of_;  // by variable that is set: 0 before the first level
  std::size_t noted_ = 0;                // length of the trail whose levels are noted
  std::vector<bool> seen_;               // by variable, in a conflict
  std::vector<Code> made_;               // the clause that is being learned
  bool is_over_ = true;                  // there are no more valuations
  bool is_found_ = false;                // value() has one
  std::int64_t conflicts_ = 0;
};

}  // namespace parallax::runtime
