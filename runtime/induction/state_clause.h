#pragma once

#include <optional>
#include <vector>

#include "compiler/artifact/compiled_model.h"

namespace parallax::runtime {

/// Something about the state at one timepoint, in terms that all compilations of a model share.
struct StateLiteral {
  compiler::FluentId fluent;
  bool released = false;  // ReleasedAt instead of HoldsAt
  bool positive = true;
};
using StateClause = std::vector<StateLiteral>;

/// The clause over a model's variables at timepoint t; none: it is true there.
std::optional<std::vector<compiler::Literal>> clause_at(const compiler::CompiledModel& model,
                                                        const StateClause& clause,
                                                        compiler::Timepoint t);

/// Clauses that may hold at every timepoint: of each fluent that it holds, that it does not, and
/// the same of its release; that two instances of a fluent that differ in one argument do not both
/// hold (at most kMostPairs of these); and the invariants that grounding found.
std::vector<StateClause> candidate_invariants(const compiler::CompiledModel& model,
                                              compiler::Timepoint t);

inline constexpr std::size_t kMostPairs = 50'000;

}  // namespace parallax::runtime
