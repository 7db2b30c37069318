#pragma once

#include <cstddef>
#include <optional>

#include "compiler/artifact/compiled_model.h"

namespace parallax::runtime {

using compiler::CompiledModel;

/// The model with a fixed variable for each atom that a clause looks back at from beyond the next
/// timepoint: the variable has the atom's value, and stands in such clauses instead of it, so that
/// all clauses look at two neighbouring timepoints. The copy is valid only in its variables,
/// clauses and their origins. None: there is no such clause, or there are more than `most` such
/// atoms. Linear in the clauses.
std::optional<CompiledModel> with_far_atoms_fixed(const CompiledModel& model, std::size_t most);

/// Whether a clause ties atoms together that lie more than one timepoint apart.
bool looks_far(const CompiledModel& model);

}  // namespace parallax::runtime
