#include "compiler/pipeline/plan_formulas.h"

#include <string>

#include "compiler/syntax/parser.h"

namespace parallax::compiler {
namespace {

/// The substituted text is nowhere in the user's files, so what is wrong with it is reported at the
/// formula it was made from.
base::Result<CheckedFormula> check_text(const std::string& text, base::SourceRange origin,
                                        TypedModel& model, base::SourceFiles& files,
                                        base::DiagnosticSink& sink) {
  const auto file = files.add(files[origin.file].name(), text);
  base::DiagnosticSink own;
  const auto parsed = parse_formula(file, files, own);
  FormulaOptions options;
  options.fluents_as_atoms = true;
  if (parsed) {
    const auto checked = check_formula(model, parsed->ast, parsed->root, options, own);
    if (checked) return *checked;
  }
  sink.adopt(own, origin, text);
  return sink.already_reported();
}

}  // namespace

base::Result<PlanFormulas> check_plan_formulas(const PlanGraph& graph, TypedModel& model,
                                               base::SourceFiles& files,
                                               base::DiagnosticSink& sink) {
  PlanFormulas formulas;
  bool failed = false;
  for (const auto& location : graph.locations) {
    auto checked =
        check_text(location.success.formula, location.success.source, model, files, sink);
    if (checked) {
      formulas.success.push_back(*checked);
    } else {
      failed = true;
    }
  }
  for (const auto& branch : graph.branches) {
    auto checked = check_text(branch.guard, branch.source, model, files, sink);
    if (checked) {
      formulas.guards.push_back(*checked);
    } else {
      failed = true;
    }
  }
  if (failed) return sink.already_reported();
  return formulas;
}

}  // namespace parallax::compiler
