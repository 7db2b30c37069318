#include <algorithm>
#include <utility>

#include "compiler/asp/formula_writer.h"

namespace parallax::compiler {
namespace {

const char* symbol_of(CompareOp op, bool value) {
  switch (op) {
    case CompareOp::kEqual:
      return value ? " = " : " != ";
    case CompareOp::kNotEqual:
      return value ? " != " : " = ";
    case CompareOp::kLess:
      return value ? " < " : " >= ";
    case CompareOp::kLessEqual:
      return value ? " <= " : " > ";
    case CompareOp::kGreater:
      return value ? " > " : " <= ";
    case CompareOp::kGreaterEqual:
      return value ? " >= " : " < ";
  }
  return " = ";
}

}  // namespace

FormulaWriter::Part FormulaWriter::leaf(const TypedFormula& formula, bool want_true,
                                        bool want_false) {
  Part part;
  if (formula.kind == FormulaKind::kTrue || formula.kind == FormulaKind::kFalse) {
    const bool value = formula.kind == FormulaKind::kTrue;
    part.when_true = constant(value);
    part.when_false = constant(!value);
  } else {
    part = formula.kind == FormulaKind::kAtom ? atom(formula) : compare(formula);
    std::vector<TermId> visit = formula.terms;
    std::reverse(visit.begin(), visit.end());
    while (!visit.empty()) {
      const auto& term = model_.terms[visit.back()];
      visit.pop_back();
      visit.insert(visit.end(), term.arguments.rbegin(), term.arguments.rend());
      if (term.kind != TermKind::kVariable) continue;
      if (std::find(part.free.begin(), part.free.end(), term.variable) == part.free.end()) {
        part.free.push_back(term.variable);
      }
    }
  }
  if (!want_true) part.when_true.clear();
  if (!want_false) part.when_false.clear();
  return part;
}

FormulaWriter::Part FormulaWriter::compare(const TypedFormula& formula) {
  const auto left = terms_.term(formula.terms[0]);
  const auto right = terms_.term(formula.terms[1]);
  Part part;
  part.exists = left.needs;
  append(part.exists, right.needs);
  for (const bool value : {false, true}) {
    AspBody body = left.lookups;
    append(body, right.lookups);
    body.push_back(plain_literal(left.text + symbol_of(formula.compare, value) + right.text));
    part.when(value) = {std::move(body)};
  }
  return part;
}

/// Memberships; the time of an event must have a successor. Said of the last timepoint by its
/// number, an event exists and does not happen.
AspBody FormulaWriter::needs_of_atom(const TypedFormula& formula, std::vector<AspTerm>& arguments) {
  const auto& symbol = model_.symbols[formula.predicate];
  const auto& core = model_.core;
  const bool event = formula.predicate == core.happens;
  const bool effect = formula.predicate == core.initiates || formula.predicate == core.terminates ||
                      formula.predicate == core.releases;
  AspBody needs;
  for (std::size_t i = 0; i < formula.terms.size(); ++i) {
    const bool last = i + 1 == formula.terms.size();
    const bool named = model_.terms[formula.terms[i]].kind == TermKind::kInteger;
    auto value = last && (effect || (event && !named))
                     ? terms_.term(formula.terms[i])
                     : terms_.member(formula.terms[i], symbol.arguments[i]);
    if (last && (effect || (event && !named))) {
      value.needs.push_back(plain_literal(applied("step", {value.text})));
    }
    append(needs, value.needs);
    arguments.push_back(std::move(value));
  }
  return needs;
}

FormulaWriter::Part FormulaWriter::atom(const TypedFormula& formula) {
  Part part;
  std::vector<AspTerm> arguments;
  part.exists = needs_of_atom(formula, arguments);
  AspLiteral literal;
  literal.predicate = formula.predicate;
  AspBody lookups;
  for (const auto& argument : arguments) {
    literal.arguments.push_back(argument.text);
    append(lookups, argument.lookups);
  }
  literal.text = applied(names_.symbol(formula.predicate), literal.arguments);
  note_mention(formula, part, literal);
  for (const auto& completion : model_.completions) {
    if (completion.predicate == formula.predicate) part.completed.insert(formula.predicate);
  }
  auto negative = literal;
  negative.text = "not " + literal.text;
  negative.positive = false;
  AspBody when_true = lookups;
  AspBody when_false = lookups;
  when_true.push_back(literal);
  when_false.push_back(std::move(negative));
  part.when_false.push_back(std::move(when_false));
  part.when_true.push_back(std::move(when_true));
  if (point_ != nullptr && point_->predicate == formula.predicate) {
    except_point(literal, lookups, part);
  }
  return part;
}

/// The atom at the point is false, the others are what they are.
void FormulaWriter::except_point(const AspLiteral& literal, const AspBody& lookups,
                                 Part& part) const {
  if (literal.arguments.empty()) {  // the only atom of the predicate is the one taken for false
    part.when_true = constant(false);
    part.when_false = constant(true);
    return;
  }
  AspBody same = lookups;
  std::string here, there;
  for (std::size_t i = 0; i < literal.arguments.size(); ++i) {
    same.push_back(plain_literal(literal.arguments[i] + " = " + point_->arguments[i]));
    here += literal.arguments[i] + ",";
    there += point_->arguments[i] + ",";
  }
  part.when_false.push_back(std::move(same));
  part.when_true[0].push_back(plain_literal("(" + here + ") != (" + there + ")"));
}

void FormulaWriter::note_mention(const TypedFormula& formula, const Part& part,
                                 const AspLiteral& literal) {
  const auto& symbol = model_.symbols[formula.predicate];
  if (point_ != nullptr || std::none_of(symbol.arguments.begin(), symbol.arguments.end(),
                                        [&](SortId sort) { return terms_.is_unbounded(sort); })) {
    return;
  }
  std::vector<VariableId> variables;
  std::vector<TermId> visit = formula.terms;
  while (!visit.empty()) {
    const auto& term = model_.terms[visit.back()];
    visit.pop_back();
    visit.insert(visit.end(), term.arguments.begin(), term.arguments.end());
    if (term.kind == TermKind::kVariable) variables.push_back(term.variable);
  }
  auto body = terms_.domains(variables);
  append(body, part.exists);
  rules_ += rule_text(applied(mentioned(formula.predicate), literal.arguments), body);
}

}  // namespace parallax::compiler
