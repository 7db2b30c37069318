// The words of temporal operators in formulas.

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "compiler/base/codes/texts.h"
#include "compiler/base/suggest.h"
#include "compiler/syntax/formula_parser.h"

namespace parallax::compiler {

/// `always` before a formula; a name where nothing could begin behind it.
std::optional<FormulaParser::Step> FormulaParser::temporal_prefix(const Token& word) {
  const auto op = temporal_operator(lexer_.text(word));
  const auto& next = lexer_.peek();
  if (!op || (!begins_operand(next) && next.kind != TokenKind::kNumber)) return std::nullopt;
  if (words_ == Words::kPlain) {
    sink_.error(codes::kTemporalElsewhere, lexer_.range(word), lexer_.text(word));
    return Step::kFailed;
  }
  if (is_binary_temporal(*op)) return fail_here(codes::kExpectedOperand, word);
  const bool pushed = push({.kind = Pending::kPrefix, .op = *op, .token = word});
  return pushed ? Step::kMore : Step::kFailed;
}

FormulaParser::Step FormulaParser::temporal_binary(Operator op, Token token) {
  if (words_ == Words::kPlain) {
    sink_.error(codes::kTemporalElsewhere, lexer_.range(token), lexer_.text(token));
    return Step::kFailed;
  }
  token.kind = TokenKind::kOperator;
  token.op = op;
  return binary(token);
}

/// Reports a name that other notations give an operator, or a misspelt one.
bool FormulaParser::report_unknown_temporal(const Token& token) {
  static constexpr std::array<std::pair<std::string_view, Operator>, 16> kOtherNames = {
      {{"G", Operator::kAlways},
       {"globally", Operator::kAlways},
       {"henceforth", Operator::kAlways},
       {"F", Operator::kEventually},
       {"finally", Operator::kEventually},
       {"sometime", Operator::kEventually},
       {"sometimes", Operator::kEventually},
       {"X", Operator::kNext},
       {"weaknext", Operator::kWeakNext},
       {"U", Operator::kUntil},
       {"H", Operator::kHistorically},
       {"O", Operator::kOnce},
       {"Y", Operator::kPreviously},
       {"previous", Operator::kPreviously},
       {"S", Operator::kSince},
       {"weak", Operator::kWeakNext}}};
  const auto word = lexer_.text(token);
  if (words_ == Words::kPlain || temporal_operator(word)) return false;
  const auto report = [&](std::string_view own) {
    sink_.error(codes::kUnknownTemporal, lexer_.range(token), shortened(word))
        .fix("replace `" + shortened(word) + "` with `" + std::string(own) + "`");
    return true;
  };
  for (const auto& [other, op] : kOtherNames) {
    if (word == other) return report(spelling(op));
  }
  const auto* first = kOperatorSigns.begin() + static_cast<std::size_t>(Operator::kAlways);
  const std::vector<std::string> own(first, kOperatorSigns.end());
  const auto near = base::nearest_name(word, own);
  return near && word.size() > 3 && report(*near);
}

}  // namespace parallax::compiler
