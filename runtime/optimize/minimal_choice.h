#pragma once

#include <cstddef>
#include <vector>

#include "compiler/artifact/compiled_model.h"
#include "runtime/session/solver_session.h"

namespace parallax::runtime {

/// Literals by level, the most important level first. Of two traces that agree on the levels
/// before, the one is better whose true literals of a level are some, but not all, of the other's.
using Levels = std::vector<std::vector<Literal>>;

struct MinimalChoices {
  /// The true literals, by level, of traces than which no other is better; each choice once.
  std::vector<Levels> choices;
  bool complete = false;  // false: the solver was stopped, or there are more than asked for
};

/// The choices of a model's traces of the full horizon. The session is fresh, and cannot be used
/// afterwards.
MinimalChoices minimal_choices(SolverSession& session, const Levels& levels, std::size_t most);

/// The model whose traces are those of `model` that make one of the choices, which are all of the
/// minimal ones. Clauses: the literals times the choices.
compiler::CompiledModel with_choices(const compiler::CompiledModel& model, const Levels& levels,
                                     const std::vector<Levels>& choices);

}  // namespace parallax::runtime
