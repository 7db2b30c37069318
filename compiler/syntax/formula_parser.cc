#include "compiler/syntax/formula_parser.h"

#include <algorithm>

#include "compiler/base/codes/texts.h"
#include "compiler/syntax/parser.h"
#include "compiler/syntax/precedence.h"

namespace parallax::compiler {

using base::DiagnosticCode;

std::optional<NodeId> FormulaParser::parse(Period period) {
  entries_.clear();
  operands_.clear();
  extents_.clear();
  brackets_.clear();
  wants_operand_ = true;
  skip_to_period_ = true;
  last_ = lexer_.peek();
  Step step = Step::kMore;
  while (step == Step::kMore) step = wants_operand_ ? operand() : after_operand(period);
  if (step == Step::kFailed) {
    recover();
    return std::nullopt;
  }
  return operands_.back().node;
}

// --- operands --------------------------------------------------------------------------------

FormulaParser::Step FormulaParser::operand() {
  const Token token = lexer_.peek();
  switch (token.kind) {
    case TokenKind::kName:
      last_ = lexer_.next();
      if (const auto step = foreign_prefix(token)) return *step;
      if (const auto step = temporal_prefix(token)) return *step;
      if (const auto step = open_aggregate(token)) return *step;
      if (lexer_.peek().kind == TokenKind::kOpenParen) return open_call(token);
      if (is_word_quantifier(token)) return word_quantifier(token);
      leaf(NodeKind::kName, token);
      return Step::kMore;
    case TokenKind::kNumber:
      last_ = lexer_.next();
      leaf(NodeKind::kNumber, token);
      return Step::kMore;
    case TokenKind::kOpenParen:
      last_ = lexer_.next();
      return push({.kind = Pending::kParen, .token = token}) ? Step::kMore : Step::kFailed;
    case TokenKind::kOpenBracket:
    case TokenKind::kOpenBrace:
      last_ = lexer_.next();
      return quantifier(token);
    case TokenKind::kOperator: {
      Entry entry{.kind = Pending::kPrefix, .op = token.op, .token = token};
      if (token.op == Operator::kSubtract) {
        entry.op = Operator::kNegate;
      } else if (token.op == Operator::kAdd) {
        entry.op = Operator::kPlus;
      } else if (token.op == Operator::kModulo) {
        lexer_.skip_percent_comment();
        return Step::kMore;
      } else if (token.op != Operator::kNot) {
        return fail_here(codes::kExpectedOperand, token);
      }
      last_ = lexer_.next();
      return push(entry) ? Step::kMore : Step::kFailed;
    }
    case TokenKind::kCloseParen:
    case TokenKind::kCloseBracket:
    case TokenKind::kCloseBrace:
    case TokenKind::kComma:
    case TokenKind::kPeriod:
    case TokenKind::kColon:
    case TokenKind::kStatementLine:
    case TokenKind::kEnd:
      break;
  }
  return fail_here(codes::kExpectedOperand, token);
}

void FormulaParser::leaf(NodeKind kind, const Token& token) {
  Node node;
  node.kind = kind;
  node.begin = token.begin;
  node.end = token.end;
  node.name_length = token.end - token.begin;
  operands_.push_back({ast_.add(node), 1});
  wants_operand_ = false;
}

FormulaParser::Step FormulaParser::open_call(const Token& name) {
  last_ = lexer_.next();
  const auto base = static_cast<std::uint32_t>(operands_.size());
  if (!push({.kind = Pending::kCall, .token = name, .base = base})) return Step::kFailed;
  // `F()` has no operand; close() sees that from `base`.
  if (lexer_.peek().kind == TokenKind::kCloseParen) wants_operand_ = false;
  return Step::kMore;
}

FormulaParser::Step FormulaParser::quantifier(const Token& open) {
  const bool all = open.kind == TokenKind::kOpenBracket;
  const auto closing = all ? TokenKind::kCloseBracket : TokenKind::kCloseBrace;
  Entry entry{.kind = Pending::kQuantifier,
              .quantifier = all ? NodeKind::kForall : NodeKind::kExists,
              .token = open};
  return variables(entry, open, closing) && push(entry) ? Step::kMore : Step::kFailed;
}

/// The names behind a bracket up to the token that ends them.
bool FormulaParser::variables(Entry& entry, const Token& open, TokenKind closing) {
  for (;;) {
    const Token name = lexer_.peek();
    if (name.kind != TokenKind::kName) {
      (void)fail_here(codes::kExpectedVariable, name);
      return false;
    }
    last_ = lexer_.next();
    leaf(NodeKind::kName, name);
    ++entry.count;
    const Token after = lexer_.peek();
    if (after.kind != closing && after.kind != TokenKind::kComma) {
      if (entry.kind == Pending::kAggregate) {
        (void)fail_here(codes::kAggregateForm, after);
      } else {
        sink_
            .error(codes::kUnclosedBracket, lexer_.range(after), lexer_.text(open),
                   lexer_.describe(after))
            .note(lexer_.range(open), "opened here");
      }
      return false;
    }
    last_ = lexer_.next();
    if (after.kind == closing) break;
  }
  wants_operand_ = true;
  return true;
}

/// `count{` and `sum{`; nothing else begins with a name and a brace.
std::optional<FormulaParser::Step> FormulaParser::open_aggregate(const Token& word) {
  const auto text = lexer_.text(word);
  const bool sum = text == "sum";
  if ((!sum && text != "count") || lexer_.peek().kind != TokenKind::kOpenBrace) {
    return std::nullopt;
  }
  Entry entry{.kind = Pending::kAggregate,
              .quantifier = sum ? NodeKind::kSum : NodeKind::kCount,
              .token = word,
              .base = static_cast<std::uint32_t>(operands_.size())};
  last_ = lexer_.next();
  return variables(entry, last_, TokenKind::kColon) && push(entry) ? Step::kMore : Step::kFailed;
}

/// The colon behind the weight of a sum.
FormulaParser::Step FormulaParser::weight(const Token& colon) {
  if (!reduce_to_bracket()) return Step::kFailed;
  const Entry& top = entries_.back();
  if (top.quantifier != NodeKind::kSum || operands_.size() != top.base + top.count + 1) {
    return fail_here(codes::kAggregateForm, colon);
  }
  last_ = lexer_.next();
  wants_operand_ = true;
  return Step::kMore;
}

FormulaParser::Step FormulaParser::close_aggregate(const Token& brace) {
  if (!reduce_to_bracket()) return Step::kFailed;
  const Entry entry = entries_.back();
  const auto parts = entry.count + (entry.quantifier == NodeKind::kSum ? 2 : 1);
  if (operands_.size() != entry.base + parts) {
    return fail_here(codes::kAggregateForm, brace);
  }
  last_ = lexer_.next();
  entries_.pop_back();
  brackets_.pop_back();
  Node node;
  node.kind = entry.quantifier;
  node.name_length = entry.token.end - entry.token.begin;
  return add(node, parts, entry.token.begin, brace.end) ? Step::kMore : Step::kFailed;
}

bool FormulaParser::is_word_quantifier(const Token& name) const {
  const auto word = lexer_.text(name);
  return lexer_.mode() == Lexer::Mode::kBinding && (word == "exists" || word == "forall");
}

/// `not` and `forall` in front of something that could not follow a name.
std::optional<FormulaParser::Step> FormulaParser::foreign_prefix(const Token& word) {
  const auto* foreign = foreign_word(lexer_.text(word));
  if (foreign == nullptr || is_word_quantifier(word)) return std::nullopt;
  if (!begins_operand(lexer_.peek())) return std::nullopt;
  if (foreign->kind == ForeignSpelling::Kind::kQuantifier) {
    report_foreign(*foreign, lexer_.range(word), sink_);
    return Step::kFailed;
  }
  if (foreign->kind != ForeignSpelling::Kind::kPrefix) return std::nullopt;
  report_foreign(*foreign, lexer_.range(word), sink_);
  const bool pushed = push({.kind = Pending::kPrefix, .op = foreign->op, .token = word});
  return pushed ? Step::kMore : Step::kFailed;
}

/// Could it not follow a name?
bool FormulaParser::begins_operand(const Token& token) const {
  if (token.kind == TokenKind::kName) {
    const auto op = temporal_operator(lexer_.text(token));
    const auto* foreign = foreign_word(lexer_.text(token));
    return (!op || !is_binary_temporal(*op)) &&
           (foreign == nullptr || foreign->kind != ForeignSpelling::Kind::kOperator);
  }
  if (token.kind == TokenKind::kOperator) return token.op == Operator::kNot;
  return token.kind == TokenKind::kOpenParen || token.kind == TokenKind::kOpenBracket ||
         token.kind == TokenKind::kOpenBrace;
}

/// `exists i, j.`; commas may be missing.
FormulaParser::Step FormulaParser::word_quantifier(const Token& word) {
  Entry entry{.kind = Pending::kQuantifier,
              .quantifier = lexer_.text(word) == "forall" ? NodeKind::kForall : NodeKind::kExists,
              .token = word};
  for (;;) {
    const Token token = lexer_.peek();
    const bool ends = token.kind == TokenKind::kPeriod && entry.count != 0;
    const bool separates = token.kind == TokenKind::kComma && entry.count != 0;
    if (!ends && !separates && token.kind != TokenKind::kName) {
      return fail_here(codes::kExpectedVariable, token);
    }
    last_ = lexer_.next();
    if (ends) break;
    if (separates) continue;
    leaf(NodeKind::kName, token);
    ++entry.count;
  }
  wants_operand_ = true;
  return push(entry) ? Step::kMore : Step::kFailed;
}

// --- after an operand ------------------------------------------------------------------------

FormulaParser::Step FormulaParser::after_operand(Period period) {
  const Token token = lexer_.peek();
  switch (token.kind) {
    case TokenKind::kOperator:
      return token.op == Operator::kNot ? juxtaposed(token, period) : binary(token);
    case TokenKind::kComma:
      return comma(token);
    case TokenKind::kCloseParen:
      return close(token);
    case TokenKind::kCloseBrace:
      if (!brackets_.empty() && brackets_.back() == Pending::kAggregate) {
        return close_aggregate(token);
      }
      return fail_here(codes::kUnmatchedBracket, token);
    case TokenKind::kCloseBracket:
      return fail_here(codes::kUnmatchedBracket, token);
    case TokenKind::kColon:
      if (!brackets_.empty() && brackets_.back() == Pending::kAggregate) return weight(token);
      return juxtaposed(token, period);
    case TokenKind::kPeriod:
    case TokenKind::kStatementLine:
    case TokenKind::kEnd:
      return end_of_formula(token, period);
    case TokenKind::kName: {
      if (const auto op = temporal_operator(lexer_.text(token)); op && is_binary_temporal(*op)) {
        return temporal_binary(*op, token);
      }
      const auto* foreign = foreign_word(lexer_.text(token));
      if (foreign == nullptr || foreign->kind != ForeignSpelling::Kind::kOperator) {
        return juxtaposed(token, period);
      }
      return foreign_binary(*foreign, token);
    }
    case TokenKind::kNumber:
    case TokenKind::kOpenParen:
    case TokenKind::kOpenBracket:
    case TokenKind::kOpenBrace:
      return juxtaposed(token, period);
  }
  return Step::kFailed;
}

FormulaParser::Step FormulaParser::binary(const Token& token) {
  const int strength = binding(token.op);
  while (!entries_.empty()) {
    Entry& top = entries_.back();
    if (is_bracket(top.kind) || top.kind == Pending::kQuantifier) {
      break;  // a quantifier reaches as far right as possible
    }
    const int above = binding(top.op);
    if (above < strength) break;
    if (above == strength && top.kind == Pending::kBinary) {
      if (strength == kComparisonBinding) {
        sink_.error(codes::kComparisonChain, lexer_.range(token), lexer_.text(token))
            .note(lexer_.range(top.token), "the other comparison");
        return Step::kFailed;
      }
      if (strength == kUntilBinding) {
        sink_.error(codes::kUntilChain, lexer_.range(token), lexer_.text(token))
            .note(lexer_.range(top.token), "the other one");
        return Step::kFailed;
      }
      if (is_flat(token.op)) {
        ++top.count;
        last_ = lexer_.next();
        wants_operand_ = true;
        return Step::kMore;
      }
    }
    if (!reduce()) return Step::kFailed;
  }
  last_ = lexer_.next();
  wants_operand_ = true;
  return push({.kind = Pending::kBinary, .op = token.op, .token = token, .count = 1})
             ? Step::kMore
             : Step::kFailed;
}

FormulaParser::Step FormulaParser::foreign_binary(const ForeignSpelling& spelling, Token token) {
  report_foreign(spelling, lexer_.range(token), sink_);
  token.kind = TokenKind::kOperator;
  token.op = spelling.op;
  return binary(token);
}

FormulaParser::Step FormulaParser::comma(const Token& token) {
  if (brackets_.empty() || brackets_.back() != Pending::kCall) {
    return foreign_binary(foreign_comma(), token);
  }
  if (!reduce_to_bracket()) return Step::kFailed;
  last_ = lexer_.next();
  wants_operand_ = true;
  return Step::kMore;
}

FormulaParser::Step FormulaParser::close(const Token& token) {
  if (!reduce_to_bracket()) return Step::kFailed;
  if (entries_.empty()) {
    sink_.error(codes::kUnmatchedBracket, lexer_.range(token), lexer_.text(token));
    return Step::kFailed;
  }
  if (entries_.back().kind == Pending::kAggregate) return fail_unclosed(token);
  last_ = lexer_.next();
  const Entry entry = entries_.back();
  entries_.pop_back();
  brackets_.pop_back();
  if (entry.kind == Pending::kParen) {
    const auto operand = operands_.size() - 1;
    if (!extents_.empty() && extents_.back().operand == operand) extents_.pop_back();
    extents_.push_back({operand, entry.token.begin, token.end});
    return Step::kMore;
  }
  Node node;
  node.kind = NodeKind::kApply;
  node.name_length = entry.token.end - entry.token.begin;
  return add(node, operands_.size() - entry.base, entry.token.begin, token.end) ? Step::kMore
                                                                                : Step::kFailed;
}

FormulaParser::Step FormulaParser::end_of_formula(const Token& token, Period period) {
  if (!reduce_to_bracket()) return Step::kFailed;
  if (!entries_.empty()) return fail_unclosed(token);
  if (token.kind == TokenKind::kPeriod) {
    last_ = lexer_.next();
  } else if (period == Period::kRequired) {
    // The formula itself is whole, so it stays.
    sink_.error(codes::kMissingPeriod, lexer_.range(last_), lexer_.describe(token))
        .fix("add `.` after `" + shortened(lexer_.text(last_)) + "`");
  }
  return Step::kDone;
}

FormulaParser::Step FormulaParser::juxtaposed(const Token& token, Period period) {
  // At the start of a line this is most likely the next formula.
  if (period == Period::kRequired && token.first_on_line && token.kind != TokenKind::kColon) {
    skip_to_period_ = false;
    return end_of_formula(token, period);
  }
  // `allways F`: the name before, or the one that stands here.
  const bool after_name = !operands_.empty() && last_.kind == TokenKind::kName;
  if (after_name && report_unknown_temporal(last_)) return Step::kFailed;
  if (token.kind == TokenKind::kName && report_unknown_temporal(token)) return Step::kFailed;
  return fail_here(codes::kExpectedOperator, token);
}

// --- building --------------------------------------------------------------------------------

bool FormulaParser::push(const Entry& entry) {
  if (entries_.size() >= kMaxFormulaDepth) {
    report_too_deep(entry.token.begin, entry.token.end);
    return false;
  }
  entries_.push_back(entry);
  if (is_bracket(entry.kind)) {
    brackets_.push_back(entry.kind);
  }
  return true;
}

void FormulaParser::report_too_deep(std::uint32_t begin, std::uint32_t end) {
  sink_.error(codes::kFormulaTooDeep, base::SourceRange{ast_.file(), begin, end}, kMaxFormulaDepth);
}

bool FormulaParser::add(Node node, std::size_t child_count, std::uint32_t begin,
                        std::uint32_t end) {
  const std::size_t first = operands_.size() - child_count;
  std::uint32_t depth = 0;
  for (std::size_t i = first; i < operands_.size(); ++i) {
    depth = std::max(depth, operands_[i].depth);
  }
  if (depth >= kMaxFormulaDepth) {
    report_too_deep(begin, end);
    return false;
  }
  node.begin = begin;
  node.end = end;
  const auto id =
      ast_.add_with(node, child_count, [&](std::size_t i) { return operands_[first + i].node; });
  operands_.resize(first);
  while (!extents_.empty() && extents_.back().operand >= first) extents_.pop_back();
  operands_.push_back({id, depth + 1});
  wants_operand_ = false;
  return true;
}

FormulaParser::Extent FormulaParser::extent(std::size_t operand) const {
  const auto found = std::lower_bound(
      extents_.begin(), extents_.end(), operand,
      [](const Extent& extent, std::size_t wanted) { return extent.operand < wanted; });
  if (found != extents_.end() && found->operand == operand) return *found;
  const Node& node = ast_[operands_[operand].node];
  return {operand, node.begin, node.end};
}

bool FormulaParser::reduce() {
  const Entry entry = entries_.back();
  entries_.pop_back();
  Node node;
  node.op = entry.op;
  const auto end = extent(operands_.size() - 1).end;
  if (entry.kind == Pending::kPrefix) {
    node.kind = NodeKind::kUnary;
    return add(node, 1, entry.token.begin, end);
  }
  const std::size_t child_count = entry.count + 1;
  if (entry.kind == Pending::kQuantifier) {
    node.kind = entry.quantifier;
    return add(node, child_count, entry.token.begin, end);
  }
  node.kind = NodeKind::kBinary;
  return add(node, child_count, extent(operands_.size() - child_count).begin, end);
}

bool FormulaParser::reduce_to_bracket() {
  while (!entries_.empty() && !is_bracket(entries_.back().kind)) {
    if (!reduce()) return false;
  }
  return true;
}

// --- errors ----------------------------------------------------------------------------------

FormulaParser::Step FormulaParser::fail_here(DiagnosticCode code, const Token& found) {
  auto range = lexer_.range(found);
  if (found.kind == TokenKind::kStatementLine || found.kind == TokenKind::kEnd) {
    range = lexer_.range(last_);  // point at what is incomplete, not at what follows
  }
  if (code == codes::kUnmatchedBracket) {
    sink_.error(code, range, lexer_.text(found));
  } else {
    sink_.error(code, range, lexer_.describe(found));
  }
  return Step::kFailed;
}

FormulaParser::Step FormulaParser::fail_unclosed(const Token& before) {
  const auto& open = entries_.back();
  auto place = lexer_.range(open.token);
  if (open.kind != Pending::kParen) {
    place.end = place.begin + 1 + (open.token.end - open.token.begin);
  }
  const auto at = before.kind == TokenKind::kPeriod ? before : last_;
  const auto* bracket = open.kind == Pending::kAggregate ? "{" : "(";
  sink_.error(codes::kUnclosedBracket, lexer_.range(at), bracket, lexer_.describe(before))
      .note(place, "opened here");
  return Step::kFailed;
}

void FormulaParser::recover() {
  if (!skip_to_period_) return;
  for (;;) {
    const auto kind = lexer_.peek().kind;
    if (kind == TokenKind::kEnd || kind == TokenKind::kStatementLine) return;
    lexer_.next();
    if (kind == TokenKind::kPeriod) return;
  }
}

}  // namespace parallax::compiler
