#include "tools/app/plan_inputs.h"

#include <algorithm>
#include <functional>

#include "compiler/base/ground_name.h"

namespace parallax::tools {
namespace {

void visit_formulas(const compiler::PlanGraph& plan,
                    const std::function<void(const compiler::FormulaTree&)>& visit) {
  for (const auto& location : plan.locations) visit(location.success.formula);
  for (const auto& branch : plan.branches) {
    if (!branch.free) visit(branch.guard);
  }
}

/// The atoms that the plan's formulas name without variables, printed as the model prints them.
std::set<std::string> atoms_named(const compiler::PlanGraph& plan) {
  std::set<std::string> out;
  visit_formulas(plan, [&](const compiler::FormulaTree& tree) {
    for (const auto& node : tree.nodes) {
      if (node.kind != compiler::NodeKind::kApply) continue;
      auto atom = std::string(tree.name(node)) + '(';
      bool known = true;
      for (const auto child : node.children) {
        const auto& argument = tree.nodes[child];
        known = known && argument.kind == compiler::NodeKind::kName &&
                argument.leaf == compiler::LeafKind::kName;
        if (atom.back() != '(') atom += ',';
        atom += tree.name(argument);
      }
      if (known) out.insert(atom + ')');
    }
  });
  return out;
}

}  // namespace

std::set<std::string> symbols_read(const compiler::PlanGraph& plan) {
  std::set<std::string> out;
  visit_formulas(plan, [&](const compiler::FormulaTree& tree) {
    for (const auto& node : tree.nodes) {
      if (node.name_length > 0) out.emplace(tree.name(node));
    }
  });
  return out;
}

std::vector<std::string> plan_inputs(const compiler::PlanGraph& plan,
                                     const compiler::CompiledModel& model,
                                     const runtime::Trace& trace, const runtime::OpenAtoms& open) {
  std::vector<std::string> out;
  for (const auto& [name, object] : trace.points.front().registers) {
    out.push_back(name + '=' + object);
  }
  const auto is_open = [&](const std::string& atom) {
    return std::find(open.predicates.begin(), open.predicates.end(), atom) != open.predicates.end();
  };
  const auto read = symbols_read(plan);
  for (const auto& atom : trace.predicates) {
    if (!is_open(atom) && read.contains(std::string(base::symbol_of(atom)))) out.push_back(atom);
  }
  const auto named = atoms_named(plan);
  std::vector<std::string> denied;
  model.for_each_atom([&](const compiler::AtomRef& atom) {
    if (atom.kind != compiler::AtomKind::kPredicate || atom.time) return;
    const std::string name(atom.name);
    const bool holds = std::binary_search(trace.predicates.begin(), trace.predicates.end(), name);
    if (!holds && named.contains(name) && !is_open(name)) denied.push_back('!' + name);
  });
  std::sort(denied.begin(), denied.end());
  out.insert(out.end(), denied.begin(), denied.end());
  return out;
}

}  // namespace parallax::tools
