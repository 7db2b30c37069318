#include "compiler/repair/other_term.h"

#include "compiler/repair/number_term.h"
#include "compiler/syntax/printer.h"

namespace parallax::compiler {

std::vector<SortedVariable> variables_of(const AxiomForm& form, const TypedModel& typed) {
  std::vector<SortedVariable> out;
  for (const auto& name : form.variables) {
    const auto sort = sort_of_variable(typed, name);
    if (sort && name != form.time) out.push_back({name, *sort});
  }
  return out;
}

std::vector<OtherTerm> other_terms(const EditSubject& subject, const AxiomForm& form, NodeId term) {
  const auto& tree = subject.model.ast(form.place);
  const auto& node = tree[term];
  std::vector<OtherTerm> out;
  if (node.kind != NodeKind::kApply) return out;
  const auto symbol = subject.typed.find_symbol(tree.name(node));
  if (!symbol || subject.typed.symbols[*symbol].arguments.size() != node.child_count) return out;
  const auto variables = variables_of(form, subject.typed);
  std::vector<std::string> arguments;
  for (std::uint32_t i = 0; i < node.child_count; ++i) {
    arguments.push_back(print_formula(tree, tree.child(node, i)));
  }
  const std::string name_of(tree.name(node));
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const auto sort = subject.typed.symbols[*symbol].arguments[i];
    auto with = arguments;
    for (const auto& variable : variables) {
      if (variable.name == arguments[i] || !subject.typed.sorts_overlap(variable.sort, sort))
        continue;
      with[i] = variable.name;
      out.push_back({name_of, with, 1});
      if (!is_number_sort(subject.typed, variable.sort)) continue;
      for (const auto* step : {"+1", "-1"}) {
        with[i] = variable.name + step;
        if (with[i] != arguments[i]) out.push_back({name_of, with, 2});
      }
    }
    const auto constants = constants_of(subject.typed, sort);
    if (constants.size() > kMostLiterals) continue;
    for (const auto& name : constants) {
      if (name == arguments[i]) continue;
      with[i] = name;
      out.push_back({name_of, with, 3});
    }
    for (std::size_t j = i + 1; j < arguments.size(); ++j) {
      auto swapped = arguments;
      std::swap(swapped[i], swapped[j]);
      if (swapped != arguments &&
          subject.typed.sorts_overlap(sort, subject.typed.symbols[*symbol].arguments[j])) {
        out.push_back({name_of, swapped, 1});
      }
    }
  }
  return out;
}

std::vector<std::pair<std::string, std::string>> exchanged(const Ast& tree,
                                                           const EffectParts& parts,
                                                           const TypedModel& typed) {
  std::vector<std::pair<std::string, std::string>> out;
  const auto arguments = [&](NodeId term) {
    std::vector<std::string> names;
    for (std::uint32_t i = 0; i < tree[term].child_count; ++i) {
      names.push_back(print_formula(tree, tree.child(tree[term], i)));
    }
    return names;
  };
  const auto print = [&](NodeId term, const std::vector<std::string>& with) {
    std::string text(tree.name(tree[term]));
    text += "(";
    for (std::size_t i = 0; i < with.size(); ++i) text += (i == 0 ? "" : ",") + with[i];
    return text + ")";
  };
  const auto event = arguments(parts.event), fluent = arguments(parts.fluent);
  for (std::size_t i = 0; i < event.size(); ++i) {
    for (std::size_t j = 0; j < fluent.size(); ++j) {
      const auto a = sort_of_variable(typed, event[i]), b = sort_of_variable(typed, fluent[j]);
      if (event[i] == fluent[j] || !a || !b || !typed.sorts_overlap(*a, *b)) continue;
      auto e = event, f = fluent;
      std::swap(e[i], f[j]);
      out.emplace_back(print(parts.event, e), print(parts.fluent, f));
    }
  }
  return out;
}

}  // namespace parallax::compiler
