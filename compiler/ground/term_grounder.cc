#include "compiler/ground/term_grounder.h"

#include <array>
#include <limits>
#include <utility>

#include "compiler/base/codes/grounding.h"

namespace parallax::compiler {
namespace {

constexpr std::size_t kFewArguments = 6;

}  // namespace

TermGrounder::TermGrounder(GroundModel& model, const GroundOptions& options,
                           base::DiagnosticSink& sink)
    : model_(&model),
      typed_(&model.typed()),
      options_(options),
      sink_(&sink),
      environment_(model.typed().variables.size()) {
  read_function_values();
}

void TermGrounder::start(base::SourceRange blame) {
  if (spent_ > 0) model_->charge(blame_, spent_);
  spent_ = 0;
  failed_ = false;
  blame_ = blame;
  if (environment_.size() < typed_->variables.size()) {
    environment_.resize(typed_->variables.size());
  }
}

bool TermGrounder::spend(std::int64_t more) {
  if (failed_) return false;
  if (__builtin_add_overflow(spent_, more, &spent_)) {
    spent_ = std::numeric_limits<std::int64_t>::max();
  }
  if (spent_ > options_.max_instances) {
    sink_->error(codes::kTooManyInstances, blame_, options_.max_instances);
    failed_ = true;
  }
  if (!failed_ && options_.stop != nullptr && options_.stop->load(std::memory_order_relaxed)) {
    sink_->error(codes::kGroundingStopped, blame_);
    failed_ = true;
  }
  return !failed_;
}

std::optional<bool> TermGrounder::compare(const TypedFormula& formula) {
  const auto left = term(formula.terms[0]);
  const auto right = term(formula.terms[1]);
  if (!left || !right) return std::nullopt;
  // Terms are equal if they are the same; only integers have an order.
  if (formula.compare == CompareOp::kEqual) return *left == *right;
  if (formula.compare == CompareOp::kNotEqual) return *left != *right;
  return compares(model_->terms()[*left].integer, formula.compare, model_->terms()[*right].integer);
}

bool TermGrounder::arguments_fit(const Symbol& symbol,
                                 std::span<const GroundTermId> arguments) const {
  if (arguments.size() != symbol.arguments.size()) return false;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (!in_sort(symbol.arguments[i], arguments[i])) return false;
  }
  return true;
}

/// The value of a symbol over variables, integers and constants, which is what most terms are; no
/// value at all for other terms.
std::optional<std::optional<GroundTermId>> TermGrounder::flat_term(const Term& node) {
  std::array<GroundTermId, kFewArguments> values{};
  for (std::size_t i = 0; i < node.arguments.size(); ++i) {
    const auto& argument = typed_->terms[node.arguments[i]];
    std::optional<GroundTermId> value;
    if (argument.kind == TermKind::kVariable) {
      value = environment_[argument.variable.index()];
    } else if (argument.kind == TermKind::kInteger) {
      value = model_->terms().integer(argument.integer);
    } else if (argument.kind == TermKind::kObject) {
      value = model_->terms().object(argument.object);
    } else {
      return std::nullopt;
    }
    if (!value) return std::optional<GroundTermId>();
    values[i] = *value;
  }
  return apply(node, std::span(values).first(node.arguments.size()));
}

std::optional<GroundTermId> TermGrounder::term(TermId root) {
  const auto& top = typed_->terms[root];
  if (top.kind == TermKind::kVariable) return environment_[top.variable.index()];
  if (top.kind == TermKind::kInteger) return model_->terms().integer(top.integer);
  if (top.kind == TermKind::kObject) return model_->terms().object(top.object);
  if (top.kind == TermKind::kApply && top.arguments.size() <= kFewArguments) {
    if (const auto value = flat_term(top)) return *value;
  }
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
        const auto count = node.arguments.size();
        value = apply(node, std::span(values).last(count));
        values.resize(values.size() - count);
        break;
      }
    }
    if (!value) return std::nullopt;
    values.push_back(*value);
    stack.pop_back();
  }
  return values.back();
}

void TermGrounder::report_overflow(const base::SourceRange& source) {
  sink_->error(codes::kIntegerOverflow, source);
  failed_ = true;
}

std::optional<GroundTermId> TermGrounder::arithmetic(const Term& node, GroundTermId left,
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
        sink_->error(codes::kDivisionByZero, node.source);
        failed_ = true;
        return std::nullopt;
      }
      overflow = b == -1 && __builtin_sub_overflow(std::int64_t{0}, a, &value);
      if (b != -1) value = node.op == ArithmeticOp::kDivide ? a / b : a % b;
      if (b == -1 && node.op == ArithmeticOp::kModulo) value = 0;
      break;
  }
  if (overflow) {
    report_overflow(node.source);
    return std::nullopt;
  }
  return model_->terms().integer(value);
}

std::optional<GroundTermId> TermGrounder::apply(const Term& node,
                                                std::span<const GroundTermId> arguments) {
  const auto& symbol = typed_->symbols[node.symbol];
  // The 2005 reasoner looks at sorts in atoms alone: compared with something, any term denotes.
  const bool checks =
      options_.meaning == Meaning::kStandard || symbol.kind == SymbolKind::kFunction;
  if (checks && !arguments_fit(symbol, arguments)) return std::nullopt;
  if (symbol.kind == SymbolKind::kFunction) {
    const auto application = model_->terms().apply(node.symbol, arguments);
    const auto value = function_values_.find(application);
    if (value != function_values_.end()) return value->second;
    sink_->error(codes::kFunctionWithoutValue, node.source, symbol.name);
    failed_ = true;
    return std::nullopt;
  }
  return model_->terms().apply(node.symbol, arguments);
}

void TermGrounder::read_function_values() {
  for (const auto& entry : typed_->function_values) {
    std::vector<GroundTermId> arguments;
    for (const auto id : entry.arguments) {
      if (const auto argument = term(id)) arguments.push_back(*argument);
    }
    const auto value = term(entry.value);
    if (!value || arguments.size() != entry.arguments.size()) continue;
    function_values_.emplace(model_->terms().apply(entry.function, arguments), *value);
  }
}

}  // namespace parallax::compiler
