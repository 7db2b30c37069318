#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "compiler/artifact/compiled_model.h"

namespace parallax::runtime {

enum class BoundKind : std::uint8_t {
  kNoWorse,  // every objective has at most its value
  /// Some objective has less than its value, and those before it at most theirs: lexicographically
  /// less.
  kBetter,
};

/// The model with clauses that bound its objectives by `values`, in traces of the full horizon or,
/// where it has state constraints, up to a hit. The sum up to each timepoint is counted by a
/// generalized totalizer (Joshi, Martins and Manquinho 2015) in both directions, so that its atoms
/// are functions of the others. Nothing else is constrained: the result has the same traces as the
/// model within the bound.
///
/// None: the sums have too many possible values (more than `most_clauses` clauses).
std::optional<compiler::CompiledModel> with_bound(const compiler::CompiledModel& model,
                                                  std::span<const std::int64_t> values,
                                                  BoundKind kind,
                                                  std::size_t most_clauses = 2'000'000);

}  // namespace parallax::runtime
