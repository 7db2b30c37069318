// Facts of timepoint 0 that a model lacks.
//
// For each fluent that differed there: the fact itself, `HoldsAt(F(a),0)`, and the fact of all
// fluents of the symbol, `[x] !HoldsAt(F(x),0)`, where all were seen alike. A fact stands behind
// the last formula about the start, or else behind the last axiom. Cost: linear in what differed.

#include <algorithm>
#include <string>
#include <vector>

#include "compiler/base/ground_name.h"
#include "compiler/repair/edit_subject.h"

namespace parallax::compiler {
namespace {

constexpr int kMissingFact = 4;  // a fact is rather wrong than forgotten

/// The form that a new fact stands behind; null: the model has none.
const AxiomForm* place_of_facts(const std::vector<AxiomForm>& forms) {
  const AxiomForm* out = forms.empty() ? nullptr : &forms.back();
  for (const auto& form : forms) {
    if (form.kind == AxiomForm::Kind::kStart) out = &form;
  }
  return out;
}

/// Were all fluents of the symbol seen with this value?
bool all_alike(const std::map<std::string, bool>& seen, const std::string& symbol, bool value) {
  return std::all_of(seen.begin(), seen.end(), [&](const auto& each) {
    return base::symbol_of(each.first) != symbol || each.second == value;
  });
}

}  // namespace

void add_start_facts(const EditSubject& subject, std::vector<Edit>& edits) {
  const auto* behind = place_of_facts(subject.forms);
  if (behind == nullptr) return;
  const auto file = subject.model.ast(behind->place).file();
  const auto add = [&](std::string text, int oddity) {
    Edit edit;
    edit.kind = Edit::Kind::kAddFact;
    edit.text = std::move(text);
    edit.change = {file, behind->end, behind->end, "\n" + edit.text};
    edit.oddity = oddity;
    const bool known = std::any_of(edits.begin(), edits.end(), [&](const Edit& other) {
      return other.kind == Edit::Kind::kAddFact && other.text == edit.text;
    });
    if (!known) edits.push_back(std::move(edit));
  };
  for (const auto& step : subject.scope.steps) {
    for (const auto& [fluent, holds] : step.differing) {
      const auto name = base::symbol_of(fluent);
      const auto symbol = subject.typed.find_symbol(name);
      if (!symbol || subject.typed.symbols[*symbol].kind != SymbolKind::kFluent) continue;
      const std::string sign = holds ? "" : "!";
      const auto& sorts = subject.typed.symbols[*symbol].arguments;
      if (!sorts.empty() && all_alike(step.after, name, holds)) {
        std::string list;
        for (const auto& variable : variables_for(subject.typed, sorts)) {
          list += (list.empty() ? "" : ",") + variable;
        }
        add("[" + list + "] " + sign + "HoldsAt(" + name + "(" + list + "),0).", kMissingFact);
      }
      add(sign + "HoldsAt(" + fluent + ",0).", kMissingFact + (sorts.empty() ? 0 : 1));
    }
  }
}

}  // namespace parallax::compiler
