#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "compiler/artifact/compiled_model.h"

namespace parallax::compiler {

struct ArtifactOptions {
  /// Write `c t pmc` and, after the header, `c p show VARIABLES 0`.
  bool projection_line = true;
};

/// The model as DIMACS that any SAT solver reads and that `read_artifact` turns into an equal model
/// (docs/reference/formats.md). Equal models give equal bytes. No line depends on how many clauses,
/// axioms or source lines come before what it says, so that the difference of two files is the
/// difference of the models.
///
/// The caller owes: sections cover the clauses; the copies of a repeated section are its first one
/// moved, with equal origins and flags; origins have ids (describe_sources); the slots of fluents,
/// releases and events carry their kinds and names. Linear in the size of the text.
std::string to_artifact(const CompiledModel& model, const ArtifactOptions& options = {});

/// The same bytes piece by piece. A folded model gives those of the model with all copies. The
/// clauses are traversed twice, since the hash of all lines comes before them. Memory: the model
/// and one piece.
void write_artifact(const CompiledModel& model, const ArtifactOptions& options,
                    const std::function<void(std::string_view)>& take);

/// The file name ends in `.cnf`: the program reads it as a compiled model, not as a domain file.
bool is_artifact_name(std::string_view name);

}  // namespace parallax::compiler
