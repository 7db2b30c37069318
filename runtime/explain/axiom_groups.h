#pragma once

#include <cstdint>
#include <vector>

#include "compiler/artifact/compiled_model.h"

namespace parallax::runtime {

/// The origins of a model put together by the text they stand for: what an explanation names is a
/// place in a source file. State invariants belong to no group: they follow from the others.
struct AxiomGroups {
  static constexpr std::uint32_t kNone = UINT32_MAX;
  std::vector<std::vector<std::uint32_t>> origins;  // by group, ascending; groups in source order
  std::vector<std::uint32_t> group_of;              // by origin; kNone: of no group
  std::size_t size() const { return origins.size(); }
};

/// Groups the origins that have clauses.
AxiomGroups group_axioms(const compiler::CompiledModel& model);

}  // namespace parallax::runtime
