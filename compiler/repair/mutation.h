#pragma once

#include <string>
#include <vector>

#include "compiler/repair/axiom_form.h"
#include "compiler/repair/plan_text.h"
#include "compiler/sema/typed_model.h"

namespace parallax::compiler {

/// A single mistake in a text, as people make them: what repairs undo, the other way round.
struct Mutation {
  std::string kind;      // "condition dropped"
  std::string words;     // a sentence without its period, with the place
  base::SourceRange at;  // what is changed
  std::vector<TextChange> changes;
  /// Of an effect or a precondition, not negated: a mistake of which `repair` knows the opposite.
  bool is_repairable = false;
};

/// Every single mistake of a model's own axioms, in the order of the text. Of effects and
/// preconditions: dropped, a condition dropped, negated, added or with exchanged variables, the
/// other sign, exchanged variables, another fluent. Of other axioms: dropped, a condition of an
/// implication dropped or negated, a fact negated. What can be seen to say the same is left out.
std::vector<Mutation> model_mutations(const ModelAst& model, const TypedModel& typed,
                                      const base::SourceFiles& files);

/// Every single mistake of a plan: a perform or a call dropped, two that follow each other
/// exchanged, a guard (`when`, `unless`) or a handler dropped, arguments of a call exchanged, an
/// argument or a value of a designator that is another one of the plan's.
std::vector<Mutation> plan_mutations(const PlanText& plan);

}  // namespace parallax::compiler
