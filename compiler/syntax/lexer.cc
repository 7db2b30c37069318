#include "compiler/syntax/lexer.h"

#include <algorithm>
#include <array>

#include "compiler/base/ascii.h"
#include "compiler/base/codes/texts.h"
#include "compiler/base/utf8.h"
#include "compiler/syntax/foreign_spelling.h"

namespace parallax::compiler {
namespace {

struct Spelled {
  std::string_view text;
  TokenKind kind;
  Operator op = Operator::kAnd;
};

// Longest match first.
constexpr std::array<Spelled, 28> kPunctuation = {{
    {"<->", TokenKind::kOperator, Operator::kIff},
    {"->", TokenKind::kOperator, Operator::kImplies},
    {"<=", TokenKind::kOperator, Operator::kLessEqual},
    {">=", TokenKind::kOperator, Operator::kGreaterEqual},
    {"!=", TokenKind::kOperator, Operator::kNotEqual},
    {"<", TokenKind::kOperator, Operator::kLess},
    {">", TokenKind::kOperator, Operator::kGreater},
    {"=", TokenKind::kOperator, Operator::kEqual},
    {"!", TokenKind::kOperator, Operator::kNot},
    {"&", TokenKind::kOperator, Operator::kAnd},
    {"|", TokenKind::kOperator, Operator::kOr},
    {"+", TokenKind::kOperator, Operator::kAdd},
    {"-", TokenKind::kOperator, Operator::kSubtract},
    {"*", TokenKind::kOperator, Operator::kMultiply},
    {"/", TokenKind::kOperator, Operator::kDivide},
    {"^", TokenKind::kOperator, Operator::kPower},
    {"%", TokenKind::kOperator, Operator::kModulo},
    {"(", TokenKind::kOpenParen},
    {")", TokenKind::kCloseParen},
    {"[", TokenKind::kOpenBracket},
    {"]", TokenKind::kCloseBracket},
    {"{", TokenKind::kOpenBrace},
    {"}", TokenKind::kCloseBrace},
    {",", TokenKind::kComma},
    {".", TokenKind::kPeriod},
    {":", TokenKind::kColon},
    {";", TokenKind::kEnd},   // a comment: never met, but no illegal character
    {"\n", TokenKind::kEnd},  // likewise
}};

constexpr std::array<std::string_view, 12> kKeywords = {
    "option",  "range",         "sort",   "xor",        "mutex", "noninertial",
    "reified", "manualrelease", "ignore", "completion", "load",  "minimize"};

bool starts_token(char c) {
  if (base::is_name_character(c) || is_blank(c)) return true;
  return std::any_of(kPunctuation.begin(), kPunctuation.end(),
                     [c](const Spelled& spelled) { return spelled.text[0] == c; });
}

}  // namespace

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v'; }
bool is_name_start(char c) { return base::is_letter(c) || c == '_'; }

LineKind classify_line(std::string_view line) {
  std::size_t end = 0;
  while (end < line.size() && base::is_lower(line[end])) ++end;
  if (end == 0) return LineKind::kFormulaText;
  const auto word = line.substr(0, end);
  const bool keyword = std::find(kKeywords.begin(), kKeywords.end(), word) != kKeywords.end();
  const bool additional = !keyword && end < line.size() && line[end] == '!';
  if (additional) ++end;
  std::size_t next = end;
  while (next < line.size() && is_blank(line[next])) ++next;
  const bool nothing_follows = next == line.size() || line[next] == '\n' || line[next] == ';';
  if (nothing_follows) return keyword ? LineKind::kStatement : LineKind::kFormulaText;
  if (next == end) return LineKind::kFormulaText;
  if (keyword) return LineKind::kStatement;
  if (foreign_word(word) != nullptr && is_foreign_formula(line)) return LineKind::kFormulaText;
  // Two names side by side are no formula; anything else after the first can only be one.
  return base::is_name_character(line[next]) ? LineKind::kStatement
                                             : LineKind::kFormulaTextOnlyHere;
}

std::string shortened(std::string_view text) {
  constexpr std::size_t kLongest = 60;
  if (text.size() <= kLongest) return std::string(text);
  std::size_t end = kLongest - 3;
  while (end > 0 && base::continues_code_point(text[end])) --end;
  return std::string(text.substr(0, end)) + "...";
}

Lexer::Lexer(base::SourceRange range, std::string_view file_text, Mode mode,
             base::DiagnosticSink& sink)
    : file_(range.file),
      text_(file_text.substr(0, range.end)),
      mode_(mode),
      sink_(sink),
      position_(range.begin) {
  scan();
}

Token Lexer::next() {
  const Token taken = token_;
  if (taken.kind != TokenKind::kEnd && taken.kind != TokenKind::kStatementLine) scan();
  return taken;
}

bool Lexer::colon_follows() const {
  std::size_t i = token_.end;
  while (i < text_.size() && is_blank(text_[i])) ++i;
  return i < text_.size() && text_[i] == ':';
}

bool Lexer::name_follows() const {
  std::size_t i = token_.end;
  while (i < text_.size() && is_blank(text_[i])) ++i;
  return i < text_.size() && i != token_.end && is_name_start(text_[i]);
}

std::uint32_t Lexer::statement_end() const {
  const auto end = text_.find_first_of(";\n", token_.begin);
  return static_cast<std::uint32_t>(end == std::string_view::npos ? text_.size() : end);
}

void Lexer::skip_statement() {
  position_ = statement_end();
  scan();
}

std::string Lexer::describe(const Token& token) const {
  if (token.kind == TokenKind::kEnd) return "the end of the text";
  if (token.kind == TokenKind::kStatementLine) return "a statement";
  return "`" + shortened(text(token)) + "`";
}

void Lexer::skip_blanks() {
  while (position_ < text_.size()) {
    const char c = text_[position_];
    if (c == ';') {
      position_ = line_end();
    } else if (c == '\n') {
      line_start_ = true;
      ++position_;
    } else if (is_blank(c)) {
      ++position_;
    } else {
      return;
    }
  }
}

void Lexer::skip_illegal() {
  const auto begin = position_++;
  const auto starts = [this](char c) {
    return starts_token(c) || (mode_ == Mode::kBinding && c == '?');
  };
  while (position_ < text_.size() && !starts(text_[position_])) ++position_;
  // Quote one whole code point, not its first byte.
  std::size_t length = 1;
  while (begin + length < position_ && base::continues_code_point(text_[begin + length])) ++length;
  sink_.error(codes::kIllegalCharacter, base::SourceRange{file_, begin, position_},
              text_.substr(begin, length));
}

/// End of the parameter `?left-arm` at the position; the position itself if there is none.
std::uint32_t Lexer::parameter_end() const {
  if (mode_ != Mode::kBinding || text_[position_] != '?') return position_;
  const auto is_part = [this](std::uint32_t at) {
    return at < text_.size() && base::is_name_character(text_[at]);
  };
  auto end = position_ + 1;
  while (is_part(end) || (end < text_.size() && text_[end] == '-' && is_part(end + 1))) ++end;
  return end == position_ + 1 ? position_ : end;
}

bool Lexer::scan_word() {
  const char first = text_[position_];
  std::uint32_t end = parameter_end();
  if (end != position_) {
    token_.kind = TokenKind::kName;
  } else if (is_name_start(first)) {
    while (end < text_.size() && base::is_name_character(text_[end])) ++end;
    token_.kind = TokenKind::kName;
  } else if (base::is_digit(first)) {
    while (end < text_.size() && base::is_digit(text_[end])) ++end;
    // `0.5` is one number, the period of `=0.` ends a formula.
    if (end + 1 < text_.size() && text_[end] == '.' && base::is_digit(text_[end + 1])) {
      ++end;
      while (end < text_.size() && base::is_digit(text_[end])) ++end;
    }
    token_.kind = TokenKind::kNumber;
  } else {
    return false;
  }
  position_ = end;
  return true;
}

bool Lexer::scan_operator() {
  const auto rest = text_.substr(position_, 3);
  for (const auto& spelled : kPunctuation) {
    if (!rest.starts_with(spelled.text)) continue;
    token_.kind = spelled.kind;
    token_.op = spelled.op;
    position_ += static_cast<std::uint32_t>(spelled.text.size());
    return true;
  }
  return false;
}

void Lexer::skip_percent_comment() {
  report_foreign(foreign_percent(), range(token_), sink_);
  position_ = line_end();
  scan();
}

std::uint32_t Lexer::line_end() const {
  const auto end = text_.find('\n', position_);
  return static_cast<std::uint32_t>(end == std::string_view::npos ? text_.size() : end);
}

bool Lexer::skip_foreign_comment() {
  const auto* foreign = foreign_sign(text_.substr(position_, 6));
  if (foreign == nullptr || foreign->kind != ForeignSpelling::Kind::kComment) return false;
  if (foreign->text.size() > 2) {  // `#count`: what follows the sign is read
    const auto word_end = position_ + static_cast<std::uint32_t>(foreign->text.size());
    report_foreign(*foreign, {file_, position_, word_end}, sink_);
    ++position_;
    return true;
  }
  const auto end = position_ + static_cast<std::uint32_t>(foreign->text.size());
  report_foreign(*foreign, {file_, position_, end}, sink_);
  position_ = line_end();
  return true;
}

/// `=>` and the like are reported, and become the operators that they are meant for.
bool Lexer::scan_foreign() {
  const auto* foreign = foreign_sign(text_.substr(position_, 3));
  if (foreign == nullptr) return false;
  const auto end = position_ + static_cast<std::uint32_t>(foreign->text.size());
  report_foreign(*foreign, {file_, position_, end}, sink_);
  token_.kind = TokenKind::kOperator;
  token_.op = foreign->op;
  position_ = end;
  return true;
}

void Lexer::scan() {
  for (;;) {
    skip_blanks();
    token_ = Token{};
    token_.begin = position_;
    token_.first_on_line = line_start_;
    if (position_ >= text_.size()) {
      token_.end = position_;
      return;
    }
    if (line_start_ && mode_ == Mode::kFile) {
      const auto kind = classify_line(text_.substr(position_));
      if (kind == LineKind::kStatement) {
        token_.kind = TokenKind::kStatementLine;
        token_.end = statement_end();
        return;
      }
      if (kind == LineKind::kFormulaTextOnlyHere) {
        auto end = position_;
        while (base::is_lower(text_[end])) ++end;
        sink_.warning(codes::kLineTakenForDeclaration, base::SourceRange{file_, position_, end},
                      shortened(text_.substr(position_, end - position_)));
      }
    }
    line_start_ = false;
    if (skip_foreign_comment()) continue;
    if (scan_word() || scan_foreign() || scan_operator()) {
      token_.end = position_;
      return;
    }
    skip_illegal();
  }
}

}  // namespace parallax::compiler
