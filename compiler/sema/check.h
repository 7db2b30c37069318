#pragma once

#include <cstdint>
#include <optional>

#include "compiler/base/diagnostic.h"
#include "compiler/base/result.h"
#include "compiler/base/source_file.h"
#include "compiler/sema/typed_model.h"
#include "compiler/syntax/ast.h"
#include "compiler/syntax/loader.h"

namespace parallax::compiler {

struct CheckOptions {
  /// The range of `time` from a scenario or the command line; each overrides the model's bound. A
  /// lower bound that nobody gives is 0.
  std::optional<std::int64_t> time_lower = std::nullopt;
  std::optional<std::int64_t> time_upper = std::nullopt;
  /// The upper bound where neither says one.
  std::optional<std::int64_t> usual_time_upper = std::nullopt;
  /// False for a part of a model (a library file): missing ranges are then warnings.
  bool complete_model = true;
  /// As the 2005 reasoner reads it: constants of ignored names stay in their sorts, and of two
  /// values of a function the last one counts.
  bool old_reasoner = false;
};

/// Declarations, names, sorts, well-formedness, recognition of effect and trajectory axioms. Many
/// errors in one run; fails if there was any (also one reported by the parser before).
/// Linear in the size of the model.
base::Result<TypedModel> check_model(const ModelAst& ast, const base::SourceFiles& files,
                                     base::DiagnosticSink& sink, const CheckOptions& options = {});

struct FormulaOptions {
  /// The variable `time` may be free; the result names it.
  bool allow_free_time = true;
  /// `RobotIn(r2)` stands for `HoldsAt(RobotIn(r2), t)` where a formula is expected. t is
  /// `fluent_time`, or else the free variable `time`.
  bool fluents_as_atoms = false;
  std::optional<TermId> fluent_time = std::nullopt;
};

struct CheckedFormula {
  TypedFormulaId formula;
  std::optional<VariableId> time;  // the free variable `time`, if the formula uses it
};

/// Checks one formula against a model and adds it to the model's stores (not to its axioms).
/// Initiates, Terminates, Releases and Trajectory are refused (E2302).
base::Result<CheckedFormula> check_formula(TypedModel& model, const Ast& ast, NodeId root,
                                           const FormulaOptions& options,
                                           base::DiagnosticSink& sink);

/// `weight` times the number of assignments of the free variables under which `formula` is true.
struct CheckedSum {
  TypedFormulaId formula;
  std::optional<TermId> weight;       // an integer; none: 1
  std::vector<VariableId> variables;  // free in one of them
};

/// A formula or term in a tree of its own. The tree may grow.
struct TreePart {
  Ast* ast = nullptr;
  NodeId root;
};

/// Checks formula and weight as check_formula does, but for their free variables: every name that
/// reads as a variable of some sort is one, in both the same.
base::Result<CheckedSum> check_sum(TypedModel& model, TreePart formula,
                                   std::optional<TreePart> weight, base::DiagnosticSink& sink);

}  // namespace parallax::compiler
