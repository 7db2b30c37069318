#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "compiler/syntax/ast.h"
#include "compiler/syntax/foreign_spelling.h"
#include "compiler/syntax/lexer.h"

namespace parallax::compiler {

/// Operator precedence parsing with its own stacks: no recursion, one pass, each token looked at
/// once. After an error it leaves the lexer where the next formula probably starts.
class FormulaParser {
 public:
  /// Is `always` an operator?
  enum class Words : std::uint8_t { kPlain, kTemporal };

  FormulaParser(Ast& ast, Lexer& lexer, base::DiagnosticSink& sink, Words words = Words::kPlain)
      : ast_(ast), lexer_(lexer), sink_(sink), words_(words) {}

  enum class Period : std::uint8_t { kRequired, kOptional };

  /// One formula and its period. Nothing if it was given up; the error has then been reported.
  std::optional<NodeId> parse(Period period);

 private:
  enum class Pending : std::uint8_t { kBinary, kPrefix, kQuantifier, kParen, kCall, kAggregate };
  /// Does only its bracket end it?
  static bool is_bracket(Pending kind) { return kind >= Pending::kParen; }
  struct Entry {
    Pending kind = Pending::kBinary;
    Operator op = Operator::kAnd;
    NodeKind quantifier = NodeKind::kForall;  // kQuantifier, kAggregate
    Token token;                              // the operator, the bracket or the name before it
    std::uint32_t count = 0;  // kBinary: operators so far; kCall: commas; else: variables
    std::uint32_t base = 0;   // kCall, kAggregate: operands below it
  };
  struct Operand {
    NodeId node;
    std::uint32_t depth = 1;
  };
  /// Where an operand with parentheses around it begins and ends.
  struct Extent {
    std::size_t operand = 0;
    std::uint32_t begin = 0;
    std::uint32_t end = 0;
  };
  enum class Step : std::uint8_t { kMore, kDone, kFailed };

  Step operand();
  Step open_call(const Token& name);
  Step quantifier(const Token& open);
  bool variables(Entry& entry, const Token& open, TokenKind closing);
  std::optional<Step> open_aggregate(const Token& word);
  Step weight(const Token& colon);
  Step close_aggregate(const Token& brace);
  bool is_word_quantifier(const Token& name) const;
  Step word_quantifier(const Token& word);
  std::optional<Step> foreign_prefix(const Token& word);
  bool begins_operand(const Token& token) const;
  std::optional<Step> temporal_prefix(const Token& word);
  Step temporal_binary(Operator op, Token token);
  bool report_unknown_temporal(const Token& token);
  Step after_operand(Period period);
  Step binary(const Token& token);
  Step foreign_binary(const ForeignSpelling& spelling, Token token);
  Step comma(const Token& token);
  Step close(const Token& token);
  Step end_of_formula(const Token& token, Period period);
  Step juxtaposed(const Token& token, Period period);

  bool push(const Entry& entry);
  bool reduce();             // the top entry, which is no bracket
  bool reduce_to_bracket();  // until a bracket is on top or nothing is left
  bool add(Node node, std::size_t child_count, std::uint32_t begin, std::uint32_t end);
  Extent extent(std::size_t operand) const;
  void leaf(NodeKind kind, const Token& token);
  Step fail_here(base::DiagnosticCode code, const Token& found);
  Step fail_unclosed(const Token& before);
  void report_too_deep(std::uint32_t begin, std::uint32_t end);
  void recover();

  Ast& ast_;
  Lexer& lexer_;
  base::DiagnosticSink& sink_;
  Words words_;
  std::vector<Entry> entries_;
  std::vector<Operand> operands_;
  std::vector<Pending> brackets_;  // those of entries_ that are brackets
  std::vector<Extent> extents_;    // of operands in parentheses alone, by operand
  Token last_;                     // the token consumed last
  bool wants_operand_ = true;
  bool skip_to_period_ = true;  // after a failure
};

}  // namespace parallax::compiler
