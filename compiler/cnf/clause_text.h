#pragma once

#include <string>

#include "compiler/artifact/compiled_model.h"
#include "compiler/base/source_file.h"
#include "compiler/cnf/clause_builder.h"

namespace parallax::compiler {

// Values between the passes of the encoding, for people. `files` may be null: then without places.

/// The clauses over atoms and auxiliaries, `m.e:5 axiom: !Happens(E(),0) #3`, those that hold once
/// before those of each width.
std::string clause_lines(const GroundModel& model, const ClauseBuilder& clauses,
                         const base::SourceFiles* files);

/// What has which place: of the slots, then of the fixed variables. Unused places are left out.
std::string place_lines(const CompiledModel& model);

/// The clauses as numbers, a heading for each section; of one that is repeated the first block.
std::string numbered_lines(const CompiledModel& model, const base::SourceFiles* files);

}  // namespace parallax::compiler
