#pragma once

#include <optional>
#include <span>
#include <vector>

#include "runtime/enumerate/trace_source.h"
#include "runtime/session/solver_session.h"

namespace parallax::runtime {

using compiler::Literal;

/// The atoms that tell traces apart, in blocks: the state at 0; then for every timepoint t the
/// events at t and the state at t + 1; at last, if they count, the user predicates. One after the
/// other the blocks are in canonical order.
std::vector<std::vector<Literal>> projection_blocks(const CompiledModel& model, Distinct distinct);
/// The same atoms, one block after the other.
std::vector<Literal> projected_atoms(const CompiledModel& model, Distinct distinct);

/// The literals of an order as they are in a valuation, one after the other.
struct OrderedValuation {
  std::vector<Literal> literals;
  /// Another valuation, which differs in these literals, was come upon on the way.
  bool has_others = false;
};

/// Moves the session's valuation to the first one in lexicographic order: `order` lists literals
/// by weight, each in its preferred polarity. The session must hold a valuation found with horizon
/// `n` under `assumptions`. Afterwards value() gives the first valuation, whatever the solver
/// found before. A few calls where nothing can be improved; about log2 of the length of `order` for
/// each literal that can.
/// None if the solver was stopped on the way.
[[nodiscard]] std::optional<OrderedValuation> make_canonical(SolverSession& session, Timepoint n,
                                                             std::span<const Literal> assumptions,
                                                             std::span<const Literal> order);

/// The same where the canonical order is wanted, else the literals as they are in the valuation.
[[nodiscard]] std::optional<OrderedValuation> in_order(SolverSession& session, Timepoint n,
                                                       std::span<const Literal> assumptions,
                                                       std::span<const Literal> order,
                                                       TraceOrder wanted);

}  // namespace parallax::runtime
