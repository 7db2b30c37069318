#include "compiler/repair/condition_literal.h"

#include <algorithm>

#include "compiler/repair/number_term.h"

namespace parallax::compiler {
namespace {

using Arguments = std::vector<LiteralArgument>;
using Kind = LiteralArgument::Kind;

/// Arguments that can stand at a place of this sort; numbers also one beside a variable.
Arguments choices(const TypedModel& model, SortId sort,
                  const std::vector<SortedVariable>& variables, bool constants) {
  Arguments out;
  for (const auto& variable : variables) {
    if (model.sorts_overlap(variable.sort, sort)) out.push_back({Kind::kVariable, variable.name});
  }
  out.push_back({Kind::kSome, model.sorts[sort].name});
  if (constants) {
    for (auto& name : constants_of(model, sort)) out.push_back({Kind::kConstant, std::move(name)});
  }
  if (!is_number_sort(model, sort)) return out;
  for (const auto& variable : variables) {
    if (!model.sorts_overlap(variable.sort, sort)) continue;
    for (const auto* step : {"+1", "-1"}) out.push_back({Kind::kTerm, variable.name + step});
  }
  return out;
}

std::vector<Arguments> product(const std::vector<Arguments>& places) {
  std::vector<Arguments> out = {{}};
  for (const auto& place : places) {
    std::vector<Arguments> next;
    for (const auto& begun : out) {
      for (const auto& choice : place) {
        next.push_back(begun);
        next.back().push_back(choice);
      }
    }
    out = std::move(next);
  }
  return out;
}

std::size_t product_size(const std::vector<Arguments>& places) {
  std::size_t out = 1;
  for (const auto& place : places) out = std::min<std::size_t>(out * place.size(), 1'000'000);
  return out;
}

void add_both(ConditionLiteral literal, std::vector<ConditionLiteral>& out) {
  literal.negated = false;
  out.push_back(literal);
  literal.negated = true;
  out.push_back(std::move(literal));
}

void add_symbol(const TypedModel& model, const Symbol& symbol, std::vector<SortId> sorts,
                const std::vector<SortedVariable>& variables, std::size_t most_each,
                bool may_have_constants, std::vector<ConditionLiteral>& out) {
  for (const bool constants : {true, false}) {
    if (constants && !may_have_constants) continue;
    std::vector<Arguments> places;
    for (const auto sort : sorts) places.push_back(choices(model, sort, variables, constants));
    if (product_size(places) > most_each) continue;
    for (auto& arguments : product(places)) {
      ConditionLiteral literal;
      literal.kind = symbol.kind == SymbolKind::kFluent ? ConditionLiteral::Kind::kFluent
                                                        : ConditionLiteral::Kind::kPredicate;
      literal.symbol = symbol.name;
      literal.arguments = std::move(arguments);
      add_both(std::move(literal), out);
    }
    return;
  }
}

void add_equation(LiteralArgument left, LiteralArgument right, bool less,
                  std::vector<ConditionLiteral>& out) {
  ConditionLiteral literal;
  literal.kind = ConditionLiteral::Kind::kEqual;
  literal.arguments = {std::move(left), std::move(right)};
  literal.less = less;
  // Nobody writes `x != y + 1` as a condition.
  const bool by_term = literal.arguments.back().kind == Kind::kTerm && !less;
  if (by_term) {
    out.push_back(std::move(literal));
  } else {
    add_both(std::move(literal), out);
  }
}

/// Comparisons of a number with other variables, their neighbours and the values of functions.
void add_number_comparisons(const TypedModel& model, const std::vector<SortedVariable>& variables,
                            std::size_t i, const std::vector<std::string>& functions,
                            bool constants, std::vector<ConditionLiteral>& out) {
  const LiteralArgument left{Kind::kVariable, variables[i].name};
  for (const auto& term : functions) add_equation(left, {Kind::kTerm, term}, true, out);
  for (std::size_t j = 0; j < variables.size(); ++j) {
    if (j == i || !model.sorts_overlap(variables[i].sort, variables[j].sort)) continue;
    add_equation(left, {Kind::kVariable, variables[j].name}, true, out);
    add_equation(left, {Kind::kTerm, variables[j].name + "+1"}, false, out);
    for (const auto& term : functions) {
      for (const auto* sign : {"+", "-"}) {
        add_equation(left, {Kind::kTerm, variables[j].name + sign + term}, false, out);
      }
    }
  }
  if (!constants) return;
  const auto numerals = numerals_of(model, variables[i].sort);
  for (std::size_t k = 1; k < numerals.size(); ++k) {
    add_equation(left, {Kind::kConstant, numerals[k]}, true, out);
  }
}

void add_equations(const TypedModel& model, const std::vector<SortedVariable>& variables,
                   std::size_t most_each, bool may_have_constants,
                   std::vector<ConditionLiteral>& out) {
  for (std::size_t i = 0; i < variables.size(); ++i) {
    const LiteralArgument left{Kind::kVariable, variables[i].name};
    for (std::size_t j = i + 1; j < variables.size(); ++j) {
      if (!model.sorts_overlap(variables[i].sort, variables[j].sort)) continue;
      add_equation(left, {Kind::kVariable, variables[j].name}, false, out);
    }
    const auto constants = constants_of(model, variables[i].sort);
    for (const auto& name : constants) {
      if (!may_have_constants || constants.size() > most_each) break;
      add_equation(left, {Kind::kConstant, name}, false, out);
    }
    const auto functions = function_terms(model, variables[i].sort, variables);
    for (const auto& term : functions) add_equation(left, {Kind::kTerm, term}, false, out);
    if (is_number_sort(model, variables[i].sort)) {
      add_number_comparisons(model, variables, i, functions, may_have_constants, out);
    }
  }
}

}  // namespace

std::size_t ConditionLiteral::count(LiteralArgument::Kind of) const {
  return static_cast<std::size_t>(std::count_if(arguments.begin(), arguments.end(),
                                                [&](const auto& each) { return each.kind == of; }));
}

std::string print(const ConditionLiteral& literal, const std::string& time,
                  const std::vector<std::string>& taken) {
  if (literal.kind == ConditionLiteral::Kind::kEqual) {
    const auto* relation =
        literal.less ? (literal.negated ? ">=" : "<") : (literal.negated ? "!=" : "=");
    return literal.arguments[0].name + relation + literal.arguments[1].name;
  }
  std::string quantified, arguments;
  auto names = taken;
  for (const auto& argument : literal.arguments) {
    auto name = argument.name;
    if (argument.kind == Kind::kSome) {
      for (int i = 1; std::find(names.begin(), names.end(), name) != names.end(); ++i) {
        name = argument.name + std::to_string(i);
      }
      names.push_back(name);
      quantified += (quantified.empty() ? "" : ",") + name;
    }
    arguments += (arguments.empty() ? "" : ",") + name;
  }
  auto atom = literal.symbol + "(" + arguments + ")";
  if (literal.kind == ConditionLiteral::Kind::kFluent) atom = "HoldsAt(" + atom + "," + time + ")";
  if (!quantified.empty()) atom = "({" + quantified + "} " + atom + ")";
  return (literal.negated ? "!" : "") + atom;
}

namespace {

/// Variables of the symbol's own sorts for those that may have other values.
struct NarrowLiteral {
  ConditionLiteral literal;
  std::string quantified, equations;  // "drawer", "drawer=place"
  std::vector<std::string> names;     // names that are taken
};

NarrowLiteral narrowed(const ConditionLiteral& literal, const TypedModel& model,
                       const std::vector<std::string>& taken) {
  NarrowLiteral out{literal, {}, {}, taken};
  const auto symbol = model.find_symbol(literal.symbol);
  if (literal.kind == ConditionLiteral::Kind::kEqual || !symbol) return out;
  for (std::size_t i = 0; i < literal.arguments.size(); ++i) {
    auto& argument = out.literal.arguments[i];
    const auto wanted = model.symbols[*symbol].arguments[i];
    if (argument.kind == Kind::kVariable) {
      if (std::find(taken.begin(), taken.end(), argument.name) == taken.end()) continue;
      const auto sort = sort_of_variable(model, argument.name);
      if (!sort || model.is_subsort(*sort, wanted)) continue;
    } else if (argument.kind != Kind::kTerm) {
      continue;
    }
    auto name = model.sorts[wanted].name;
    const auto is_taken = [&] {
      return std::find(out.names.begin(), out.names.end(), name) != out.names.end();
    };
    for (int k = 1; is_taken(); ++k) name = model.sorts[wanted].name + std::to_string(k);
    out.names.push_back(name);
    out.quantified += (out.quantified.empty() ? "" : ",") + name;
    out.equations += (out.equations.empty() ? "" : " & ") + name + "=" + argument.name;
    argument = {Kind::kVariable, name};
  }
  return out;
}

}  // namespace

std::string print_everywhere(const ConditionLiteral& literal, const TypedModel& model,
                             const std::string& time, const std::vector<std::string>& taken) {
  const auto narrow = narrowed(literal, model, taken);
  const auto text = print(narrow.literal, time, narrow.names);
  if (narrow.quantified.empty()) return text;
  return "({" + narrow.quantified + "} " + narrow.equations + " & " + text + ")";
}

std::string typing_of(const ConditionLiteral& literal, const TypedModel& model,
                      const std::vector<std::string>& taken) {
  const auto narrow = narrowed(literal, model, taken);
  if (narrow.quantified.empty()) return {};
  return "({" + narrow.quantified + "} " + narrow.equations + ")";
}

ConditionLiteral renamed(ConditionLiteral literal,
                         const std::map<std::string, std::string>& names) {
  for (auto& argument : literal.arguments) {
    const auto found = names.find(argument.name);
    if (argument.kind == Kind::kVariable && found != names.end()) argument.name = found->second;
    if (argument.kind == Kind::kTerm) argument.name = with_names(argument.name, names);
  }
  return literal;
}

std::string atom_pattern(const ConditionLiteral& literal,
                         const std::map<std::string, std::string>& values) {
  if (literal.kind == ConditionLiteral::Kind::kEqual) return {};
  std::string out = literal.symbol + "(";
  for (std::size_t i = 0; i < literal.arguments.size(); ++i) {
    const auto& argument = literal.arguments[i];
    const auto value = values.find(argument.name);
    out += i == 0 ? "" : ",";
    if (argument.kind == Kind::kConstant) {
      out += argument.name;
    } else if (argument.kind == Kind::kVariable && value != values.end()) {
      out += value->second;
    } else if (argument.kind == Kind::kTerm && number_of(argument.name, values)) {
      out += std::to_string(*number_of(argument.name, values));
    } else {
      out += "*";
    }
  }
  return out + ")";
}

bool matches(std::string_view atom, std::string_view pattern) {
  while (!atom.empty() && !pattern.empty()) {
    if (pattern.front() == '*') {
      pattern.remove_prefix(1);
      int depth = 0;
      while (!atom.empty() && (depth > 0 || (atom.front() != ',' && atom.front() != ')'))) {
        if (atom.front() == '(') ++depth;
        if (atom.front() == ')') --depth;
        atom.remove_prefix(1);
      }
      continue;
    }
    if (atom.front() != pattern.front()) return false;
    atom.remove_prefix(1);
    pattern.remove_prefix(1);
  }
  return atom.empty() && pattern.empty();
}

std::optional<SortId> sort_of_variable(const TypedModel& model, std::string_view name) {
  while (!name.empty() && name.back() >= '0' && name.back() <= '9') name.remove_suffix(1);
  return model.find_sort(name);
}

std::vector<std::string> variables_for(const TypedModel& model, const std::vector<SortId>& sorts) {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < sorts.size(); ++i) {
    const auto& name = model.sorts[sorts[i]].name;
    const auto same = std::count(sorts.begin(), sorts.end(), sorts[i]);
    const auto before =
        std::count(sorts.begin(), sorts.begin() + static_cast<std::ptrdiff_t>(i), sorts[i]);
    out.push_back(same > 1 ? name + std::to_string(before + 1) : name);
  }
  return out;
}

std::vector<std::string> constants_of(const TypedModel& model, SortId sort) {
  std::vector<std::string> out;
  for (const auto& object : model.objects) {
    const auto fits = [&](SortId of) { return model.is_subsort(of, sort); };
    if (std::any_of(object.sorts.begin(), object.sorts.end(), fits)) out.push_back(object.name);
  }
  for (auto& number : numerals_of(model, sort)) out.push_back(std::move(number));
  return out;
}

std::vector<ConditionLiteral> condition_literals(const TypedModel& model,
                                                 const std::vector<SortedVariable>& variables,
                                                 std::size_t most_each, bool constants) {
  std::vector<ConditionLiteral> out;
  for (const auto& symbol : model.symbols) {
    const bool is_fluent = symbol.kind == SymbolKind::kFluent;
    if (!is_fluent && symbol.kind != SymbolKind::kPredicate) continue;
    const auto uses = [&](std::optional<SortId> sort) {
      return sort && std::find(symbol.arguments.begin(), symbol.arguments.end(), *sort) !=
                         symbol.arguments.end();
    };
    // Predicates of the calculus, and those about timepoints, are never missing conditions.
    if (uses(model.core.time) || uses(model.core.event) || uses(model.core.fluent)) continue;
    add_symbol(model, symbol, symbol.arguments, variables, most_each, constants, out);
  }
  add_equations(model, variables, most_each, constants, out);
  return out;
}

}  // namespace parallax::compiler
