#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "compiler/ground/founded_reasons.h"
#include "compiler/ground/ground_model.h"
#include "compiler/ground/opaque_effects.h"
#include "compiler/ground/support_loops.h"

namespace parallax::compiler {

/// Predicate completion over ground formulas. A completed atom is true only where some formula of
/// the completion's label would be false without it: for each such formula G in which the atom p
/// occurs positively, not G[p := false] is a reason for p, and p implies one of its reasons
/// (pointwise circumscription, Lifschitz 1986; for axioms of the form `body -> P(..)` this is the
/// predicate completion of Mueller 2006, Theorem 2.1, and for a disjunction of two completed
/// events it makes them exclusive). A predicate with several completions needs a reason for each.
/// In the 2005 reasoner's meaning the formulas are the clauses that it makes of them. With
/// `option founded on` reasons may not go in circles (FoundedReasons).
class CompletionWriter {
 public:
  /// `lint`: atoms that are reasons of themselves are sought as well.
  CompletionWriter(GroundModel& model, Meaning meaning, bool lint);
  /// Notes what an axiom, with its label (empty without one), says: a formula that holds once, or,
  /// with a width, at every timepoint as GroundModel::require_always has it. Call for every axiom.
  /// `effects`: what atoms in the formula stand for effects, if it mentions any. False: the 2005
  /// reasoner completes over clauses that are not made here, and with less effect.
  bool note(const Axiom& axiom, FormulaId formula, Timepoint width,
            const OpaqueEffects* effects = nullptr);
  /// Warns of completed atoms that are reasons of each other. To be called once, before `write`.
  void report_loops(base::DiagnosticSink& sink);
  /// Does the model complete anything?
  bool has_completions() const { return !entries_.empty(); }
  /// The first completion of a predicate, if it has one.
  const Completion* completion_of(SymbolId predicate) const;
  /// The occurrences (event, timepoint) that the axioms noted so far give a reason for under the
  /// first completion; `certain`: those that are facts.
  struct Occurrence {
    std::uint32_t event = 0;
    Timepoint time = 0;
    bool certain = false;
  };
  std::vector<Occurrence> occurrences() const;
  /// The disjunction of the reasons noted so far for a user predicate's atom, under the first
  /// completion.
  FormulaId reason(const GroundAtom& atom) const;
  /// Asserts the completions: false for atoms without a reason, also those of user predicates that
  /// are first mentioned later. `max_nodes`: the formulas that a circle of founded atoms may take.
  void write(std::size_t max_nodes, base::DiagnosticSink& sink);

 private:
  /// A completion with its reasons, by kind and index of the atom.
  struct Entry {
    const Completion* completion = nullptr;
    AtomKind kind = AtomKind::kPredicate;
    std::uint32_t origin = 0;
    std::map<std::pair<AtomKind, std::uint32_t>, AtomReasons> reasons;
  };

  bool completes(const Entry& entry, const GroundAtom& atom) const;
  bool may_be_true(AtomKind kind, std::uint32_t index) const;
  const Entry* first_entry(SymbolId predicate) const;
  bool note_conjunct(const Axiom& axiom, FormulaId formula, Timepoint width,
                     const OpaqueEffects* effects);
  bool note_old_clauses(const Axiom& axiom, FormulaId formula);
  void note_reason(const GroundAtom& atom, FormulaId reason, Timepoint width,
                   const base::SourceRange& source, Entry& entry);
  void write_timed(Entry& entry);
  void mention_all_instances(SymbolId predicate);
  void write_predicates(Entry& entry);
  void write_founded(std::size_t max_nodes, base::DiagnosticSink& sink);
  void assert_completed(FormulaId atom, std::vector<FormulaId> reasons, std::uint32_t origin,
                        Timepoint width);

  GroundModel& model_;
  Meaning meaning_;
  std::vector<Entry> entries_;  // in the order of the model
  std::optional<SupportLoops> loops_;
  std::optional<FoundedReasons::Sources> founded_;  // the axioms of reasons, if they are founded
};

}  // namespace parallax::compiler
