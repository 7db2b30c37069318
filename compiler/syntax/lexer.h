#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "compiler/base/diagnostic.h"
#include "compiler/base/source_file.h"
#include "compiler/syntax/ast.h"

namespace parallax::compiler {

enum class TokenKind : std::uint8_t {
  kName,
  kNumber,
  kOperator,  // binary, or a prefix where an operand is expected (`-` comes as kSubtract)
  kOpenParen,
  kCloseParen,
  kOpenBracket,
  kCloseBracket,
  kOpenBrace,
  kCloseBrace,
  kComma,
  kPeriod,
  kColon,
  kStatementLine,  // the next line is a statement; not consumed by next()
  kEnd,
};

struct Token {
  TokenKind kind = TokenKind::kEnd;
  Operator op = Operator::kAnd;
  bool first_on_line = false;
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
};

bool is_blank(char c);  // space, tab, carriage return, form feed
bool is_name_start(char c);

/// Kind of a line, by its first word.
enum class LineKind : std::uint8_t {
  kFormulaText,
  kFormulaTextOnlyHere,  // formula text that the 2005 reasoner takes for a declaration
  kStatement,
};
/// `line` starts at the first character that is no blank and may go on beyond the line's end.
LineKind classify_line(std::string_view line);

/// At most 60 bytes of `text`, for quoting in a message.
std::string shortened(std::string_view text);

/// Tokens of formula text with exact byte ranges. Comments (from `;` to the end of the line) and
/// blanks are skipped; characters that no token starts with are reported (E1001) and skipped, a run
/// of them at once.
class Lexer {
 public:
  enum class Mode : std::uint8_t {
    kFile,         // lines are classified
    kFormulaOnly,  // every line is formula text
    kBinding,      // the same, and `?arm` or `?left-arm` is a name
  };

  Lexer(base::SourceRange range, std::string_view file_text, Mode mode, base::DiagnosticSink& sink);

  Mode mode() const { return mode_; }
  const Token& peek() const { return token_; }
  Token next();
  /// Is the token after peek(), on the same line, a colon? (peek() is then a label.)
  bool colon_follows() const;
  /// Where the line of peek() ends: at its comment or line break.
  std::uint32_t statement_end() const;
  /// Is the token after peek(), on the same line, a name?
  bool name_follows() const;
  /// Leaves the rest of the line, which `%` begins as if it were a comment.
  void skip_percent_comment();
  /// Leaves the statement that peek() announced, or the rest of its line.
  void skip_statement();

  std::string_view text(const Token& token) const {
    return text_.substr(token.begin, token.end - token.begin);
  }
  /// "`HoldsAt`", "the end of the text", "a statement".
  std::string describe(const Token& token) const;
  base::SourceRange range(const Token& token) const { return {file_, token.begin, token.end}; }

 private:
  void scan();
  void skip_blanks();
  void skip_illegal();
  std::uint32_t parameter_end() const;
  std::uint32_t line_end() const;
  bool scan_word();
  bool scan_operator();
  bool scan_foreign();
  bool skip_foreign_comment();

  base::FileId file_;
  std::string_view text_;  // of the file, cut at the end of the range
  Mode mode_;
  base::DiagnosticSink& sink_;
  std::uint32_t position_;
  bool line_start_ = true;  // nothing but blanks so far on this line
  Token token_;
};

}  // namespace parallax::compiler
