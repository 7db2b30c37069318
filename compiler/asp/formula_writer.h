#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "compiler/asp/term_writer.h"

namespace parallax::compiler {

/// A formula as bodies of rules.
struct AspFormula {
  AspBody exists;                // true exactly if the formula exists; empty: always
  AspAlternatives alternatives;  // one of them is true exactly if the formula has the value asked
  /// Predicates that occur in auxiliary rules and so cannot be seen in the alternatives.
  std::set<SymbolId> hidden;
};

/// A ground atom that is taken for false, as variables: completion asks what would be otherwise.
struct AspPoint {
  SymbolId predicate;
  std::vector<std::string> arguments;
  AspBody domain;
};

/// Formulas of one axiom after another. Connectives become alternatives and conjunctions; where
/// these would multiply, and for quantifiers, auxiliary rules are written (`part_N`, `some_N`,
/// `fails_N`, `all_N`, `exists_N`). Size and time are linear in the formula. No negation stands
/// between a rule and an effect that the formula does not deny, so that effects that follow from
/// one another are the least ones.
class FormulaWriter {
 public:
  FormulaWriter(const TypedModel& model, AspNames& names, TermWriter& terms, std::string& rules);

  /// The formula with the value `wanted`. At `point` the atom there is taken for false.
  AspFormula write(TypedFormulaId formula, bool wanted, const AspPoint* point = nullptr);

  /// Atoms of user predicates over unbounded integers: they exist where a formula mentions them.
  const std::string& mentioned(SymbolId predicate);

 private:
  /// Result for a subformula that has been read.
  struct Part {
    AspBody exists;
    AspAlternatives when_true, when_false;  // only those that were asked for
    std::vector<VariableId> free;
    std::set<SymbolId> completed;  // completed predicates below

    AspAlternatives& when(bool value) { return value ? when_true : when_false; }
  };
  struct Frame;
  Part leaf(const TypedFormula& formula, bool want_true, bool want_false);
  Part compare(const TypedFormula& formula);
  Part atom(const TypedFormula& formula);
  void note_mention(const TypedFormula& formula, const Part& part, const AspLiteral& literal);
  void except_point(const AspLiteral& literal, const AspBody& lookups, Part& part) const;
  AspBody needs_of_atom(const TypedFormula& formula, std::vector<AspTerm>& arguments);
  Part combine(Frame& frame);
  Part quantified(Frame& frame);
  Part aggregate(Frame& frame);
  void note_existence(const Frame& frame, const AspBody& domain, Part& whole);
  bool mentions_effect(const TypedFormula& formula) const;
  AspLiteral all_instances(const Part& whole, Part& body, bool value,
                           const std::vector<VariableId>& variables, const AspBody& domain);
  AspAlternatives conjunction(std::vector<Part>& parts, bool value);
  AspAlternatives disjunction(std::vector<Part>& parts, bool value) const;
  AspAlternatives equivalence(std::vector<Part>& parts, bool value);
  std::optional<AspBody> single(Part& part, bool value);
  AspLiteral auxiliary(const char* kind, const Part& part, const AspBody& domain,
                       const AspAlternatives& alternatives);
  static void add_free(const std::vector<VariableId>& variables, Part& part);
  std::vector<VariableId> variables_of(TermId root) const;
  void inherit(Part& whole, Part& part) const;

  const TypedModel& model_;
  AspNames& names_;
  TermWriter& terms_;
  std::string& rules_;
  const AspPoint* point_ = nullptr;
  std::set<SymbolId> hidden_;
  std::vector<std::string> mentioned_;  // by symbol; empty: not asked for
  std::vector<bool> has_effect_;        // by formula: is there an effect in it?
  std::int64_t auxiliaries_ = 0;
};

}  // namespace parallax::compiler
