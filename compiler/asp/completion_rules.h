#pragma once

#include <string>
#include <vector>

#include "compiler/asp/formula_writer.h"

namespace parallax::compiler {

/// Pointwise circumscription (Lifschitz 1986): a completed atom p is true only if some axiom that
/// counts would be false without it. For an axiom whose completed atoms stand openly in its
/// instances this is a rule `reason(p) :- condition` for each of them; for one that hides them in
/// quantifiers or nested connectives the whole axiom is written again with p taken for false.
///
/// With `option founded on` a completed atom in a condition needs its own reason there; as answer
/// sets are founded, that excludes circles. An axiom that hides such atoms is refused
/// (kAspNotFounded).
class CompletionRules {
 public:
  CompletionRules(const TypedModel& model, AspNames& names, TermWriter& terms,
                  FormulaWriter& formulas, std::string& rules, base::DiagnosticSink& sink);

  /// The axiom as `[variables] body`, and how its body is false.
  void note(const Axiom& axiom, const std::vector<VariableId>& variables, TypedFormulaId body,
            const AspFormula& false_body);
  /// Writes the rules that make a completed atom false if it has no reason.
  void write();

 private:
  void open_reasons(std::size_t completion, const AspBody& instance, const AspBody& body);
  void hidden_reasons(std::size_t completion, const AspBody& instance, TypedFormulaId body);
  AspPoint point_of(SymbolId predicate);
  bool is_refused(const Axiom& axiom, const AspFormula& false_body);
  AspBody with_reason(const AspLiteral& literal) const;

  const TypedModel& model_;
  TermWriter& terms_;
  AspNames& names_;
  FormulaWriter& formulas_;
  std::string& rules_;
  base::DiagnosticSink& sink_;
  std::vector<std::string> reasons_;     // by completion: the predicate
  bool effects_hide_completed_ = false;  // an effect's condition speaks of a completed predicate
};

}  // namespace parallax::compiler
