// Predicate completion over ground formulas, pointwise (Lifschitz 1986).
//
// An axiom is noted while it is grounded: for each completed atom p that a conjunct G mentions
// positively, !G[p := false] is one reason for p. At the end every atom of a completed predicate
// implies the disjunction of its reasons; an atom without a reason is false. For axioms `body ->
// P(..)` this is predicate completion (Mueller 2006, Theorem 2.1); for a disjunction of
// completed events it makes them exclusive. Definitions over effects (`ECCausal`, `Clipped`)
// give no reasons.
//
// Reasons that hold at every timepoint are kept once, at timepoint 0. Where an atom has no other
// reasons its completion is written once for all timepoints, else timepoint by timepoint.
//
// Cost: one substitution into a conjunct for each completed atom that is positive in it, and one
// implication for each atom or, without a template, for each atom and timepoint.

#include "compiler/ground/completion.h"

#include <algorithm>

#include "compiler/formula/formula.h"
#include "compiler/ground/old_clauses.h"

namespace parallax::compiler {
namespace {

constexpr std::size_t kMaxInstances = 1'000'000;  // of one predicate that are made for completion

}  // namespace

CompletionWriter::CompletionWriter(GroundModel& model, Meaning meaning, bool lint)
    : model_(model), meaning_(meaning) {
  if (model.typed().options.founded && meaning == Meaning::kStandard) founded_.emplace();
  if (lint && meaning == Meaning::kStandard && !founded_) loops_.emplace(model);
  const auto& core = model.typed().core;
  for (const auto& completion : model.typed().completions) {
    auto kind = AtomKind::kPredicate;
    if (completion.predicate == core.happens) kind = AtomKind::kHappens;
    if (completion.predicate == core.holds_at) kind = AtomKind::kHoldsAt;
    if (completion.predicate == core.released_at) kind = AtomKind::kReleasedAt;
    entries_.push_back(
        {&completion, kind, model.add_origin(completion.source, OriginKind::kCompletion), {}});
  }
}

const CompletionWriter::Entry* CompletionWriter::first_entry(SymbolId predicate) const {
  for (const auto& entry : entries_) {
    if (entry.completion->predicate == predicate) return &entry;
  }
  return nullptr;
}

const Completion* CompletionWriter::completion_of(SymbolId predicate) const {
  const auto* entry = first_entry(predicate);
  return entry == nullptr ? nullptr : entry->completion;
}

bool CompletionWriter::completes(const Entry& entry, const GroundAtom& atom) const {
  if (entry.kind != atom.kind) return false;
  return atom.kind != AtomKind::kPredicate ||
         model_.terms()[GroundTermId(atom.index)].symbol == entry.completion->predicate;
}

bool CompletionWriter::note(const Axiom& axiom, FormulaId formula, Timepoint width,
                            const OpaqueEffects* effects) {
  if (entries_.empty()) return true;
  const bool old = meaning_ == Meaning::kDecreasoner;
  if (old && note_old_clauses(axiom, formula)) return true;
  auto& formulas = model_.formulas();
  bool any_reason = false;
  if (founded_) {
    for (const auto part : separate_conjuncts(formulas, formula)) {
      any_reason = note_conjunct(axiom, part, width, effects) || any_reason;
    }
  } else if (formulas.kind(formula) == FormulaNodeKind::kAnd && !formula.negated()) {
    const auto children = formulas.children(formula);
    const std::vector<FormulaId> parts(children.begin(), children.end());
    for (const auto part : parts) {
      any_reason = note_conjunct(axiom, part, width, effects) || any_reason;
    }
  } else {
    any_reason = note_conjunct(axiom, formula, width, effects);
  }
  return !old || !any_reason;
}

/// The 2005 reasoner asks of each clause with the atom what its other literals leave as a reason;
/// a clause of the atom alone is a fact. False: it would name parts of the formula.
bool CompletionWriter::note_old_clauses(const Axiom& axiom, FormulaId formula) {
  if (model_.formulas().kind(formula) == FormulaNodeKind::kTrue) return true;
  const auto form = old_clause_form(model_.formulas(), formula);
  if (form.named) return false;
  for (const auto& clause : form.clauses) {
    for (const auto literal : clause) {
      if (literal.negated()) continue;
      const auto atom = model_.atom(model_.formulas().variable(literal));
      for (auto& entry : entries_) {
        const auto& wanted = entry.completion->label;
        if (!completes(entry, atom) || (wanted && *wanted != axiom.label)) continue;
        std::vector<FormulaId> others;
        for (const auto other : clause) {
          if (other != literal) others.push_back(~other);
        }
        const auto reason = model_.formulas().conjunction(std::move(others));
        note_reason(atom, reason, Constraint::kOnce, axiom.source, entry);
      }
    }
  }
  return true;
}

bool CompletionWriter::note_conjunct(const Axiom& axiom, FormulaId formula, Timepoint width,
                                     const OpaqueEffects* effects) {
  bool any_reason = false;
  for (const auto variable : positive_atoms(model_.formulas(), formula)) {
    const auto atom = model_.atom(variable);
    for (auto& entry : entries_) {
      const auto& wanted = entry.completion->label;
      if (!completes(entry, atom) || (wanted && *wanted != axiom.label)) continue;
      const auto opposite = ~substitute(model_.formulas(), formula, variable, false);
      const auto reason = effects == nullptr ? opposite : effects->resolved(opposite);
      note_reason(atom, reason, width, axiom.source, entry);
      if (loops_) loops_->add(atom, reason, width, axiom.source);
      any_reason = true;
    }
  }
  return any_reason;
}

void CompletionWriter::note_reason(const GroundAtom& atom, FormulaId reason, Timepoint width,
                                   const base::SourceRange& source, Entry& entry) {
  auto& reasons = entry.reasons[{atom.kind, atom.index}];
  const auto note = [&](FormulaId said, std::vector<FormulaId>& list) {
    list.push_back(said);
    if (founded_) founded_->try_emplace({atom.kind, atom.index, said.bits()}, source);
  };
  if (width == Constraint::kOnce) return note(reason, reasons.single[atom.time]);
  if (atom.time == 0 && width == (atom.kind == AtomKind::kHappens ? 1 : 0)) {
    return note(reason, reasons.always);
  }
  for (Timepoint s = 0; s + width <= model_.horizon(); ++s) {
    const auto t = atom.time == GroundAtom::kUntimed ? atom.time : atom.time + s;
    note(model_.shifted(reason, s), reasons.single[t]);
  }
}

std::vector<CompletionWriter::Occurrence> CompletionWriter::occurrences() const {
  std::vector<Occurrence> found;
  const auto truth = model_.formulas().truth();
  const auto& happens = model_.typed().core.happens;
  const auto* entry = happens ? first_entry(*happens) : nullptr;
  if (entry == nullptr) return found;
  for (const auto& [key, reasons] : entry->reasons) {
    for (const auto& [t, list] : reasons.single) {
      const bool certain = std::find(list.begin(), list.end(), truth) != list.end();
      found.push_back({key.second, t, certain});
    }
  }
  return found;
}

FormulaId CompletionWriter::reason(const GroundAtom& atom) const {
  const auto* entry = first_entry(model_.terms()[GroundTermId(atom.index)].symbol);
  if (entry == nullptr) return model_.formulas().falsity();
  const auto found = entry->reasons.find({atom.kind, atom.index});
  if (found == entry->reasons.end()) return model_.formulas().falsity();
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

void CompletionWriter::report_loops(base::DiagnosticSink& sink) {
  if (!loops_) return;
  // With several completions an atom needs several reasons at once.
  loops_->report(
      [&](const GroundAtom& atom) {
        return std::count_if(entries_.begin(), entries_.end(),
                             [&](const Entry& entry) { return completes(entry, atom); }) == 1;
      },
      sink);
}

void CompletionWriter::write(std::size_t max_nodes, base::DiagnosticSink& sink) {
  for (auto& entry : entries_) {
    if (entry.kind == AtomKind::kPredicate) {
      write_predicates(entry);
    } else {
      write_timed(entry);
    }
  }
  if (founded_) write_founded(max_nodes, sink);
}

void CompletionWriter::write_founded(std::size_t max_nodes, base::DiagnosticSink& sink) {
  FoundedReasons founded(model_, *founded_, max_nodes, sink);
  for (const auto& entry : entries_) {
    for (const auto& [key, reasons] : entry.reasons) {
      const auto [kind, index] = key;
      if (may_be_true(kind, index)) founded.add(kind, index, reasons, entry.origin);
    }
  }
  founded.write();
}

bool CompletionWriter::may_be_true(AtomKind kind, std::uint32_t index) const {
  if (kind == AtomKind::kHappens) return model_.may_happen(index);
  if (kind == AtomKind::kHoldsAt) return model_.may_hold(index);
  return kind != AtomKind::kReleasedAt || model_.can_be_released(index);
}

/// Every ground atom of a completed predicate is completed, also those that no axiom mentions.
void CompletionWriter::write_timed(Entry& entry) {
  const bool is_event = entry.kind == AtomKind::kHappens;
  const Timepoint width = is_event ? 1 : 0;
  const auto atom = [&](std::uint32_t index, Timepoint t) {
    if (is_event) return model_.happens(index, t);
    return entry.kind == AtomKind::kHoldsAt ? model_.holds(index, t) : model_.released(index, t);
  };
  if (width > model_.horizon() && meaning_ == Meaning::kStandard) return;
  const auto count = is_event ? model_.events().size() : model_.fluents().size();
  for (std::uint32_t index = 0; index < count; ++index) {
    if (!may_be_true(entry.kind, index)) continue;
    auto& reasons = entry.reasons[{entry.kind, index}];
    if (reasons.single.empty() && meaning_ == Meaning::kStandard) {
      assert_completed(atom(index, 0), reasons.always, entry.origin, width);
      continue;
    }
    for (Timepoint t = 0; t + width <= model_.horizon(); ++t) {
      auto here = reasons.single[t];
      for (const auto reason : reasons.always) here.push_back(model_.shifted(reason, t));
      assert_completed(atom(index, t), std::move(here), entry.origin, Constraint::kOnce);
    }
    if (!is_event || meaning_ == Meaning::kStandard) continue;
    if (const auto last = model_.find_happens_last(index)) {
      assert_completed(*last, reasons.single[model_.horizon()], entry.origin, Constraint::kOnce);
    }
  }
}

/// The 2005 reasoner completes a predicate over all arguments, not just where a formula mentions
/// it.
void CompletionWriter::mention_all_instances(SymbolId predicate) {
  const auto& sorts = model_.typed().symbols[predicate].arguments;
  std::vector<const std::vector<GroundTermId>*> domains;
  std::size_t count = 1;
  for (const auto sort : sorts) {
    domains.push_back(&model_.universe().domain(sort));
    if (domains.back()->empty() || count > kMaxInstances / domains.back()->size()) return;
    count *= domains.back()->size();
  }
  std::vector<GroundTermId> arguments;
  for (std::size_t number = 0; number < count; ++number) {
    arguments.clear();
    auto rest = number;
    for (const auto* domain : domains) {
      arguments.push_back((*domain)[rest % domain->size()]);
      rest /= domain->size();
    }
    (void)model_.predicate(model_.terms().apply(predicate, arguments));
  }
}

void CompletionWriter::write_predicates(Entry& entry) {
  if (meaning_ == Meaning::kDecreasoner) mention_all_instances(entry.completion->predicate);
  // The atoms of user predicates exist where some formula mentions them.
  for (std::size_t i = 0; i < model_.atom_count(); ++i) {
    const auto variable = static_cast<std::int32_t>(i + 1);
    const auto atom = model_.atom(variable);
    if (!completes(entry, atom)) continue;
    auto& reasons = entry.reasons[{atom.kind, atom.index}];
    assert_completed(model_.formulas().atom(variable), reasons.single[GroundAtom::kUntimed],
                     entry.origin, Constraint::kOnce);
  }
  model_.close_predicate(entry.completion->predicate);
}

}  // namespace parallax::compiler
