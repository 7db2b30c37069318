#pragma once

#include <string>

#include "compiler/artifact/compiled_model.h"
#include "compiler/base/source_file.h"

namespace parallax::compiler {

/// The model as DIMACS that any SAT solver reads, at its full horizon. Comment lines before the
/// header say what each variable is (`c dec atom 17 HoldsAt RobotIn(r1) 3`) and which clauses an
/// axiom gave (`c dec origin 18..20 axiom domain.e:41:1-42:30`); `c p show` names the observable
/// variables. Byte-stable for equal models.
std::string to_dimacs(const CompiledModel& model, const base::SourceFiles& files);

}  // namespace parallax::compiler
