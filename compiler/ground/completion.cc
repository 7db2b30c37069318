#include "compiler/ground/completion.h"

#include <algorithm>

#include "compiler/formula/atoms.h"
#include "compiler/formula/substitute.h"

namespace parallax::compiler {

CompletionWriter::CompletionWriter(GroundModel& model, Meaning meaning)
    : model_(model), meaning_(meaning) {
  for (const auto& completion : model.typed().completions) {
    origins_.push_back(model.add_origin(completion.source, "completion"));
  }
  if (!origins_.empty()) prepare();
}

/// Every ground atom of a completed predicate is completed, also those that no axiom mentions.
void CompletionWriter::prepare() {
  const auto& typed = model_.typed();
  for (std::size_t c = 0; c < typed.completions.size(); ++c) {
    const auto predicate = typed.completions[c].predicate;
    if (predicate == typed.core.happens) {
      for (Timepoint t = 0; t < model_.horizon(); ++t) {
        for (std::uint32_t e = 0; e < model_.events().size(); ++e) {
          completed_[model_.formulas().variable(model_.happens(e, t))].completion = c;
        }
      }
    } else if (predicate == typed.core.holds_at) {
      for (Timepoint t = 0; t <= model_.horizon(); ++t) {
        for (std::uint32_t f = 0; f < model_.fluents().size(); ++f) {
          completed_[model_.formulas().variable(model_.holds(f, t))].completion = c;
        }
      }
    }
  }
}

bool CompletionWriter::applies(std::size_t completion, const std::string& label) const {
  const auto& wanted = model_.typed().completions[completion].label;
  return !wanted || *wanted == label;
}

void CompletionWriter::note(const std::string& label, FormulaId formula) {
  if (origins_.empty()) return;
  const auto& formulas = model_.formulas();
  if (formulas.kind(formula) == FormulaNodeKind::kAnd && !formula.negated()) {
    const auto children = formulas.children(formula);
    const std::vector<FormulaId> parts(children.begin(), children.end());
    for (const auto part : parts) note_conjunct(label, part);
  } else {
    note_conjunct(label, formula);
  }
}

void CompletionWriter::note_conjunct(const std::string& label, FormulaId formula) {
  const auto& typed = model_.typed();
  for (const auto variable : positive_atoms(model_.formulas(), formula)) {
    const auto& atom = model_.atoms()[static_cast<std::size_t>(variable) - 1];
    auto found = completed_.find(variable);
    if (found == completed_.end()) {
      // A user predicate's atoms are made when they are first mentioned.
      if (atom.kind != AtomKind::kPredicate) continue;
      const auto symbol = typed.find_symbol(atom.name.substr(0, atom.name.find('(')));
      for (std::size_t c = 0; c < typed.completions.size(); ++c) {
        if (symbol && typed.completions[c].predicate == *symbol) {
          found = completed_.emplace(variable, Completed{c, {}}).first;
        }
      }
      if (found == completed_.end()) continue;
    }
    if (!applies(found->second.completion, label)) continue;
    found->second.reasons.push_back(~substitute(model_.formulas(), formula, variable, false));
  }
}

/// A fact counts only where there are no rules.
void CompletionWriter::drop_facts(std::vector<FormulaId>& reasons) const {
  const auto truth = model_.formulas().truth();
  const bool all_facts = std::all_of(reasons.begin(), reasons.end(),
                                     [&](FormulaId reason) { return reason == truth; });
  if (!all_facts) std::erase(reasons, truth);
}

void CompletionWriter::write() {
  if (origins_.empty()) return;
  const auto& typed = model_.typed();
  // Atoms that only occur negatively have no reason at all.
  for (std::size_t i = 0; i < model_.atoms().size(); ++i) {
    const auto& atom = model_.atoms()[i];
    if (atom.kind != AtomKind::kPredicate) continue;
    const auto symbol = typed.find_symbol(atom.name.substr(0, atom.name.find('(')));
    for (std::size_t c = 0; c < typed.completions.size(); ++c) {
      if (symbol && typed.completions[c].predicate == *symbol) {
        completed_.emplace(static_cast<std::int32_t>(i + 1), Completed{c, {}});
      }
    }
  }
  for (auto& [variable, completed] : completed_) {
    auto& formulas = model_.formulas();
    if (meaning_ == Meaning::kDecreasoner) drop_facts(completed.reasons);
    const auto reason = formulas.disjunction(std::move(completed.reasons));
    model_.require(formulas.implication(formulas.atom(variable), reason),
                   origins_[completed.completion]);
  }
}

}  // namespace parallax::compiler
