#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "runtime/session/solver_session.h"
#include "runtime/symmetry/interchangeable.h"

namespace parallax::runtime {

/// Minimal number of symmetries for which symmetry-breaking clauses pay: with fewer, they cost a
/// solver more than they save.
inline constexpr unsigned long kWorthBreaking = 100;

/// Symmetry-breaking clauses that keep the lexicographically first valuation of each orbit (false
/// before true), and as a rule few others. For every generator g, they require that the valuation
/// is not after its image under g. The first of an orbit is before all others of it, so that
/// clauses for any set of symmetries keep it, whatever these generate (Crawford, Ginsberg, Luks and
/// Roy 1996). All clauses use one order of the variables, so they are consistent together. They are
/// linear in the variables that move (chains of equalities; Aloul, Sakallah and Markov 2003). In
/// the order of the traces they keep the first trace of a model, and of every orbit.
class LexLeader {
 public:
  using AddClause = std::function<void(std::span<const Literal>)>;
  using NewVariable = std::function<Literal()>;

  /// `order`: blocks of positive literals of the model; atoms outside the order are left open.
  LexLeader(const CompiledModel& model, std::span<const NodeMap> generators,
            const std::vector<std::vector<Literal>>& order);

  /// Adds the clauses over the first `blocks` blocks, as far as they were not made before. Leaving
  /// some out weakens the breaking, but is never wrong. Linear in the literals that move.
  void extend(std::size_t blocks, const AddClause& add_clause, const NewVariable& new_variable);

 private:
  /// Requires that `first` is at most `second`, as long as all pairs before are equal.
  struct Pair {
    std::int32_t first = 0, second = 0;
    std::size_t block = 0;
  };
  struct Chain {
    std::vector<Pair> pairs;  // in order
    std::size_t next = 0;
    std::optional<Literal> equal;  // all pairs before `next` are; none: there are none
  };
  std::vector<Chain> chains_;
};

/// The atoms by which valuations are compared in canonical order, block by block: first those that
/// distinguish traces (projection_blocks), then in one more block all other atoms of the model,
/// except those of a plan's control.
std::vector<std::vector<Literal>> whole_order(const CompiledModel& model,
                                              std::vector<std::vector<Literal>> observed);

/// All atoms of the model by the horizon that they need, for questions about one length after the
/// other: block n has those of horizon n.
std::vector<std::vector<Literal>> order_by_horizon(const CompiledModel& model);

/// Breaks the symmetry of a session's model under an assumption, for questions of existence. Adding
/// a clause about single traces makes it invalid.
class SymmetryBreaker {
 public:
  /// `session` outlives the breaker.
  SymmetryBreaker(SolverSession& session, std::span<const NodeMap> generators,
                  const std::vector<std::vector<Literal>>& order);
  /// Adds the clauses over the first `blocks` blocks to the session.
  void extend(std::size_t blocks);
  /// The assumption under which the clauses hold.
  Literal assumption() const { return guard_; }
  /// Gives the clauses up: they are of no more use.
  void retire();

 private:
  SolverSession& session_;
  LexLeader clauses_;
  Literal guard_;
};

/// The model with the clauses over the whole order in it, for callers that list the remaining
/// traces. Its traces are traces of `model`. The chains' variables are added to the fixed ones.
CompiledModel broken_model(const CompiledModel& model, std::span<const NodeMap> generators,
                           const std::vector<std::vector<Literal>>& order);

}  // namespace parallax::runtime
