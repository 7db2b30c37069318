#include "compiler/repair/edit_grammar.h"

#include <utility>

#include "compiler/base/ground_name.h"
#include "compiler/repair/delayed_effect.h"
#include "compiler/repair/edit_subject.h"
#include "compiler/repair/effect_bundle.h"

namespace parallax::compiler {

namespace {

EditSubject subject_of(const ModelAst& model, const TypedModel& typed,
                       const std::vector<AxiomForm>& forms, const EditScope& scope) {
  EditSubject out{model,
                  typed,
                  forms,
                  scope,
                  EditRelevance(model, forms, scope),
                  scope.more_events,
                  scope.more_fluents};
  for (const auto& step : scope.steps) {
    out.events.insert(base::symbol_of(step.event));
    for (const auto& [fluent, holds] : step.differing) out.fluents.insert(base::symbol_of(fluent));
  }
  return out;
}

}  // namespace

std::vector<std::string> arguments_of(const std::string& ground) {
  std::vector<std::string> out;
  const auto open = ground.find('(');
  if (open == std::string::npos || open + 2 >= ground.size()) return out;
  int depth = 0;
  std::string current;
  for (std::size_t i = open + 1; i + 1 < ground.size(); ++i) {
    const char c = ground[i];
    if (c == '(') ++depth;
    if (c == ')') --depth;
    if (c == ',' && depth == 0) {
      out.push_back(std::move(current));
      current.clear();
    } else {
      current += c;
    }
  }
  out.push_back(std::move(current));
  return out;
}

std::vector<Edit> edits_in_scope(const ModelAst& model, const TypedModel& typed,
                                 const std::vector<AxiomForm>& forms, const EditScope& scope) {
  const auto subject = subject_of(model, typed, forms, scope);
  std::vector<Edit> out;
  if (scope.alternatives) {
    add_alternatives(subject, out);
    return out;
  }
  add_axiom_edits(subject, out);
  add_event_edits(subject, out);
  add_delays(model, typed, forms, scope, out);
  add_effect_bundles(model, typed, forms, scope, out);
  return out;
}

}  // namespace parallax::compiler
