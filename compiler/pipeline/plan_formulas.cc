#include "compiler/pipeline/plan_formulas.h"

#include <fmt/core.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>

#include "compiler/base/codes/plans.h"

namespace parallax::compiler {
namespace {

std::optional<SortId> sort_of_variable(const TypedModel& model, std::string_view variable) {
  while (!variable.empty() && variable.back() >= '0' && variable.back() <= '9') {
    variable.remove_suffix(1);
  }
  return model.find_sort(variable);
}

/// The number of a variable that the outermost quantifiers `exists` bind.
std::optional<std::uint32_t> outermost(const FormulaTree& formula, std::string_view name) {
  auto at = formula.nodes.size() - 1;
  while (formula.nodes[at].kind == NodeKind::kExists) {
    const auto& children = formula.nodes[at].children;
    for (std::size_t i = 0; i + 1 < children.size(); ++i) {
      const auto number = formula.nodes[children[i]].number;
      if (formula.variables[number] == name) return number;
    }
    at = children.back();
  }
  return std::nullopt;
}

/// The sort of a quantified variable: by its name, else by its use.
std::optional<SortId> sort_of(const TypedModel& model, const FormulaTree& formula,
                              std::uint32_t variable) {
  if (const auto sort = sort_of_variable(model, formula.variables[variable])) return sort;
  return sort_by_use(model, formula, [&](const FormulaNode& node) {
    return node.leaf == LeafKind::kVariable && node.number == variable;
  });
}

/// Gives the variables of a formula names that the checker understands: each begins with its sort
/// and is the name of nothing else in the formula.
class VariableNames {
 public:
  VariableNames(const TypedModel& model, const FormulaTree& formula)
      : model_(model), text_(formula.text) {
    for (std::uint32_t i = 0; i < formula.variables.size(); ++i) {
      const auto& name = formula.variables[i];
      const bool taken =
          std::any_of(formula.nodes.begin(), formula.nodes.end(), [&](const FormulaNode& node) {
            return node.kind == NodeKind::kName && node.leaf == LeafKind::kName &&
                   formula.name(node) == name;
          });
      const auto sort = sort_of(model, formula, i);
      const bool usable = !taken && sort_of_variable(model, name).has_value();
      names_.push_back(usable || !sort ? name : fresh(*sort));
    }
  }

  const std::string& of(std::uint32_t variable) const { return names_[variable]; }

  std::string fresh(SortId sort) {
    for (int number = 9000;; ++number) {
      auto name = fmt::format("{}{}", model_.sorts[sort].name, number);
      const bool used = text_.find(name) != std::string::npos ||
                        std::find(given_.begin(), given_.end(), name) != given_.end();
      if (used) continue;
      given_.push_back(name);
      return name;
    }
  }

 private:
  const TypedModel& model_;
  const std::string& text_;
  std::vector<std::string> names_;  // by variable
  std::vector<std::string> given_;
};

class PlanFormulaChecker {
 public:
  PlanFormulaChecker(const PlanGraph& graph, TypedModel& model, base::SourceFiles& files,
                     base::DiagnosticSink& sink)
      : graph_(graph), model_(model), files_(files), sink_(sink) {}

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
  /// A register has the sort over which the success formulas of its performs quantify.
  bool find_register_sorts() {
    std::vector<std::optional<SortId>> sorts(graph_.values.size());
    for (const auto& location : graph_.locations) {
      if (!location.result || sorts[location.result->index()]) continue;
      const auto& name = graph_.values[*location.result].variable;
      const auto& formula = location.success.formula;
      const auto variable = outermost(formula, name);
      const auto sort = variable ? sort_of(model_, formula, *variable) : std::nullopt;
      if (!sort) return refuse_result(name, location.success.source);
      sorts[location.result->index()] = sort;
    }
    for (const auto input : graph_.inputs) {
      const auto& name = graph_.values[input].name;
      const auto found = sorts_of_input(input);
      if (found.empty()) {
        return refuse_input(
            name,
            "is no argument of an event or of a formula, so that nothing says which "
            "values it has");
      }
      const auto& sort = sorts[input.index()] = narrowest(found);
      if (!sort) {
        return refuse_input(
            name, fmt::format("stands for a `{}` and for a `{}`", model_.sorts[found[0]].name,
                              model_.sorts[found[1]].name));
      }
      if (!has_values(*sort)) {
        return refuse_input(name, fmt::format("is a `{}`, of which the model names none",
                                              model_.sorts[*sort].name));
      }
    }
    for (const auto& sort : sorts) {
      PARALLAX_REQUIRE(sort.has_value(), "every register is bound by some location");
      out_.register_sorts.push_back(*sort);
    }
    return true;
  }

  /// Those of all argument places of events and formulas at which it stands, each once.
  std::vector<SortId> sorts_of_input(ModelValueId input) const {
    std::vector<SortId> out;
    const auto add = [&](const FormulaTree& formula) {
      const auto places = static_cast<std::size_t>(
          std::count_if(formula.nodes.begin(), formula.nodes.end(),
                        [&](const FormulaNode& node) { return is_register(node, input); }));
      for (std::size_t place = 0; place < places; ++place) {
        std::size_t met = 0;
        const auto sort = sort_by_use(model_, formula, [&](const FormulaNode& node) {
          return is_register(node, input) && met++ == place;
        });
        if (sort && std::find(out.begin(), out.end(), *sort) == out.end()) out.push_back(*sort);
      }
    };
    for (const auto& location : graph_.locations) {
      add(location.event);
      add(location.success.formula);
    }
    for (const auto& branch : graph_.branches) {
      if (!branch.free) add(branch.guard);
    }
    return out;
  }

  static bool is_register(const FormulaNode& node, ModelValueId input) {
    return node.leaf == LeafKind::kRegister && node.number == input.index();
  }

  /// The one that is part of all the others.
  std::optional<SortId> narrowest(const std::vector<SortId>& sorts) const {
    for (const auto sort : sorts) {
      const bool fits = std::all_of(sorts.begin(), sorts.end(),
                                    [&](SortId other) { return model_.is_subsort(sort, other); });
      if (fits) return sort;
    }
    return std::nullopt;
  }

  bool has_values(SortId sort) const {
    if (model_.sorts[sort].integer || model_.sorts[sort].reified) return true;
    return std::any_of(model_.objects.begin(), model_.objects.end(), [&](const auto& object) {
      return std::any_of(object.sorts.begin(), object.sorts.end(),
                         [&](SortId of) { return model_.is_subsort(of, sort); });
    });
  }

  bool refuse_input(const std::string& name, std::string_view why) {
    sink_.error_about(codes::kNoPlanEntry, "--plan-entry", fmt::format("`{}` {}", name, why));
    failed_ = true;
    return false;
  }

  bool refuse_result(const std::string& variable, base::SourceRange source) {
    sink_.error(
        codes::kBindingSyntax, source,
        fmt::format("a formula that begins with `{{{0}}}` or `exists {0}.`, as {0} is returned",
                    variable),
        "another one");
    failed_ = true;
    return false;
  }

  /// Many locations share a formula: each is checked once.
  void add(const FormulaTree& formula, const std::optional<std::string>& returned,
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

  std::optional<PlanFormula> check_one(const FormulaTree& formula,
                                       const std::optional<std::string>& returned,
                                       base::SourceRange source) {
    const auto result = returned ? outermost(formula, *returned) : std::nullopt;
    if (returned && !result) {
      refuse_result(*returned, source);
      return std::nullopt;
    }
    VariableNames names(model_, formula);
    std::map<ModelValueId, std::string> registers;
    std::vector<std::string> list;
    for (const auto id : registers_in(formula)) {
      list.push_back(names.fresh(out_.register_sorts[id.index()]));
      registers.emplace(id, list.back());
    }
    auto named = with_leaves(formula, [&](const FormulaNode& node) -> std::optional<FormulaTree> {
      if (node.leaf == LeafKind::kVariable) return constant_term(names.of(node.number));
      if (node.leaf != LeafKind::kRegister) return std::nullopt;
      return constant_term(registers.at(ModelValueId(node.number)));
    });
    if (!list.empty()) named = exists(list, named);
    const auto checked = check_tree(named, source);
    if (!checked) return std::nullopt;
    PlanFormula out{*checked, {}, {}};
    for (const auto& [id, variable] : registers) {
      out.registers.emplace(id, *quantified(checked->formula, variable));
    }
    if (result) out.returned = quantified(checked->formula, names.of(*result));
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

  /// The formula with its values is nowhere in the user's files, so errors are reported at the
  /// formula it was made from.
  base::Result<CheckedFormula> check_tree(const FormulaTree& formula, base::SourceRange origin) {
    const auto file = files_.add(files_[origin.file].name(), formula.text);
    base::DiagnosticSink own;
    const auto parsed = to_ast(formula, file, files_);
    FormulaOptions options;
    options.fluents_as_atoms = true;
    const auto checked = check_formula(model_, parsed.ast, parsed.root, options, own);
    if (checked) return *checked;
    sink_.adopt(own, origin, formula.text);
    return sink_.already_reported();
  }

  const PlanGraph& graph_;
  TypedModel& model_;
  base::SourceFiles& files_;
  base::DiagnosticSink& sink_;
  PlanFormulas out_;
  std::map<std::pair<FormulaTree, std::string>, std::optional<PlanFormula>> known_;
  bool failed_ = false;
};

}  // namespace

std::optional<SortId> sort_by_use(const TypedModel& model, const FormulaTree& formula,
                                  const std::function<bool(const FormulaNode&)>& is_meant) {
  // The innermost call around a node, and which of its arguments the node is in.
  struct Use {
    const FormulaNode* call = nullptr;
    std::size_t argument = 0;
  };
  std::vector<Use> uses(formula.nodes.size());
  for (auto i = formula.nodes.size(); i-- > 0;) {
    const auto& node = formula.nodes[i];
    for (std::size_t k = 0; k < node.children.size(); ++k) {
      uses[node.children[k]] = node.kind == NodeKind::kApply ? Use{&node, k} : uses[i];
    }
  }
  for (std::size_t i = 0; i < formula.nodes.size(); ++i) {
    const auto& node = formula.nodes[i];
    if (node.kind != NodeKind::kName || uses[i].call == nullptr || !is_meant(node)) continue;
    const auto symbol = model.find_symbol(formula.name(*uses[i].call));
    if (!symbol || uses[i].argument >= model.symbols[*symbol].arguments.size()) continue;
    return model.symbols[*symbol].arguments[uses[i].argument];
  }
  return std::nullopt;
}

base::Result<PlanFormulas> check_plan_formulas(const PlanGraph& graph, TypedModel& model,
                                               base::SourceFiles& files,
                                               base::DiagnosticSink& sink) {
  return PlanFormulaChecker(graph, model, files, sink).check();
}

}  // namespace parallax::compiler
