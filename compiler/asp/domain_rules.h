#pragma once

#include <string>

#include "compiler/asp/names.h"
#include "compiler/asp/term_writer.h"
#include "compiler/sema/typed_model.h"

namespace parallax::compiler {

/// Facts and rules for the elements of every sort, the tables of functions, the properties of
/// fluents. Timepoints go from 0 to the constant `horizon`, which `clingo -c horizon=N` replaces.
std::string domain_rules(const TypedModel& model, const AspNames& names, TermWriter& terms);

/// The atoms that may be true: HoldsAt, Happens, ReleasedAt, user predicates.
std::string choice_rules(const TypedModel& model, const AspNames& names, TermWriter& terms);

/// DEC5 to DEC12 over initiates, terminates and releases; the auxiliaries of DEC3 and DEC4 if the
/// model has trajectories.
std::string calculus_rules(const TypedModel& model);

}  // namespace parallax::compiler
