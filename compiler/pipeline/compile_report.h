#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "compiler/artifact/compiled_model.h"
#include "compiler/base/source_file.h"
#include "compiler/ground/ground_model.h"
#include "compiler/ground/pass.h"

namespace parallax::compiler {

/// Cost of one source text: an axiom, an effect axiom, the declaration of a fluent (its frame
/// axioms and invariants), a plan step, a state constraint.
struct AxiomCost {
  base::SourceRange source;
  std::string what;  // the kind of the origin, printed
  /// Instances of its atoms in a full expansion over all sorts, known before grounding; 0 where the
  /// text is no formula of the model. Saturates beyond 64 bits.
  std::uint64_t product = 0;
  std::int64_t instances = 0;  // those that the grounder looked at
  std::size_t clauses = 0, literals = 0;
};

/// One entry for each text, the most expensive first: by clauses, then instances, then place.
/// Linear in the model.
std::vector<AxiomCost> axiom_costs(const GroundModel& ground, const CompiledModel& compiled);

/// An aligned table with a line for each entry and one for the sum.
std::string cost_table(const std::vector<AxiomCost>& costs, const base::SourceFiles& files);
/// The same as a JSON array.
std::string cost_json(const std::vector<AxiomCost>& costs, const base::SourceFiles& files);

/// A line for each pass: wall-clock seconds and the size of the value afterwards.
std::string pass_table(const PassLog& log);
/// The same as a JSON array; the clock's values stand in fields named `timing`.
std::string pass_json(const PassLog& log);

}  // namespace parallax::compiler
