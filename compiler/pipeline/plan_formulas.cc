#include "compiler/pipeline/plan_formulas.h"

#include <fmt/core.h>

#include <string>
#include <utility>

#include "compiler/base/diagnostic_codes.h"
#include "compiler/pipeline/plan_formula_text.h"
#include "compiler/plan/plan_liveness.h"
#include "compiler/syntax/parser.h"

namespace parallax::compiler {
namespace {

using base::DiagnosticCode;

class PlanFormulaChecker {
 public:
  PlanFormulaChecker(const PlanGraph& graph, TypedModel& model, base::SourceFiles& files,
                     base::DiagnosticSink& sink)
      : graph_(graph), model_(model), files_(files), sink_(sink), names_(graph) {}

  base::Result<PlanFormulas> check() {
    if (!find_register_sorts()) return sink_.already_reported();
    for (const auto& location : graph_.locations) {
      std::optional<std::string> returned;
      if (location.result) returned = graph_.values[*location.result].variable;
      add(location.success.formula, returned, location.success.source, out_.success);
    }
    for (const auto& branch : graph_.branches) {
      if (branch.free) {
        out_.guards.push_back({});  // nobody grounds it
        continue;
      }
      add(branch.guard, std::nullopt, branch.source, out_.guards);
    }
    if (failed_) return sink_.already_reported();
    return std::move(out_);
  }

 private:
  /// What a register holds is what the success formulas of its performs quantify over.
  bool find_register_sorts() {
    std::vector<std::optional<SortId>> sorts(graph_.values.size());
    for (const auto& location : graph_.locations) {
      if (!location.result || sorts[location.result->index()]) continue;
      const auto& variable = graph_.values[*location.result].variable;
      const auto text = to_model_syntax(model_, location.success.formula);
      const auto renamed = text.renamed.find(variable);
      const auto sort =
          sort_of_variable(model_, renamed == text.renamed.end() ? variable : renamed->second);
      if (!sort) return refuse_result(variable, location.success.source);
      sorts[location.result->index()] = sort;
    }
    for (const auto& sort : sorts) {
      PARALLAX_REQUIRE(sort.has_value(), "every register is bound by some location");
      out_.register_sorts.push_back(*sort);
    }
    return true;
  }

  bool refuse_result(const std::string& variable, base::SourceRange source) {
    sink_.error(
        DiagnosticCode::kBindingSyntax, source,
        fmt::format("a formula that begins with `{{{0}}}` or `exists {0}.`, as {0} is returned",
                    variable),
        "another one");
    failed_ = true;
    return false;
  }

  /// Many locations share a formula: each text is checked once.
  void add(const std::string& formula, const std::optional<std::string>& returned,
           base::SourceRange source, std::vector<PlanFormula>& out) {
    const auto key = std::pair(formula, returned.value_or(""));
    auto found = known_.find(key);
    if (found == known_.end()) {
      found = known_.emplace(key, check_one(formula, returned, source)).first;
    }
    if (found->second) {
      out.push_back(*found->second);
    } else {
      failed_ = true;
    }
  }

  std::optional<PlanFormula> check_one(const std::string& formula,
                                       const std::optional<std::string>& returned,
                                       base::SourceRange source) {
    auto text = to_model_syntax(model_, formula);
    std::map<ModelValueId, std::string> variables;
    std::string list;
    for (const auto id : names_.in(formula)) {
      auto variable = fresh_variable(model_, out_.register_sorts[id.index()], text.text);
      text.text = replace_word(text.text, graph_.values[id].name, variable);
      list += (list.empty() ? "" : ",") + variable;
      variables.emplace(id, std::move(variable));
    }
    if (!list.empty()) text.text = fmt::format("{{{}}} ({})", list, text.text);
    const auto checked = check_text(text.text, source);
    if (!checked) return std::nullopt;
    PlanFormula out{*checked, {}, {}};
    for (const auto& [id, variable] : variables) {
      out.registers.emplace(id, *quantified(checked->formula, variable));
    }
    if (returned) {
      const auto renamed = text.renamed.find(*returned);
      out.returned =
          quantified(checked->formula, renamed == text.renamed.end() ? *returned : renamed->second);
      if (!out.returned) {
        refuse_result(*returned, source);
        return std::nullopt;
      }
    }
    return out;
  }

  /// The variable of that name that the outermost existential quantifiers bind.
  std::optional<VariableId> quantified(TypedFormulaId formula, const std::string& name) const {
    for (;;) {
      const auto& node = model_.formulas[formula];
      if (node.kind != FormulaKind::kExists) return std::nullopt;
      for (const auto variable : node.variables) {
        if (model_.variables[variable].name == name) return variable;
      }
      formula = node.children.front();
    }
  }

  /// The substituted text is nowhere in the user's files, so what is wrong with it is reported at
  /// the formula it was made from.
  base::Result<CheckedFormula> check_text(const std::string& text, base::SourceRange origin) {
    const auto file = files_.add(files_[origin.file].name(), text);
    base::DiagnosticSink own;
    const auto parsed = parse_formula(file, files_, own);
    FormulaOptions options;
    options.fluents_as_atoms = true;
    if (parsed) {
      const auto checked = check_formula(model_, parsed->ast, parsed->root, options, own);
      if (checked) return *checked;
    }
    sink_.adopt(own, origin, text);
    return sink_.already_reported();
  }

  const PlanGraph& graph_;
  TypedModel& model_;
  base::SourceFiles& files_;
  base::DiagnosticSink& sink_;
  RegisterNames names_;
  PlanFormulas out_;
  std::map<std::pair<std::string, std::string>, std::optional<PlanFormula>> known_;
  bool failed_ = false;
};

}  // namespace

base::Result<PlanFormulas> check_plan_formulas(const PlanGraph& graph, TypedModel& model,
                                               base::SourceFiles& files,
                                               base::DiagnosticSink& sink) {
  return PlanFormulaChecker(graph, model, files, sink).check();
}

}  // namespace parallax::compiler
