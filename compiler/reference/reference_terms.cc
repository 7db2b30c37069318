#include "compiler/reference/reference_terms.h"

#include <algorithm>

namespace parallax::compiler {

ReferenceTerms::ReferenceTerms(const TypedModel& model, ReferenceBudget& budget)
    : model_(model),
      budget_(budget),
      domains_(model.sorts.size()),
      members_(model.sorts.size()),
      listed_(model.sorts.size(), false) {
  for (std::size_t i = 0; i < model.sorts.size(); ++i) list_domain(model.sorts.id_at(i));
  for (const auto& entry : model.function_values) {
    std::vector<Value> arguments;
    for (const auto id : entry.arguments) {
      if (const auto value = term(id, {})) arguments.push_back(*value);
    }
    const auto value = term(entry.value, {});
    if (!value || arguments.size() != entry.arguments.size()) continue;
    const auto left = applied(model.symbols[entry.function], arguments);
    function_values_[intern(left, std::nullopt)] = *value;
  }
}

ReferenceTerms::Value ReferenceTerms::intern(const std::string& text,
                                             std::optional<std::int64_t> number) {
  const auto [found, is_new] = values_.emplace(text, static_cast<Value>(texts_.size()));
  if (is_new) {
    texts_.push_back(text);
    numbers_.push_back(number);
  }
  return found->second;
}

/// Subsorts first, then constants, ranges and constructor terms; each value once.
void ReferenceTerms::list_domain(SortId sort) {
  if (listed_[sort.index()]) return;
  listed_[sort.index()] = true;
  std::vector<Value> all;
  for (std::size_t i = 0; i < model_.sorts.size(); ++i) {
    const auto below = model_.sorts.id_at(i);
    const auto& parents = model_.sorts[below].parents;
    if (std::find(parents.begin(), parents.end(), sort) == parents.end()) continue;
    list_domain(below);
    const auto& inner = domain(below);
    all.insert(all.end(), inner.begin(), inner.end());
  }
  for (const auto object : model_.sorts[sort].constants) {
    if (budget_.spend()) all.push_back(intern(model_.objects[object].name, std::nullopt));
  }
  for (const auto& range : model_.sorts[sort].ranges) {
    for (auto i = range.lower; i <= range.upper && budget_.spend(); ++i) all.push_back(integer(i));
  }
  for (const auto& symbol : model_.symbols) {
    if (symbol.result == sort && symbol.kind != SymbolKind::kFunction) list_instances(symbol, all);
  }
  for (const auto value : all) {
    if (members_[sort.index()].insert(value).second) domains_[sort.index()].push_back(value);
  }
}

/// `Name(a,b)` for every combination of arguments.
void ReferenceTerms::list_instances(const Symbol& symbol, std::vector<Value>& out) {
  std::vector<std::vector<Value>> prefixes = {{}};
  for (const auto sort : symbol.arguments) {
    list_domain(sort);
    std::vector<std::vector<Value>> longer;
    for (const auto& prefix : prefixes) {
      for (const auto value : domain(sort)) {
        if (!budget_.spend()) return;
        longer.push_back(prefix);
        longer.back().push_back(value);
      }
    }
    prefixes = std::move(longer);
  }
  for (const auto& arguments : prefixes) {
    out.push_back(intern(applied(symbol, arguments), std::nullopt));
  }
}

bool ReferenceTerms::member(SortId sort, Value value) const {
  if (domain(sort).empty() && model_.sorts[sort].integer) return number(value).has_value();
  return members_[sort.index()].contains(value);
}

std::string ReferenceTerms::applied(const Symbol& symbol,
                                    const std::vector<Value>& arguments) const {
  std::string out = symbol.name + "(";
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (i > 0) out += ',';
    out += text(arguments[i]);
  }
  return out + ")";
}

std::optional<std::vector<ReferenceTerms::Value>> ReferenceTerms::arguments(
    const Symbol& symbol, const std::vector<TermId>& terms, const Environment& environment) {
  std::vector<Value> values;
  for (std::size_t i = 0; i < terms.size(); ++i) {
    const auto value = term(terms[i], environment);
    if (!value || !member(symbol.arguments[i], *value)) return std::nullopt;
    values.push_back(*value);
  }
  return values;
}

std::optional<ReferenceTerms::Value> ReferenceTerms::term(TermId id,
                                                          const Environment& environment) {
  const auto& node = model_.terms[id];
  switch (node.kind) {
    case TermKind::kVariable:
      return environment[node.variable.index()];
    case TermKind::kObject:
      return intern(model_.objects[node.object].name, std::nullopt);
    case TermKind::kInteger:
      return integer(node.integer);
    case TermKind::kArithmetic: {
      const auto left = term(node.arguments[0], environment);
      const auto right = term(node.arguments[1], environment);
      if (!left || !right) return std::nullopt;
      return arithmetic(node.op, *left, *right);
    }
    case TermKind::kApply: {
      const auto& symbol = model_.symbols[node.symbol];
      const auto values = arguments(symbol, node.arguments, environment);
      if (!values) return std::nullopt;
      const auto value = intern(applied(symbol, *values), std::nullopt);
      if (symbol.kind != SymbolKind::kFunction) return value;
      const auto found = function_values_.find(value);
      if (found == function_values_.end()) return std::nullopt;
      return found->second;
    }
  }
  return std::nullopt;
}

std::optional<ReferenceTerms::Value> ReferenceTerms::arithmetic(ArithmeticOp op, Value left,
                                                                Value right) {
  const auto a = number(left);
  const auto b = number(right);
  if (!a || !b) return std::nullopt;
  std::int64_t result = 0;
  bool overflow = false;
  switch (op) {
    case ArithmeticOp::kAdd:
      overflow = __builtin_add_overflow(*a, *b, &result);
      break;
    case ArithmeticOp::kSubtract:
      overflow = __builtin_sub_overflow(*a, *b, &result);
      break;
    case ArithmeticOp::kMultiply:
      overflow = __builtin_mul_overflow(*a, *b, &result);
      break;
    case ArithmeticOp::kDivide:
    case ArithmeticOp::kModulo: {
      // Quotients round towards zero. By -1 the smallest integer has none.
      const bool divide = op == ArithmeticOp::kDivide;
      if (*b == 0) return std::nullopt;
      if (*b == -1) {
        overflow = divide && __builtin_sub_overflow(std::int64_t{0}, *a, &result);
      } else {
        result = divide ? *a / *b : *a % *b;
      }
      break;
    }
  }
  if (overflow) return std::nullopt;
  return integer(result);
}

std::size_t ReferenceTerms::depth(const TypedModel& model, std::size_t limit) {
  // An argument is added to the store before the term around it.
  std::vector<std::size_t> depths(model.terms.size(), 1);
  std::size_t deepest = 0;
  for (std::size_t i = 0; i < depths.size() && deepest <= limit; ++i) {
    for (const auto argument : model.terms[model.terms.id_at(i)].arguments) {
      depths[i] = std::max(depths[i], depths[argument.index()] + 1);
    }
    deepest = std::max(deepest, depths[i]);
  }
  return std::min(deepest, limit + 1);
}

}  // namespace parallax::compiler
