// The leaves and atoms of formulas: everything that needs names and sorts.

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <limits>
#include <utility>

#include "compiler/base/codes/names.h"
#include "compiler/base/codes/texts.h"
#include "compiler/base/suggest.h"
#include "compiler/sema/elaborator.h"
#include "compiler/syntax/lexer.h"

namespace parallax::compiler {

namespace {

bool is_variable_name(std::string_view name) { return name[0] >= 'a' && name[0] <= 'z'; }

std::optional<CompareOp> compare_op(Operator op) {
  constexpr std::array<std::pair<Operator, CompareOp>, 6> kTable = {{
      {Operator::kEqual, CompareOp::kEqual},
      {Operator::kNotEqual, CompareOp::kNotEqual},
      {Operator::kLess, CompareOp::kLess},
      {Operator::kLessEqual, CompareOp::kLessEqual},
      {Operator::kGreater, CompareOp::kGreater},
      {Operator::kGreaterEqual, CompareOp::kGreaterEqual},
  }};
  for (const auto& [from, to] : kTable) {
    if (from == op) return to;
  }
  return std::nullopt;
}

std::optional<ArithmeticOp> arithmetic_op(Operator op) {
  constexpr std::array<std::pair<Operator, ArithmeticOp>, 5> kTable = {{
      {Operator::kAdd, ArithmeticOp::kAdd},
      {Operator::kSubtract, ArithmeticOp::kSubtract},
      {Operator::kMultiply, ArithmeticOp::kMultiply},
      {Operator::kDivide, ArithmeticOp::kDivide},
      {Operator::kModulo, ArithmeticOp::kModulo},
  }};
  for (const auto& [from, to] : kTable) {
    if (from == op) return to;
  }
  return std::nullopt;
}

}  // namespace

// --- names and numbers -----------------------------------------------------------------------

Elaborator::Value Elaborator::name(const Node& node, Position position,
                                   std::optional<SortId> expected) {
  const auto text = ast_->name(node);
  if (position == Position::kFormula) {
    const bool variable = is_variable_name(text);
    auto report = sink_.error(codes::kExpectedFormula, source(node),
                              variable ? "variable" : "constant", quoted(node));
    const auto symbol = variable ? std::nullopt : model_.find_symbol(text);
    if (temporal_operator(text)) {
      report.fix("`" + quoted(node) + "` is an operator here if a formula follows it");
    }
    if (symbol && model_.symbols[*symbol].kind == SymbolKind::kPredicate) {
      report.fix("write the predicate with its arguments, as in `" +
                 signature(model_, model_.symbols[*symbol]) + "`");
    }
    return failure();
  }
  if (reported_free_.contains(text)) return failure();
  const auto bound = scope_.find(text);
  const bool is_bound = bound != scope_.end() && !bound->second.empty();
  return is_bound || is_variable_name(text) ? variable(node, expected) : constant(node, expected);
}

Elaborator::Value Elaborator::variable(const Node& node, std::optional<SortId> expected) {
  const auto text = ast_->name(node);
  Term term;
  term.kind = TermKind::kVariable;
  term.source = source(node);
  const auto bound = scope_.find(text);
  if (bound != scope_.end() && !bound->second.empty()) {
    term.variable = bound->second.back();
    return add(std::move(term));
  }
  if (options_.allow_free_time && text == "time" && model_.core.time) {
    return {time_term(source(node)).index(), false};
  }
  // Constants may be spelled like variables (`r1`); a quantifier around the name goes first.
  if (model_.find_object(text)) return constant(node, expected);
  if (const auto free = free_variable(node)) {
    term.variable = *free;
    return add(std::move(term));
  }
  if (reported_free_.insert(text).second) report_free(node, expected);
  return failure();
}

/// A new variable, bound around everything that is still to come.
std::optional<VariableId> Elaborator::free_variable(const Node& node) {
  if (!options_.allow_free_variables) return std::nullopt;
  const auto name = ast_->name(node);
  const auto sort = model_.find_sort(sort_of_variable(name));
  if (!sort) return std::nullopt;
  if (model_.sorts[*sort].integer) require_range(*sort, source(node));
  const auto variable = model_.variables.add({std::string(name), *sort});
  free_variables_.push_back(variable);
  free_names_.push_back(name);
  scope_[name].push_back(variable);
  return variable;
}

void Elaborator::report_free(const Node& node, std::optional<SortId> expected) {
  const auto text = ast_->name(node);
  if (model_.misdeclared.contains(text)) return;
  const std::vector<std::string> names(bound_names_.begin(), bound_names_.end());
  const auto near = base::nearest_name(text, names);
  // `r3` beside the constants `r1` and `r2` is no forgotten quantifier.
  if (!near && !model_.find_sort(sort_of_variable(text)) && advice_.object(text)) {
    return report_constant(node, expected);
  }
  auto report = sink_.error(codes::kFreeVariable, source(node), quoted(node));
  if (near) report.fix(NameAdvice::replace(text, *near));
}

TermId Elaborator::time_term(const base::SourceRange& at) {
  if (!free_time_) free_time_ = model_.variables.add({"time", *model_.core.time});
  Term term;
  term.kind = TermKind::kVariable;
  term.variable = *free_time_;
  term.source = at;
  return model_.terms.add(std::move(term));
}

Elaborator::Value Elaborator::constant(const Node& node, std::optional<SortId> expected) {
  const auto object = model_.find_object(ast_->name(node));
  if (!object) {
    report_constant(node, expected);
    return failure();
  }
  Term term;
  term.kind = TermKind::kObject;
  term.object = *object;
  term.source = source(node);
  return add(std::move(term));
}

void Elaborator::report_constant(const Node& node, std::optional<SortId> expected) {
  const auto text = ast_->name(node);
  if (model_.misdeclared.contains(text)) return;
  auto report = sink_.error(codes::kUnknownName, source(node), "constant", shortened(text), "");
  if (const auto symbol = model_.find_symbol(text)) {
    const auto& found = model_.symbols[*symbol];
    report.note(found.declared, "`" + signature(model_, found) + "` declared here");
    report.fix(found.arguments.empty() ? "write `" + found.name + "()`"
                                       : "write `" + found.name + "` with its arguments");
  } else if (const auto near = advice_.object(text)) {
    const auto& found = model_.objects[*near];
    report.note(found.declared, "`" + shortened(found.name) + "` declared here");
    report.fix(NameAdvice::replace(text, found.name));
  }
  if (!expected) return;
  const auto& sort = model_.sorts[*expected];
  const auto constants = sort.reified || sort.integer ? "" : advice_.constants_of(*expected);
  if (!constants.empty()) report.note(sort.declared, constants);
}

Elaborator::Value Elaborator::number(const Node& node, const Node* minus) {
  const auto text = (minus != nullptr ? "-" : "") + std::string(ast_->name(node));
  Term term;
  term.source = source(minus != nullptr ? *minus : node);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), term.integer);
  if (error == std::errc::result_out_of_range) {
    sink_.error(codes::kNumberTooLarge, source(node), quoted(node));
    return failure();
  }
  if (end != text.data() + text.size()) {
    sink_.error(codes::kDecimalNumber, source(node), quoted(node));
    return failure();
  }
  return add(std::move(term));
}

// --- atoms and applications ------------------------------------------------------------------

void Elaborator::report_unknown_symbol(const Node& node, Position position,
                                       std::optional<SortId> expected) {
  constexpr std::array<SymbolKind, 1> kPredicates = {SymbolKind::kPredicate};
  constexpr std::array<SymbolKind, 4> kTerms = {SymbolKind::kFluent, SymbolKind::kEvent,
                                                SymbolKind::kReified, SymbolKind::kFunction};
  const auto text = ast_->name(node);
  if (model_.misdeclared.contains(text)) return;
  const bool term = position == Position::kTerm;
  std::string what = term ? "function" : "predicate";
  if (term && expected && model_.sorts[*expected].reified) what = model_.sorts[*expected].name;
  auto report = sink_.error(codes::kUnknownName, ast_->name_source(node), what, shortened(text),
                            node.child_count == 0
                                ? std::string()
                                : " of " + std::to_string(node.child_count) + " argument(s)");
  if (const auto object = model_.find_object(text); object && term) {
    const auto& found = model_.objects[*object];
    report.note(found.declared, "the constant `" + shortened(found.name) + "` is declared here");
    report.fix("write `" + shortened(text) + "` without parentheses");
    return;
  }
  if (const auto advice = calculus_advice(text, node.child_count); !term && !advice.empty()) {
    report.fix(std::string(advice));
    return;
  }
  const auto near = term ? advice_.symbol(text, kTerms) : advice_.symbol(text, kPredicates);
  if (near) {
    const auto& found = model_.symbols[*near];
    report.note(found.declared, "`" + signature(model_, found) + "` declared here");
    report.fix(NameAdvice::replace(text, found.name));
    mentioned_[near->index()] = true;
  }
}

std::vector<SortId> Elaborator::sorts_of(TermId id) const {
  const Term& term = model_.terms[id];
  switch (term.kind) {
    case TermKind::kVariable:
      return {model_.variables[term.variable].sort};
    case TermKind::kObject:
      return model_.objects[term.object].sorts;
    case TermKind::kApply:
      if (const auto& result = model_.symbols[term.symbol].result) return {*result};
      return {};
    case TermKind::kInteger:
    case TermKind::kArithmetic:
      if (model_.core.integer) return {*model_.core.integer};
      return {};
  }
  return {};
}

bool Elaborator::is_integer(TermId id) const {
  const Term& term = model_.terms[id];
  if (term.kind == TermKind::kInteger || term.kind == TermKind::kArithmetic) return true;
  for (const auto sort : sorts_of(id)) {
    if (model_.sorts[sort].integer) return true;
  }
  return false;
}

bool Elaborator::check_argument(const Symbol& symbol, std::size_t position, TermId id) {
  const auto expected = symbol.arguments[position];
  const Term& term = model_.terms[id];
  const bool integer = model_.sorts[expected].integer;
  bool fits = false;
  if (term.kind == TermKind::kInteger && integer) {
    // Where a range is missing, that is reported instead.
    if (domains_.ranges(expected).empty() || domains_.contains(expected, term.integer)) return true;
    auto report =
        sink_.error(codes::kOutsideRange, term.source, term.integer, model_.sorts[expected].name);
    const auto& range = domains_.ranges(expected).front();
    if (model_.core.time == expected && range.declared == model_.sorts[expected].declared) {
      report.note(fmt::format("the timepoints are {} to {}, as the horizon says", range.lower,
                              range.upper));
      report.fix("use an earlier timepoint, or a greater horizon");
    } else {
      report.note(range.declared, "its range is given here");
    }
    return false;
  }
  if (term.kind == TermKind::kArithmetic || term.kind == TermKind::kInteger) {
    fits = integer;
  } else if (term.kind == TermKind::kObject) {
    for (const auto sort : model_.objects[term.object].sorts) {
      fits = fits || model_.is_subsort(sort, expected);
    }
  } else {
    for (const auto sort : sorts_of(id)) fits = fits || domains_.overlap(sort, expected);
  }
  if (fits) return true;
  auto report = sink_.error(codes::kWrongSort, term.source, position + 1, shortened(symbol.name),
                            model_.sorts[expected].name, quoted(id), sort_name(model_, id));
  report.note(symbol.declared, "`" + signature(model_, symbol) + "` declared here");
  if (term.kind == TermKind::kObject) {
    report.note(model_.objects[term.object].declared, "`" + quoted(id) + "` declared here");
  }
  return false;
}

Elaborator::Value Elaborator::apply(const Frame& frame, const Node& node) {
  const Symbol& symbol = model_.symbols[*frame.symbol];
  std::vector<TermId> arguments;
  bool fits = true;
  for (std::size_t i = frame.values; i < values_.size(); ++i) {
    arguments.push_back(TermId(values_[i].id));
    fits = check_argument(symbol, i - frame.values, arguments.back()) && fits;
  }
  if (!fits) return failure();
  if (frame.position == Position::kTerm) {
    Term term;
    term.kind = TermKind::kApply;
    term.symbol = *frame.symbol;
    term.arguments = std::move(arguments);
    term.source = source(node);
    return add(std::move(term));
  }
  if (symbol.kind == SymbolKind::kFluent) return fluent_atom(frame, node, std::move(arguments));
  const auto& core = model_.core;
  for (const auto& effect :
       {core.initiates, core.terminates, core.releases, core.trajectory, core.anti_trajectory}) {
    if (effect != frame.symbol) continue;
    mentions_effects_ = true;
    if (is_inside_aggregate()) {
      sink_.error(codes::kInsideAggregate, source(node), symbol.name);
      return failure();
    }
    if (!options_.allow_effects) {
      sink_.error(codes::kEffectNotAllowed, source(node), symbol.name);
      return failure();
    }
  }
  TypedFormula formula;
  formula.kind = FormulaKind::kAtom;
  formula.predicate = *frame.symbol;
  formula.terms = std::move(arguments);
  formula.source = source(node);
  return add(std::move(formula));
}

Elaborator::Value Elaborator::fluent_atom(const Frame& frame, const Node& node,
                                          std::vector<TermId> arguments) {
  if (!model_.core.holds_at || !model_.core.time) {
    sink_.error(codes::kMissingFoundation, source(node), quoted(node));
    return failure();
  }
  Term fluent;
  fluent.kind = TermKind::kApply;
  fluent.symbol = *frame.symbol;
  fluent.arguments = std::move(arguments);
  fluent.source = source(node);
  const auto term = add(std::move(fluent));
  if (term.failed) return term;
  TypedFormula formula;
  formula.kind = FormulaKind::kAtom;
  formula.predicate = *model_.core.holds_at;
  formula.terms = {TermId(term.id),
                   options_.fluent_time ? *options_.fluent_time : time_term(source(node))};
  formula.source = source(node);
  return add(std::move(formula));
}

// --- integers and comparisons ----------------------------------------------------------------

bool Elaborator::check_integer(Operator op, TermId term) {
  if (is_integer(term)) return true;
  sink_.error(codes::kNotAnInteger, model_.terms[term].source, spelling(op), quoted(term),
              sort_name(model_, term));
  return false;
}

bool Elaborator::check_integers(Operator op, TermId left, TermId right) {
  const bool left_fits = check_integer(op, left);  // both complaints, if there are two
  return check_integer(op, right) && left_fits;
}

Elaborator::Value Elaborator::negation_of_term(const Node& node, TermId operand) {
  if (!check_integer(node.op, operand)) return failure();
  Term& term = model_.terms[operand];
  if (term.kind == TermKind::kInteger) {  // a literal such as -(-1)
    if (term.integer == std::numeric_limits<std::int64_t>::min()) {
      sink_.error(codes::kNumberTooLarge, source(node), quoted(node));
      return failure();
    }
    term.integer = -term.integer;
    term.source = source(node);
    return {operand.index(), false};
  }
  Term zero;
  zero.source = source(node);
  const auto left = add(std::move(zero));
  return left.failed ? left : arithmetic(node, TermId(left.id), operand);
}

Elaborator::Value Elaborator::arithmetic(const Node& node, TermId left, TermId right) {
  if (!check_integers(node.op, left, right)) return failure();
  Term term;
  term.kind = TermKind::kArithmetic;
  term.op = node.op == Operator::kNegate ? ArithmeticOp::kSubtract : *arithmetic_op(node.op);
  term.arguments = {left, right};
  term.source = source(node);
  return add(std::move(term));
}

Elaborator::Value Elaborator::comparison(const Node& node, TermId left, TermId right) {
  const auto op = *compare_op(node.op);
  if (op != CompareOp::kEqual && op != CompareOp::kNotEqual) {
    if (!check_integers(node.op, left, right)) return failure();
  } else {
    bool may_be_equal = is_integer(left) && is_integer(right);
    for (const auto a : sorts_of(left)) {
      for (const auto b : sorts_of(right)) may_be_equal = may_be_equal || domains_.overlap(a, b);
    }
    if (!may_be_equal) {
      sink_.error(codes::kNeverEqual, source(node), quoted(left), sort_name(model_, left),
                  quoted(right), sort_name(model_, right));
      return failure();
    }
  }
  TypedFormula formula;
  formula.kind = FormulaKind::kCompare;
  formula.compare = op;
  formula.terms = {left, right};
  formula.source = source(node);
  return add(std::move(formula));
}

/// Without the number that it is compared with, which the comparison adds.
Elaborator::Value Elaborator::aggregate(const Frame& frame, const Node& node) {
  TypedFormula formula;
  formula.kind = FormulaKind::kAggregate;
  formula.variables = frame.variables;
  formula.children = {TypedFormulaId(values_.back().id)};
  if (node.kind == NodeKind::kSum) {
    const auto weight = TermId(values_[frame.values].id);
    if (!is_integer(weight)) {
      sink_.error(codes::kNotAnInteger, model_.terms[weight].source, "sum", quoted(weight),
                  sort_name(model_, weight));
      return failure();
    }
    formula.terms = {weight};
  }
  formula.source = source(node);
  return add(std::move(formula));
}

Elaborator::Value Elaborator::aggregate_comparison(const Node& node, bool turned,
                                                   const Value& counted, TermId number) {
  if (!check_integer(node.op, number)) return failure();
  const auto op = *compare_op(node.op);
  auto& formula = model_.formulas[TypedFormulaId(counted.id)];
  formula.compare = turned ? mirrored(op) : op;
  formula.terms.insert(formula.terms.begin(), number);
  formula.source = source(node);
  return counted;
}

}  // namespace parallax::compiler
