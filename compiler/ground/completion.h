#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "compiler/ground/ground_model.h"

namespace parallax::compiler {

/// Predicate completion over ground formulas. A completed atom is true only where some formula of
/// the completion's label would be false without it: for each such formula G in which the atom p
/// occurs positively, not G[p := false] is a reason for p, and p implies one of its reasons
/// (pointwise circumscription, Lifschitz 1986; for axioms of the form `body -> P(..)` this is the
/// predicate completion of Mueller 2006, Theorem 2.1, and for a disjunction of two completed
/// events it makes them exclusive).
class CompletionWriter {
 public:
  CompletionWriter(GroundModel& model, Meaning meaning);
  /// Notes an axiom with this label (empty without one): a formula that holds once, or, with a
  /// width, at every timepoint as GroundModel::require_always has it. Call for every axiom.
  void note(const std::string& label, FormulaId formula, Timepoint width);
  /// The completion of a predicate, if it has one.
  const Completion* completion_of(SymbolId predicate) const;
  /// The occurrences (event, timepoint) that the axioms noted so far give a reason for; `certain`:
  /// those that are facts.
  struct Occurrence {
    std::uint32_t event = 0;
    Timepoint time = 0;
    bool certain = false;
  };
  std::vector<Occurrence> occurrences() const;
  /// The disjunction of the reasons noted so far for a user predicate's atom.
  FormulaId reason(const GroundAtom& atom) const;
  /// Asserts the completions: false for atoms without a reason.
  void write();

 private:
  /// The reasons of one event, fluent or user predicate.
  struct Reasons {
    std::vector<FormulaId> always;  // at timepoint 0, valid for all
    std::map<Timepoint, std::vector<FormulaId>> single;
  };
  using Key = std::pair<AtomKind, std::uint32_t>;

  void note_conjunct(const std::string& label, FormulaId formula, Timepoint width);
  void note_reason(const GroundAtom& atom, FormulaId reason, Timepoint width);
  const Completion* completion_of(const GroundAtom& atom) const;
  void write_timed(AtomKind kind, std::uint32_t count, std::uint32_t origin);
  void write_predicates();
  void assert_completed(FormulaId atom, std::vector<FormulaId> reasons, std::uint32_t origin,
                        Timepoint width);

  GroundModel& model_;
  Meaning meaning_;
  std::map<SymbolId, const Completion*> completions_;  // by predicate
  std::map<SymbolId, std::uint32_t> origins_;          // by predicate
  std::map<Key, Reasons> reasons_;
};

}  // namespace parallax::compiler
