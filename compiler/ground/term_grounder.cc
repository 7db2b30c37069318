#include <utility>

#include "compiler/ground/formula_grounder.h"

namespace parallax::compiler {

using base::DiagnosticCode;

std::optional<GroundTermId> FormulaGrounder::term(TermId root) {
  // Post-order without recursion: (term, how many of its arguments are done).
  std::vector<std::pair<TermId, std::size_t>> stack = {{root, 0}};
  std::vector<GroundTermId> values;
  while (!stack.empty()) {
    auto& [id, done] = stack.back();
    const auto& node = typed_->terms[id];
    if (done < node.arguments.size()) {
      const auto child = node.arguments[done++];
      stack.emplace_back(child, 0);
      continue;
    }
    std::optional<GroundTermId> value;
    switch (node.kind) {
      case TermKind::kVariable:
        value = environment_[node.variable.index()];
        break;
      case TermKind::kObject:
        value = model_->terms().object(node.object);
        break;
      case TermKind::kInteger:
        value = model_->terms().integer(node.integer);
        break;
      case TermKind::kArithmetic: {
        const auto right = values.back();
        values.pop_back();
        const auto left = values.back();
        values.pop_back();
        value = arithmetic(node, left, right);
        break;
      }
      case TermKind::kApply: {
        const auto begin = values.end() - static_cast<std::ptrdiff_t>(node.arguments.size());
        std::vector<GroundTermId> arguments(begin, values.end());
        values.erase(begin, values.end());
        value = apply(node, std::move(arguments));
        break;
      }
    }
    if (!value) return std::nullopt;
    values.push_back(*value);
    stack.pop_back();
  }
  return values.back();
}

std::optional<GroundTermId> FormulaGrounder::arithmetic(const Term& node, GroundTermId left,
                                                        GroundTermId right) {
  const auto& terms = model_->terms();
  if (terms[left].kind != TermKind::kInteger || terms[right].kind != TermKind::kInteger) {
    return std::nullopt;
  }
  const auto a = terms[left].integer;
  const auto b = terms[right].integer;
  std::int64_t value = 0;
  bool overflow = false;
  switch (node.op) {
    case ArithmeticOp::kAdd:
      overflow = __builtin_add_overflow(a, b, &value);
      break;
    case ArithmeticOp::kSubtract:
      overflow = __builtin_sub_overflow(a, b, &value);
      break;
    case ArithmeticOp::kMultiply:
      overflow = __builtin_mul_overflow(a, b, &value);
      break;
    case ArithmeticOp::kDivide:
    case ArithmeticOp::kModulo:
      if (b == 0) {
        sink_->error(DiagnosticCode::kDivisionByZero, node.source);
        failed_ = true;
        return std::nullopt;
      }
      overflow = b == -1 && __builtin_sub_overflow(std::int64_t{0}, a, &value);
      if (b != -1) value = node.op == ArithmeticOp::kDivide ? a / b : a % b;
      if (b == -1 && node.op == ArithmeticOp::kModulo) value = 0;
      break;
  }
  if (overflow) {
    sink_->error(DiagnosticCode::kIntegerOverflow, node.source);
    failed_ = true;
    return std::nullopt;
  }
  return model_->terms().integer(value);
}

std::optional<GroundTermId> FormulaGrounder::apply(const Term& node,
                                                   std::vector<GroundTermId> arguments) {
  const auto& symbol = typed_->symbols[node.symbol];
  if (!arguments_fit(symbol, arguments)) return std::nullopt;
  if (symbol.kind == SymbolKind::kFunction) {
    const auto application = model_->terms().apply(node.symbol, std::move(arguments));
    const auto value = function_values_.find(application);
    if (value != function_values_.end()) return value->second;
    sink_->error(DiagnosticCode::kFunctionWithoutValue, node.source, symbol.name);
    failed_ = true;
    return std::nullopt;
  }
  return model_->terms().apply(node.symbol, std::move(arguments));
}

void FormulaGrounder::read_function_values() {
  for (const auto& entry : typed_->function_values) {
    std::vector<GroundTermId> arguments;
    for (const auto id : entry.arguments) {
      if (const auto argument = term(id)) arguments.push_back(*argument);
    }
    const auto value = term(entry.value);
    if (!value || arguments.size() != entry.arguments.size()) continue;
    function_values_.emplace(model_->terms().apply(entry.function, std::move(arguments)), *value);
  }
}

}  // namespace parallax::compiler
