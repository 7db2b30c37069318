#include "tests/fuzz/old_terms.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace parallax::test {

using compiler::CompareOp;
using compiler::SymbolKind;
using compiler::TermKind;
using compiler::TypedFormula;

OldTerms::OldTerms(const compiler::TypedModel& model) : model_(model) {
  for (const auto& entry : model.function_values) {
    std::string key = model.symbols[entry.function].name;
    for (const auto argument : entry.arguments) key += "|" + term(argument).text;
    functions_[key] = term(entry.value);
  }
}

const std::vector<OldValue>& OldTerms::domain(compiler::SortId sort) {
  const auto known = domains_.find(sort.index());
  if (known != domains_.end()) return known->second;
  std::vector<OldValue> all;
  const auto add = [&](OldValue value) {
    const auto same = [&](const OldValue& other) { return other.text == value.text; };
    if (std::none_of(all.begin(), all.end(), same)) all.push_back(std::move(value));
  };
  for (std::size_t i = 0; i < model_.sorts.size(); ++i) {
    const auto below = model_.sorts.id_at(i);
    if (!model_.is_subsort(below, sort)) continue;
    for (const auto object : model_.sorts[below].constants) {
      add({model_.objects[object].name, false, 0, false, true});
    }
    for (const auto& range : model_.sorts[below].ranges) {
      for (auto n = range.lower; n <= range.upper; ++n) {
        add({std::to_string(n), true, n, false, true});
      }
    }
    for (std::size_t s = 0; s < model_.symbols.size(); ++s) {
      const auto symbol = model_.symbols.id_at(s);
      if (model_.symbols[symbol].kind == SymbolKind::kFunction ||
          model_.symbols[symbol].result != below) {
        continue;
      }
      for (auto& made : instances(symbol)) add(std::move(made));
    }
  }
  return domains_.emplace(sort.index(), std::move(all)).first->second;
}

std::vector<OldValue> OldTerms::instances(compiler::SymbolId symbol) {
  std::vector<std::vector<OldValue>> tuples = {{}};
  for (const auto sort : model_.symbols[symbol].arguments) {
    std::vector<std::vector<OldValue>> longer;
    for (const auto& tuple : tuples) {
      for (const auto& value : domain(sort)) {
        longer.push_back(tuple);
        longer.back().push_back(value);
      }
    }
    tuples = std::move(longer);
  }
  std::vector<OldValue> made;
  for (const auto& tuple : tuples) made.push_back(applied(symbol, tuple));
  return made;
}

bool OldTerms::fits(compiler::SortId sort, const OldValue& value) {
  if (!value.fits) return false;
  if (value.is_reified) return true;
  const auto& all = domain(sort);
  if (all.empty() && model_.sorts[sort].integer) return value.is_integer;
  return std::any_of(all.begin(), all.end(),
                     [&](const OldValue& other) { return other.text == value.text; });
}

OldValue OldTerms::applied(compiler::SymbolId symbol, const std::vector<OldValue>& arguments) {
  const auto& about = model_.symbols[symbol];
  OldValue made{about.name + "(", false, 0, true, true};
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    made.text += (i > 0 ? "," : "") + arguments[i].text;
    made.fits = made.fits && fits(about.arguments[i], arguments[i]);
  }
  made.text += ")";
  return made;
}

OldValue OldTerms::term(compiler::TermId id) {
  const auto& node = model_.terms[id];
  const auto integer = [](std::int64_t n) {
    return OldValue{std::to_string(n), true, n, false, true};
  };
  switch (node.kind) {
    case TermKind::kVariable:
      return values_.at(node.variable.index());
    case TermKind::kObject:
      return {model_.objects[node.object].name, false, 0, false, true};
    case TermKind::kInteger:
      return integer(node.integer);
    case TermKind::kArithmetic: {
      const auto a = term(node.arguments[0]), b = term(node.arguments[1]);
      return integer(computed(node.op, a.number, b.number));
    }
    case TermKind::kApply: {
      std::vector<OldValue> arguments;
      for (const auto argument : node.arguments) arguments.push_back(term(argument));
      if (model_.symbols[node.symbol].kind != SymbolKind::kFunction) {
        return applied(node.symbol, arguments);
      }
      std::string key = model_.symbols[node.symbol].name;
      for (const auto& argument : arguments) key += "|" + argument.text;
      const auto value = functions_.find(key);
      if (value != functions_.end()) return value->second;
      beyond_ = "a function without a value";
      return integer(0);
    }
  }
  return integer(0);
}

std::int64_t OldTerms::computed(compiler::ArithmeticOp op, std::int64_t a, std::int64_t b) {
  using Op = compiler::ArithmeticOp;
  if ((op == Op::kDivide || op == Op::kModulo) && b == 0) {
    beyond_ = "a division by zero";
    return 0;
  }
  switch (op) {
    case Op::kAdd:
      return a + b;
    case Op::kSubtract:
      return a - b;
    case Op::kMultiply:
      return a * b;
    case Op::kDivide:
      return a / b;
    case Op::kModulo:
      return a % b;
  }
  return 0;
}

bool OldTerms::compare(const TypedFormula& formula) {
  const auto a = term(formula.terms[0]), b = term(formula.terms[1]);
  const bool numbers = a.is_integer && b.is_integer;
  switch (formula.compare) {
    case CompareOp::kEqual:
      return a.text == b.text;
    case CompareOp::kNotEqual:
      return a.text != b.text;
    case CompareOp::kLess:
      return numbers && a.number < b.number;
    case CompareOp::kLessEqual:
      return numbers && a.number <= b.number;
    case CompareOp::kGreater:
      return numbers && a.number > b.number;
    case CompareOp::kGreaterEqual:
      return numbers && a.number >= b.number;
  }
  return false;
}

/// Visits every assignment of the variables.
void OldTerms::each_assignment(const std::vector<compiler::VariableId>& variables,
                               std::size_t number, const std::function<void()>& visit) {
  if (number == variables.size()) return visit();
  const auto variable = variables[number];
  const auto before = values_.find(variable.index()) == values_.end()
                          ? std::nullopt
                          : std::optional(values_.at(variable.index()));
  for (const auto& value : domain(model_.variables[variable].sort)) {
    values_[variable.index()] = value;
    each_assignment(variables, number + 1, visit);
  }
  values_.erase(variable.index());
  if (before) values_[variable.index()] = *before;
}

}  // namespace parallax::test
