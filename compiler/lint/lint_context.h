#pragma once

#include <array>
#include <string>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "compiler/sema/typed_model.h"
#include "compiler/syntax/loader.h"

namespace parallax::compiler {

/// Visits the formula and everything below it, outermost first. No recursion.
template <typename Visit>
void for_each_formula(const TypedModel& model, TypedFormulaId root, const Visit& visit) {
  std::vector<TypedFormulaId> stack = {root};
  while (!stack.empty()) {
    const auto id = stack.back();
    stack.pop_back();
    const auto& children = model.formulas[id].children;
    stack.insert(stack.end(), children.rbegin(), children.rend());
    visit(id);
  }
}

/// Visits the term and its arguments at any depth. No recursion.
template <typename Visit>
void for_each_term(const TypedModel& model, TermId root, const Visit& visit) {
  std::vector<TermId> stack = {root};
  while (!stack.empty()) {
    const auto id = stack.back();
    stack.pop_back();
    const auto& arguments = model.terms[id].arguments;
    stack.insert(stack.end(), arguments.rbegin(), arguments.rend());
    visit(id);
  }
}

/// The atoms of the formula that occur positively (also those under `<->`): the ones that it can
/// be a reason for.
std::vector<TypedFormulaId> positive_atoms(const TypedModel& model, TypedFormulaId root);

/// A model, and what several rules ask about it. Model and texts must outlive it.
class LintContext {
 public:
  LintContext(const ModelAst& ast, const TypedModel& model, base::DiagnosticSink& sink);

  const ModelAst& ast() const { return ast_; }
  const TypedModel& model() const { return model_; }
  base::DiagnosticSink& sink() const { return sink_; }

  /// Is it one of our own foundations that stands there?
  bool built_in(const base::SourceRange& range) const;
  /// The text of the user that stands there, shortened for a message.
  std::string text(const base::SourceRange& range) const;

  /// By symbol: is it named in a formula, an effect axiom, a trajectory or a function's table?
  bool mentioned(SymbolId symbol) const { return mentioned_[symbol.index()]; }
  bool mentioned(ObjectId object) const { return objects_mentioned_[object.index()]; }
  bool has_variable(SortId sort) const { return variable_sorts_[sort.index()]; }
  /// Can some axiom of this kind be about the fluent?
  bool affected(SymbolId fluent, EffectKind kind) const;
  /// Can some trajectory end in the fluent?
  bool is_target(SymbolId fluent) const;
  /// Can some effect axiom be about the event?
  bool has_effect(SymbolId event) const;

  /// Visits every formula that the model asserts or uses as a condition, whole.
  template <typename Visit>
  void for_each_root(const Visit& visit) const {
    for (const auto& axiom : model_.axioms) visit(axiom.formula);
    for (const auto& effect : model_.effects) visit(effect.condition);
    for (const auto& path : model_.trajectories) visit(path.condition);
  }

 private:
  /// Marks of symbols; a variable in place of a term stands for all of them.
  struct Marks {
    std::vector<bool> symbols;
    bool all = false;
    bool contains(SymbolId symbol) const { return all || symbols[symbol.index()]; }
  };
  void mark(Marks& marks, TermId term);
  void mention(TermId root);
  void collect();
  const ModelAst::File* file_of(const base::SourceRange& range) const;

  const ModelAst& ast_;
  const TypedModel& model_;
  base::DiagnosticSink& sink_;
  std::vector<const ModelAst::File*> files_;  // by FileId; of ast_
  std::vector<bool> mentioned_;               // by symbol
  std::vector<bool> objects_mentioned_;       // by object
  std::vector<bool> variable_sorts_;          // by sort
  std::array<Marks, 3> affected_;             // by EffectKind
  Marks targets_;
  Marks effective_events_;
};

}  // namespace parallax::compiler
