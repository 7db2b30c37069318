#pragma once

#include <string>
#include <vector>

#include "compiler/repair/axiom_form.h"
#include "compiler/repair/plan_text.h"
#include "compiler/sema/typed_model.h"

namespace parallax::compiler {

/// A single mistake in a text, as people make them: the reverse of a repair.
struct Mutation {
  std::string kind;      // "condition dropped"
  std::string words;     // a sentence without its period, with the place
  base::SourceRange at;  // the text that is changed
  std::vector<TextChange> changes;
  /// True for an effect or a precondition, not negated: `repair` knows the reverse edit.
  bool is_repairable = false;
};

/// Every single mistake of a model's own axioms, in the order of the text. For effects and
/// preconditions: dropped, a condition dropped, negated, added or with exchanged variables, the
/// other sign, exchanged variables, another fluent. For other axioms: dropped, a condition of an
/// implication dropped or negated, a fact negated. Mutants that are visibly equivalent are left
/// out.
std::vector<Mutation> model_mutations(const ModelAst& model, const TypedModel& typed,
                                      const base::SourceFiles& files);

/// Every single mistake of a plan: a perform or a call dropped, two that follow each other
/// exchanged, a guard (`when`, `unless`) or a handler dropped, arguments of a call exchanged, an
/// argument or a value of a designator that is another one of the plan's.
std::vector<Mutation> plan_mutations(const PlanText& plan);

}  // namespace parallax::compiler
