#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compiler/asp/term_writer.h"
#include "compiler/base/diagnostic.h"
#include "compiler/base/result.h"
#include "compiler/base/source_file.h"
#include "compiler/sema/typed_model.h"

namespace parallax::compiler {

struct AspOptions {
  /// Adds `axiom_exists(N)` for every axiom (numbered from 0 in source order) that says something:
  /// an axiom without the atom lies outside the timepoints altogether.
  bool report_existence = false;
  /// The atoms of user predicates that tell traces apart, printed as in traces; all others are
  /// false, as long as `horizon` is the model's. None: every atom of a predicate may be true.
  std::optional<std::vector<std::string>> open_atoms = std::nullopt;
};

/// A program for clingo 5, and the way back from its names.
struct AspProgram {
  std::string text;
  AspNames names;
};

/// Does the model declare predicates beside those of the event calculus? Only then there are atoms
/// to be open or not.
bool has_user_predicates(const TypedModel& model);

/// The typed model as a logic program. Its answer sets, restricted to the shown atoms, are the
/// models in the standard meaning: over holds_at(F,T), happens(E,T), released_at(F,T) and the
/// user's predicates. `#project` names holds_at and happens: with `--project=project` each
/// observable trace is found once.
///
/// Made from the typed model alone, by rules over the sorts; clingo does all grounding. Whether an
/// instance exists does not depend on a trace, so existence is a matter of positive body literals:
/// membership in sorts, `step(T)` for timepoints that have a successor, look-ups in the tables of
/// functions, and `exists_N(..)` for quantifiers that can be without an instance. DEC3 to DEC12 as
/// in Mueller 2006, section 2.7; completion as pointwise circumscription (Lifschitz 1986).
///
/// Integers that clingo cannot hold (beyond 32 bits) are reported (kAspNumber). What clingo
/// computes from smaller ones wraps. Linear in the model's size; no recursion.
base::Result<AspProgram> to_asp(const TypedModel& model, const base::SourceFiles& files,
                                const AspOptions& options, base::DiagnosticSink& sink);

}  // namespace parallax::compiler
