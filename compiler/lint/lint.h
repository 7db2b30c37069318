#pragma once

#include <span>
#include <string_view>

#include "compiler/base/diagnostic.h"
#include "compiler/sema/typed_model.h"
#include "compiler/syntax/loader.h"

namespace parallax::compiler {

class LintContext;

/// One rule: its description, and the function that reports it.
struct LintRule {
  base::DiagnosticCode code;
  std::string_view name;         // "unused-variable"
  std::string_view description;  // one line
  void (*run)(const LintContext&);
};

/// Rules for legal but suspicious text, W21xx: for `check`.
std::span<const LintRule> lint_rules();

/// Rules for places where the 2005 reasoner silently does something else, W22xx: for every command
/// that reads a model in its standard meaning. Five more such places are reported where they are
/// first seen: W1101 by the lexer, W2001, W2007 and W2008 by the checker.
std::span<const LintRule> difference_rules();

/// Rules about formulas that make answers differ from one horizon to the next, for commands that
/// prove something up to a horizon.
std::span<const LintRule> horizon_rules();

/// The codes of those differences that the old meaning follows: to be muted where it is asked for.
std::span<const base::DiagnosticCode> reproduced_differences();

/// Applies `rules` to a model that the checker accepted. At most one warning an axiom and rule.
/// Statements of the built-in foundations are not looked at. The time of every rule is at most
/// n log n in the size of the model, but for facts beside rules, which are cut off at a budget.
void lint_model(std::span<const LintRule> rules, const ModelAst& ast, const TypedModel& model,
                base::DiagnosticSink& sink);

}  // namespace parallax::compiler
