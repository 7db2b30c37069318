#include "compiler/sema/elaborator.h"

#include <algorithm>
#include <utility>

#include "compiler/base/codes/names.h"
#include "compiler/syntax/lexer.h"

namespace parallax::compiler {

namespace {

bool is_connective(Operator op) {
  return op == Operator::kImplies || op == Operator::kIff || op == Operator::kOr ||
         op == Operator::kAnd || is_temporal(op);
}

/// Both list the operators in the same order.
TemporalOp temporal_op(Operator op) {
  return static_cast<TemporalOp>(static_cast<int>(op) - static_cast<int>(Operator::kAlways));
}
static_assert(static_cast<int>(Operator::kSince) - static_cast<int>(Operator::kAlways) ==
              static_cast<int>(TemporalOp::kSince));

}  // namespace

std::string_view sort_of_variable(std::string_view name) {
  while (!name.empty() && name.back() >= '0' && name.back() <= '9') name.remove_suffix(1);
  return name;
}

Elaborator::Elaborator(TypedModel& model, const ElaborationOptions& options,
                       base::DiagnosticSink& sink)
    : model_(model),
      options_(options),
      sink_(sink),
      advice_(model, sink),
      domains_(model),
      mentioned_(model.symbols.size()) {}

std::optional<TypedFormulaId> Elaborator::elaborate(const Ast& ast, NodeId root) {
  ast_ = &ast;
  frames_.clear();
  values_.clear();
  scope_.clear();
  for (std::size_t i = 0; i < free_variables_.size(); ++i) {
    scope_[free_names_[i]].push_back(free_variables_[i]);
  }
  bound_names_.clear();
  reported_free_.clear();
  free_time_.reset();
  mentions_effects_ = false;
  visit(root, Position::kFormula, std::nullopt);
  while (!frames_.empty()) advance();
  if (values_.back().failed) return std::nullopt;
  return TypedFormulaId(values_.back().id);
}

// --- the walk --------------------------------------------------------------------------------

/// Leaves a value, or a frame that will leave one.
void Elaborator::visit(NodeId id, Position position, std::optional<SortId> expected) {
  const Node& node = (*ast_)[id];
  if (node.kind == NodeKind::kName) {
    values_.push_back(name(node, position, expected));
    return;
  }
  if (node.kind == NodeKind::kNumber) {
    if (position == Position::kFormula) {
      sink_.error(codes::kExpectedFormula, source(node), "number", quoted(node));
      values_.push_back(failure());
    } else {
      values_.push_back(number(node));
    }
    return;
  }
  if (node.kind == NodeKind::kUnary && node.op == Operator::kNegate &&
      position != Position::kFormula) {
    const Node& operand = (*ast_)[ast_->child(node, 0)];
    if (operand.kind == NodeKind::kNumber) {
      values_.push_back(number(operand, &node));
      return;
    }
  }
  Frame frame;
  frame.node = id;
  frame.position = position;
  frame.end_child = node.child_count;
  frame.values = values_.size();
  frame.expected = expected;
  enter(frame, node);
  frames_.push_back(std::move(frame));
}

void Elaborator::advance() {
  Frame& top = frames_.back();
  const Node& node = (*ast_)[top.node];
  if (top.next_child < top.end_child && !full_) {
    const auto index = top.next_child++;
    std::optional<SortId> expected;
    if (top.symbol && index < model_.symbols[*top.symbol].arguments.size()) {
      expected = model_.symbols[*top.symbol].arguments[index];
    } else if (node.kind == NodeKind::kBinary && is_comparison(node.op)) {
      expected = sort_beside(node, index);
    }
    const bool weight = node.kind == NodeKind::kSum && index == node.bound_count();
    visit(ast_->child(node, index), weight ? Position::kTerm : top.child_position, expected);
    return;
  }
  Frame frame = std::move(top);
  frames_.pop_back();
  unbind(frame);
  for (std::size_t i = frame.values; i < values_.size(); ++i) {
    frame.failed = frame.failed || values_[i].failed;
  }
  frame.failed = frame.failed || full_;
  const Value value = frame.failed ? failure() : leave(frame, node);
  values_.resize(frame.values);
  values_.push_back(value);
}

/// Sort that the other side of a comparison suggests for this one, for messages.
std::optional<SortId> Elaborator::sort_beside(const Node& comparison, std::uint32_t index) const {
  const Node& other = (*ast_)[ast_->child(comparison, 1 - index)];
  if (other.kind == NodeKind::kApply) {
    const auto symbol = model_.find_symbol(ast_->name(other));
    return symbol ? model_.symbols[*symbol].result : std::nullopt;
  }
  if (other.kind != NodeKind::kName) return std::nullopt;
  const auto bound = scope_.find(ast_->name(other));
  if (bound == scope_.end() || bound->second.empty()) return std::nullopt;
  return model_.variables[bound->second.back()].sort;
}

void Elaborator::enter(Frame& frame, const Node& node) {
  switch (node.kind) {
    case NodeKind::kName:
    case NodeKind::kNumber:
      return;  // leaves have no frame
    case NodeKind::kApply:
      return enter_apply(frame, node);
    case NodeKind::kUnary:
      return enter_unary(frame, node);
    case NodeKind::kBinary:
      return enter_binary(frame, node);
    case NodeKind::kForall:
    case NodeKind::kExists:
      return enter_quantifier(frame, node);
    case NodeKind::kCount:
    case NodeKind::kSum:
      return enter_aggregate(frame, node);
  }
}

void Elaborator::enter_unary(Frame& frame, const Node& node) {
  const bool is_formula = node.op == Operator::kNot || is_temporal(node.op);
  frame.child_position = is_formula ? Position::kFormula : Position::kTerm;
  if ((frame.position == Position::kFormula) == is_formula) {
    if (is_temporal(node.op)) check_time_is_free(frame, node);
    return;
  }
  frame.failed = true;
  frame.next_child = node.child_count;  // whatever is below would only repeat the complaint
  if (is_formula) {
    auto report = sink_.error(codes::kExpectedTerm, source(node), "formula", quoted(node));
    if (node.op == Operator::kNot) {
      report.fix("`!` binds tighter than a comparison: write `!(x=y)` or `x!=y`");
    } else {
      report.fix("a temporal operator stands before a formula, as in `always HoldsAt(...)`");
    }
  } else {
    sink_.error(codes::kExpectedFormula, source(node), "term", quoted(node));
  }
}

void Elaborator::enter_binary(Frame& frame, const Node& node) {
  const bool is_formula = is_connective(node.op) || is_comparison(node.op);
  frame.child_position = is_connective(node.op) ? Position::kFormula : Position::kTerm;
  const bool wants_formula = frame.position == Position::kFormula;
  if (wants_formula != is_formula) {
    frame.failed = true;
    frame.next_child = node.child_count;
    if (is_formula) {
      sink_.error(codes::kExpectedTerm, source(node), "formula", quoted(node));
    } else {
      sink_.error(codes::kExpectedFormula, source(node), "term", quoted(node));
    }
  } else if (node.op == Operator::kPower) {
    sink_.error(codes::kUnsupportedOperator, source(node), spelling(node.op));
    frame.failed = true;
  } else if (is_temporal(node.op)) {
    check_time_is_free(frame, node);
  }
}

/// Below a temporal operator `time` moves by itself. Aggregates have no such operators in them.
void Elaborator::check_time_is_free(Frame& frame, const Node& node) {
  if (is_inside_aggregate()) {
    frame.failed = true;
    frame.next_child = node.child_count;
    sink_.error(codes::kInsideAggregate, source(node), spelling(node.op));
    return;
  }
  for (const auto& outer : frames_) {
    for (std::size_t i = 0; i < outer.variables.size(); ++i) {
      const auto& variable = model_.variables[outer.variables[i]];
      if (variable.sort != model_.core.time) continue;
      frame.failed = true;
      frame.next_child = node.child_count;
      const Node& quantifier = (*ast_)[outer.node];
      sink_
          .error(codes::kTemporalUnderTime, source(node), spelling(node.op),
                 shortened(variable.name))
          .note(source((*ast_)[ast_->child(quantifier, static_cast<std::uint32_t>(i))]),
                "bound here");
      return;
    }
  }
}

void Elaborator::enter_apply(Frame& frame, const Node& node) {
  frame.child_position = Position::kTerm;
  frame.symbol = model_.find_symbol(ast_->name(node));
  if (!frame.symbol) {
    frame.failed = true;
    return report_unknown_symbol(node, frame.position, frame.expected);
  }
  const Symbol& symbol = model_.symbols[*frame.symbol];
  mentioned_[frame.symbol->index()] = true;
  const bool predicate = symbol.kind == SymbolKind::kPredicate;
  const bool shorthand = options_.fluents_as_atoms && symbol.kind == SymbolKind::kFluent;
  if (frame.position == Position::kTerm && predicate) {
    frame.failed = true;
    sink_.error(codes::kExpectedTerm, source(node), "predicate", quoted(node))
        .note(symbol.declared, "`" + signature(model_, symbol) + "` declared here");
  } else if (frame.position == Position::kFormula && !predicate && !shorthand) {
    frame.failed = true;
    auto report =
        sink_.error(codes::kExpectedFormula, source(node), kind_word(symbol.kind), quoted(node));
    report.note(symbol.declared, "`" + signature(model_, symbol) + "` declared here");
    if (symbol.kind == SymbolKind::kFluent)
      report.fix("write `HoldsAt(" + quoted(node) + ",time)`");
    if (symbol.kind == SymbolKind::kEvent) report.fix("write `Happens(" + quoted(node) + ",time)`");
  }
  if (symbol.arguments.size() != node.child_count) {
    frame.failed = true;
    // Arguments beyond the declared ones have no sort to be checked against.
    frame.end_child =
        std::min(node.child_count, static_cast<std::uint32_t>(symbol.arguments.size()));
    auto report = sink_.error(codes::kWrongArity, source(node), shortened(symbol.name),
                              symbol.arguments.size(), node.child_count);
    report.note(symbol.declared, "`" + signature(model_, symbol) + "` declared here");
    const auto advice = calculus_advice(symbol.name, node.child_count);
    if (frame.symbol == model_.core.happens && !advice.empty()) report.fix(std::string(advice));
  }
}

void Elaborator::enter_quantifier(Frame& frame, const Node& node) {
  frame.child_position = Position::kFormula;
  if (frame.position == Position::kTerm) {
    frame.failed = true;
    frame.next_child = node.child_count;
    sink_.error(codes::kExpectedTerm, source(node), "formula", quoted(node));
    return;
  }
  bind_variables(frame, node);
}

/// `count{x: F}` and `sum{x: W: F}` stand on one side of a comparison.
void Elaborator::enter_aggregate(Frame& frame, const Node& node) {
  frame.child_position = Position::kFormula;
  const Node* above = frames_.empty() ? nullptr : &(*ast_)[frames_.back().node];
  const bool compared =
      above != nullptr && above->kind == NodeKind::kBinary && is_comparison(above->op) &&
      !(is_aggregate((*ast_)[ast_->child(*above, 0)].kind) && frames_.back().next_child == 2);
  if (!compared) {
    frame.failed = true;
    frame.next_child = node.child_count;
    sink_.error(codes::kAggregatePlace, source(node), ast_->name(node));
    return;
  }
  bind_variables(frame, node);
}

bool Elaborator::is_inside_aggregate() const {
  return std::any_of(frames_.begin(), frames_.end(),
                     [&](const Frame& frame) { return is_aggregate((*ast_)[frame.node].kind); });
}

/// Binds the variables of a quantifier or aggregate; what stands behind them is visited.
void Elaborator::bind_variables(Frame& frame, const Node& node) {
  frame.next_child = node.bound_count();
  for (std::uint32_t i = 0; i < node.bound_count(); ++i) {
    const Node& variable = (*ast_)[ast_->child(node, i)];
    const auto name = ast_->name(variable);
    const auto sort_name = sort_of_variable(name);
    const auto sort = model_.find_sort(sort_name);
    if (!sort) {
      frame.failed = true;
      if (model_.misdeclared.contains(sort_name)) {
        reported_free_.insert(name);
        continue;
      }
      const auto used_as = sort_of_use(node, name);
      auto report = sink_.error(codes::kVariableWithoutSort, source(variable), shortened(sort_name),
                                shortened(name));
      if (const auto near = advice_.sort(sort_name)) {
        const auto& found = model_.sorts[*near];
        report.note(found.declared, "sort `" + found.name + "` declared here");
        report.fix(NameAdvice::replace(sort_name, found.name));
      } else if (used_as) {
        const auto& found = model_.sorts[*used_as].name;
        report.fix("write `" + found + "` or `" + found + "1` for `" + shortened(name) +
                   "`: a variable gets its sort from its name, here `" + found + "`");
      }
      reported_free_.insert(name);  // once is enough
      continue;
    }
    if (model_.sorts[*sort].integer) {
      require_range(*sort, source(variable));
    } else if (node.kind == NodeKind::kExists && !domains_.has_elements(*sort)) {
      sink_.warning(codes::kExistsInEmptySort, source(variable), model_.sorts[*sort].name,
                    "{" + shortened(name) + "}");
    }
    frame.variables.push_back(model_.variables.add({std::string(name), *sort}));
    scope_[name].push_back(frame.variables.back());
    bound_names_.push_back(name);
  }
}

/// The sort of the first argument place at which a formula names something so.
std::optional<SortId> Elaborator::sort_of_use(const Node& formula, std::string_view name) const {
  constexpr std::size_t kMostNodes = 10'000;  // it is for a message only
  std::vector<NodeId> stack;
  const auto push = [&](const Node& node) {
    for (auto i = node.child_count; i > 0; --i) stack.push_back(ast_->child(node, i - 1));
  };
  push(formula);
  for (std::size_t seen = 0; !stack.empty() && seen < kMostNodes; ++seen) {
    const Node& node = (*ast_)[stack.back()];
    stack.pop_back();
    push(node);
    if (node.kind != NodeKind::kApply) continue;
    const auto symbol = model_.find_symbol(ast_->name(node));
    if (!symbol) continue;
    const auto& sorts = model_.symbols[*symbol].arguments;
    for (std::uint32_t i = 0; i < node.child_count && i < sorts.size(); ++i) {
      const Node& argument = (*ast_)[ast_->child(node, i)];
      if (argument.kind == NodeKind::kName && ast_->name(argument) == name) return sorts[i];
    }
  }
  return std::nullopt;
}

void Elaborator::unbind(const Frame& frame) {
  for (std::size_t i = 0; i < frame.variables.size(); ++i) {
    scope_[bound_names_.back()].pop_back();
    bound_names_.pop_back();
  }
}

// --- results ---------------------------------------------------------------------------------

Elaborator::Value Elaborator::leave(const Frame& frame, const Node& node) {
  const auto term = [&](std::size_t i) { return TermId(values_[frame.values + i].id); };
  switch (node.kind) {
    case NodeKind::kName:
    case NodeKind::kNumber:
      break;
    case NodeKind::kApply:
      return apply(frame, node);
    case NodeKind::kUnary:
      if (node.op == Operator::kNot || is_temporal(node.op)) return connective(frame, node);
      if (node.op == Operator::kNegate) return negation_of_term(node, term(0));
      return check_integer(node.op, term(0)) ? values_[frame.values] : failure();
    case NodeKind::kBinary:
      if (is_connective(node.op)) return connective(frame, node);
      if (is_comparison(node.op)) {
        for (const bool turned : {false, true}) {
          const Node& side = (*ast_)[ast_->child(node, turned ? 1 : 0)];
          if (!is_aggregate(side.kind)) continue;
          return aggregate_comparison(node, turned, values_[frame.values + (turned ? 1 : 0)],
                                      term(turned ? 0 : 1));
        }
        return comparison(node, term(0), term(1));
      }
      return arithmetic(node, term(0), term(1));
    case NodeKind::kForall:
    case NodeKind::kExists:
      return connective(frame, node);
    case NodeKind::kCount:
    case NodeKind::kSum:
      return aggregate(frame, node);
  }
  return failure();
}

Elaborator::Value Elaborator::connective(const Frame& frame, const Node& node) {
  TypedFormula formula;
  formula.source = source(node);
  for (std::size_t i = frame.values; i < values_.size(); ++i) {
    formula.children.push_back(TypedFormulaId(values_[i].id));
  }
  if (node.kind == NodeKind::kForall || node.kind == NodeKind::kExists) {
    formula.kind = node.kind == NodeKind::kForall ? FormulaKind::kForall : FormulaKind::kExists;
    formula.variables = frame.variables;
  } else if (is_temporal(node.op)) {
    formula.kind = FormulaKind::kTemporal;
    formula.temporal = temporal_op(node.op);
  } else if (node.op == Operator::kNot) {
    formula.kind = FormulaKind::kNot;
  } else if (node.op == Operator::kAnd) {
    formula.kind = FormulaKind::kAnd;
  } else if (node.op == Operator::kOr) {
    formula.kind = FormulaKind::kOr;
  } else {
    formula.kind = node.op == Operator::kImplies ? FormulaKind::kImplies : FormulaKind::kIff;
  }
  return add(std::move(formula));
}

bool Elaborator::has_room(const base::SourceRange& at) {
  if (model_.formulas.size() + model_.terms.size() < kMaxTypedNodes) return true;
  if (!full_) sink_.error(codes::kModelTooLarge, at, kMaxTypedNodes);
  full_ = true;
  return false;
}

Elaborator::Value Elaborator::add(TypedFormula formula) {
  if (!has_room(formula.source)) return failure();
  return {model_.formulas.add(std::move(formula)).index(), false};
}

Elaborator::Value Elaborator::add(Term term) {
  if (!has_room(term.source)) return failure();
  return {model_.terms.add(std::move(term)).index(), false};
}

std::string Elaborator::quoted(const Node& node) const {
  return shortened(ast_->text(Word{node.begin, node.end}));
}

std::string Elaborator::quoted(TermId term) const {
  const auto& range = model_.terms[term].source;
  return shortened(ast_->text(Word{range.begin, range.end}));
}

void Elaborator::require_range(SortId sort, const base::SourceRange& use) {
  if (!model_.sorts[sort].integer || !domains_.ranges(sort).empty()) return;
  if (!reported_ranges_.insert(sort.index()).second) return;
  const auto& found = model_.sorts[sort];
  const auto code = options_.complete_model ? codes::kMissingRange : codes::kMissingRangeInPart;
  sink_.error(code, use, found.name)
      .note(found.declared, "sort `" + found.name + "` declared here")
      .fix("add a statement such as `range " + found.name + " 0 10`" +
           (model_.core.time == sort ? ", or give the last timepoint with --horizon 10" : ""));
}

}  // namespace parallax::compiler
