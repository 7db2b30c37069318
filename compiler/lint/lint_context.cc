#include "compiler/lint/lint_context.h"

#include "compiler/syntax/lexer.h"

namespace parallax::compiler {
namespace {

struct Visit {
  TypedFormulaId formula;
  bool positive = true;
  bool negative = false;
};

/// The children with the polarity that they have below `visit`.
void push_children(const TypedModel& model, const Visit& visit, std::vector<Visit>& stack) {
  const auto& formula = model.formulas[visit.formula];
  const auto& children = formula.children;
  for (std::size_t i = children.size(); i-- > 0;) {
    Visit child{children[i], visit.positive, visit.negative};
    const bool flips =
        formula.kind == FormulaKind::kNot || (formula.kind == FormulaKind::kImplies && i == 0);
    if (flips) std::swap(child.positive, child.negative);
    if (formula.mixes_polarity()) child.positive = child.negative = true;
    stack.push_back(child);
  }
}

}  // namespace

std::vector<TypedFormulaId> positive_atoms(const TypedModel& model, TypedFormulaId root) {
  std::vector<TypedFormulaId> atoms;
  std::vector<Visit> stack = {{root, true, false}};
  while (!stack.empty()) {
    const Visit visit = stack.back();
    stack.pop_back();
    const bool atom = model.formulas[visit.formula].kind == FormulaKind::kAtom;
    if (atom && visit.positive) atoms.push_back(visit.formula);
    push_children(model, visit, stack);
  }
  return atoms;
}

LintContext::LintContext(const ModelAst& ast, const TypedModel& model, base::DiagnosticSink& sink)
    : ast_(ast),
      model_(model),
      sink_(sink),
      mentioned_(model.symbols.size()),
      objects_mentioned_(model.objects.size()),
      variable_sorts_(model.sorts.size()) {
  for (const auto& file : ast.files) {
    const auto index = file.ast.file().index();
    if (index >= files_.size()) files_.resize(index + 1, nullptr);
    files_[index] = &file;
  }
  for (auto* marks : {&affected_[0], &affected_[1], &affected_[2], &targets_, &effective_events_}) {
    marks->symbols.resize(model.symbols.size());
  }
  collect();
}

void LintContext::mark(Marks& marks, TermId term) {
  const auto& what = model_.terms[term];
  const bool named =
      what.kind == TermKind::kApply && model_.symbols[what.symbol].kind != SymbolKind::kFunction;
  if (named) {
    marks.symbols[what.symbol.index()] = true;
  } else {
    marks.all = true;
  }
}

void LintContext::mention(TermId root) {
  for_each_term(model_, root, [&](TermId id) {
    const auto& term = model_.terms[id];
    if (term.kind == TermKind::kApply) mentioned_[term.symbol.index()] = true;
    if (term.kind == TermKind::kObject) objects_mentioned_[term.object.index()] = true;
  });
}

void LintContext::collect() {
  const auto binds = [&](const std::vector<VariableId>& variables) {
    for (const auto variable : variables) {
      variable_sorts_[model_.variables[variable].sort.index()] = true;
    }
  };
  for_each_root([&](TypedFormulaId root) {
    for_each_formula(model_, root, [&](TypedFormulaId id) {
      const auto& formula = model_.formulas[id];
      if (formula.kind == FormulaKind::kAtom) mentioned_[formula.predicate.index()] = true;
      for (const auto term : formula.terms) mention(term);
      binds(formula.variables);
    });
  });
  for (const auto& effect : model_.effects) {
    for (const auto term : {effect.event, effect.fluent, effect.time}) mention(term);
    mark(affected_[static_cast<std::size_t>(effect.kind)], effect.fluent);
    mark(effective_events_, effect.event);
    binds(effect.variables);
  }
  for (const auto& path : model_.trajectories) {
    for (const auto term : {path.fluent, path.time, path.target, path.offset}) mention(term);
    mark(targets_, path.target);
    binds(path.variables);
  }
  for (const auto& entry : model_.function_values) {
    mentioned_[entry.function.index()] = true;
    for (const auto argument : entry.arguments) mention(argument);
    mention(entry.value);
  }
}

bool LintContext::built_in(const base::SourceRange& range) const {
  const auto* file = file_of(range);
  return file == nullptr || file->built_in;  // none: made by the checker
}

std::string LintContext::text(const base::SourceRange& range) const {
  const auto* file = file_of(range);
  return file == nullptr ? std::string() : shortened(file->ast.text(Word{range.begin, range.end}));
}

const ModelAst::File* LintContext::file_of(const base::SourceRange& range) const {
  const auto index = range.file.index();
  return index < files_.size() ? files_[index] : nullptr;
}

bool LintContext::affected(SymbolId fluent, EffectKind kind) const {
  return affected_[static_cast<std::size_t>(kind)].contains(fluent);
}
bool LintContext::is_target(SymbolId fluent) const { return targets_.contains(fluent); }
bool LintContext::has_effect(SymbolId event) const { return effective_events_.contains(event); }

}  // namespace parallax::compiler
