#include "compiler/ground/completion.h"

#include <algorithm>
#include <optional>

#include "compiler/formula/atoms.h"
#include "compiler/formula/substitute.h"

namespace parallax::compiler {

CompletionWriter::CompletionWriter(GroundModel& model, Meaning meaning)
    : model_(model), meaning_(meaning) {
  for (const auto& completion : model.typed().completions) {
    completions_[completion.predicate] = &completion;
    origins_[completion.predicate] = model.add_origin(completion.source, "completion");
  }
}

const Completion* CompletionWriter::completion_of(SymbolId predicate) const {
  const auto found = completions_.find(predicate);
  return found == completions_.end() ? nullptr : found->second;
}

const Completion* CompletionWriter::completion_of(const GroundAtom& atom) const {
  const auto& core = model_.typed().core;
  if (atom.kind == AtomKind::kHappens && core.happens) return completion_of(*core.happens);
  if (atom.kind == AtomKind::kHoldsAt && core.holds_at) return completion_of(*core.holds_at);
  if (atom.kind != AtomKind::kPredicate) return nullptr;
  return completion_of(model_.terms()[GroundTermId(atom.index)].symbol);
}

void CompletionWriter::note(const std::string& label, FormulaId formula, Timepoint width) {
  if (completions_.empty()) return;
  const auto& formulas = model_.formulas();
  if (formulas.kind(formula) == FormulaNodeKind::kAnd && !formula.negated()) {
    const auto children = formulas.children(formula);
    const std::vector<FormulaId> parts(children.begin(), children.end());
    for (const auto part : parts) note_conjunct(label, part, width);
  } else {
    note_conjunct(label, formula, width);
  }
}

void CompletionWriter::note_conjunct(const std::string& label, FormulaId formula, Timepoint width) {
  for (const auto variable : positive_atoms(model_.formulas(), formula)) {
    const auto atom = model_.atom(variable);
    const auto* completion = completion_of(atom);
    if (completion == nullptr || (completion->label && *completion->label != label)) continue;
    note_reason(atom, ~substitute(model_.formulas(), formula, variable, false), width);
  }
}

void CompletionWriter::note_reason(const GroundAtom& atom, FormulaId reason, Timepoint width) {
  auto& reasons = reasons_[{atom.kind, atom.index}];
  if (width == Constraint::kOnce) {
    reasons.single[atom.time].push_back(reason);
    return;
  }
  const Timepoint own_width = atom.kind == AtomKind::kHappens ? 1 : 0;
  if (atom.time == 0 && width == own_width) {
    reasons.always.push_back(reason);
    return;
  }
  for (Timepoint s = 0; s + width <= model_.horizon(); ++s) {
    const auto t = atom.time == GroundAtom::kUntimed ? atom.time : atom.time + s;
    reasons.single[t].push_back(model_.shifted(reason, s));
  }
}

std::vector<CompletionWriter::Occurrence> CompletionWriter::occurrences() const {
  std::vector<Occurrence> found;
  const auto truth = model_.formulas().truth();
  for (const auto& [key, reasons] : reasons_) {
    if (key.first != AtomKind::kHappens) continue;
    for (const auto& [t, list] : reasons.single) {
      const bool certain = std::find(list.begin(), list.end(), truth) != list.end();
      found.push_back({key.second, t, certain});
    }
  }
  return found;
}

FormulaId CompletionWriter::reason(const GroundAtom& atom) const {
  const auto found = reasons_.find({atom.kind, atom.index});
  if (found == reasons_.end()) return model_.formulas().falsity();
  const auto single = found->second.single.find(GroundAtom::kUntimed);
  if (single == found->second.single.end()) return model_.formulas().falsity();
  return model_.formulas().disjunction(single->second);
}

/// In the 2005 reasoner's meaning a fact counts only where there are no rules.
void CompletionWriter::assert_completed(FormulaId atom, std::vector<FormulaId> reasons,
                                        std::uint32_t origin, Timepoint width) {
  auto& formulas = model_.formulas();
  const auto truth = formulas.truth();
  const bool all_facts = std::all_of(reasons.begin(), reasons.end(),
                                     [&](FormulaId reason) { return reason == truth; });
  if (meaning_ == Meaning::kDecreasoner && !all_facts) std::erase(reasons, truth);
  const auto completed = formulas.implication(atom, formulas.disjunction(std::move(reasons)));
  if (width == Constraint::kOnce) {
    model_.require(completed, origin);
  } else {
    model_.require_always(completed, origin, width);
  }
}

void CompletionWriter::write() {
  const auto& core = model_.typed().core;
  if (core.happens && completion_of(*core.happens) != nullptr && model_.horizon() > 0) {
    write_timed(AtomKind::kHappens, static_cast<std::uint32_t>(model_.events().size()),
                origins_.at(*core.happens));
  }
  if (core.holds_at && completion_of(*core.holds_at) != nullptr) {
    write_timed(AtomKind::kHoldsAt, static_cast<std::uint32_t>(model_.fluents().size()),
                origins_.at(*core.holds_at));
  }
  write_predicates();
}

/// Every ground atom of a completed predicate is completed, also those that no axiom mentions.
void CompletionWriter::write_timed(AtomKind kind, std::uint32_t count, std::uint32_t origin) {
  const bool is_event = kind == AtomKind::kHappens;
  const Timepoint width = is_event ? 1 : 0;
  const auto atom = [&](std::uint32_t index, Timepoint t) {
    return is_event ? model_.happens(index, t) : model_.holds(index, t);
  };
  for (std::uint32_t index = 0; index < count; ++index) {
    if (is_event ? !model_.may_happen(index) : !model_.may_hold(index)) continue;
    auto& reasons = reasons_[{kind, index}];
    if (reasons.single.empty() && meaning_ == Meaning::kStandard) {
      assert_completed(atom(index, 0), reasons.always, origin, width);
      continue;
    }
    for (Timepoint t = 0; t + width <= model_.horizon(); ++t) {
      auto here = reasons.single[t];
      for (const auto reason : reasons.always) here.push_back(model_.shifted(reason, t));
      assert_completed(atom(index, t), std::move(here), origin, Constraint::kOnce);
    }
  }
}

void CompletionWriter::write_predicates() {
  // The atoms of user predicates exist where some formula mentions them.
  for (std::size_t i = 0; i < model_.atom_count(); ++i) {
    const auto variable = static_cast<std::int32_t>(i + 1);
    const auto atom = model_.atom(variable);
    if (atom.kind != AtomKind::kPredicate) continue;
    const auto symbol = model_.terms()[GroundTermId(atom.index)].symbol;
    if (completion_of(symbol) == nullptr) continue;
    auto& reasons = reasons_[{atom.kind, atom.index}];
    assert_completed(model_.formulas().atom(variable), reasons.single[GroundAtom::kUntimed],
                     origins_.at(symbol), Constraint::kOnce);
  }
}

}  // namespace parallax::compiler
