// Strings, numbers, symbols, characters, and what begins with `#`.
#include <string>

#include "compiler/base/diagnostic_codes.h"
#include "compiler/plan/lisp_reader_state.h"

namespace parallax::compiler {

using base::DiagnosticCode;

void LispReader::read_string() {
  const auto begin = cursor_.position();
  cursor_.skip(1);
  std::string text;
  while (!cursor_.at_end()) {
    char c = cursor_.take();
    if (c == '"') {
      return deliver(out_.data.add_named(DatumKind::kString, text, "", range(begin)));
    }
    if (c == '\\' && !cursor_.at_end()) c = cursor_.take();
    text += c;
  }
  unreadable({file_, begin, begin + 1}, "this string does not end");
  stopped_ = true;
}

void LispReader::read_token() {
  const auto begin = cursor_.position();
  const auto token = scan_token(cursor_);
  if (token.unterminated) {
    unreadable({file_, begin, begin + 1}, "this symbol does not end");
    stopped_ = true;
    return;
  }
  if (!token.escaped) {
    Number number;
    switch (Number::parse(token.text, number)) {
      case Number::Parse::kNumber:
        return deliver(out_.data.add_number(number, range(begin)));
      case Number::Parse::kOutOfRange:
        unreadable(range(begin), "this number is out of range");
        return deliver(out_.data.add_number(Number(0), range(begin)));
      case Number::Parse::kZeroDenominator:
        unreadable(range(begin), "this ratio has the denominator 0");
        return deliver(out_.data.add_number(Number(0), range(begin)));
      case Number::Parse::kNotANumber:
        break;
    }
    if (token.text.find_first_not_of('.') == std::string::npos) {
      unreadable(range(begin), "dotted pairs are not read");
      return;
    }
  }
  read_symbol(token, begin);
}

void LispReader::read_symbol(const LispToken& token, std::uint32_t begin) {
  if (token.first_colon < 0) {
    return deliver(out_.data.add_named(DatumKind::kSymbol, token.text, "", range(begin)));
  }
  const auto colon = static_cast<std::size_t>(token.first_colon);
  const auto colons = static_cast<std::size_t>(token.colons);
  const std::string_view text = token.text;
  const auto name = text.substr(std::min(colon + colons, text.size()));
  const bool together = text.substr(colon, colons).find_first_not_of(':') == std::string_view::npos;
  const bool well_formed = together && !token.ends_with_colon && colons <= (colon == 0 ? 1U : 2U);
  if (!well_formed) unreadable(range(begin), "misplaced `:` in this symbol");
  const auto kind = colon == 0 ? DatumKind::kKeyword : DatumKind::kSymbol;
  deliver(out_.data.add_named(kind, name, text.substr(0, colon), range(begin)));
}

void LispReader::read_character(std::uint32_t begin) {
  cursor_.skip(2);
  const auto name_begin = cursor_.position();
  if (cursor_.at_end()) {
    unreadable(range(begin), "a character is missing after `#\\`");
    return;
  }
  const bool delimiter = is_lisp_delimiter(cursor_.take());
  while (!delimiter && !cursor_.at_end() && !is_lisp_delimiter(cursor_.peek())) cursor_.skip(1);
  const auto name = cursor_.since(name_begin);
  deliver(out_.data.add_named(DatumKind::kCharacter, name, "", range(begin)));
}

/// Reports the macro and goes on behind its letters, so that the datum after it is read plainly.
void LispReader::reject_macro(std::uint32_t begin) {
  cursor_.skip(1);
  while (cursor_.peek() >= '0' && cursor_.peek() <= '9') cursor_.skip(1);
  const bool list_follows = cursor_.peek() == '(';
  if (!cursor_.at_end() && !list_follows) cursor_.skip(1);
  if (suppressed()) return;
  failed_ = true;
  sink_.error(DiagnosticCode::kUnsupportedReaderMacro, range(begin),
              list_follows ? std::string("#(") : std::string(cursor_.since(begin)));
}

void LispReader::read_sharp() {
  const auto begin = cursor_.position();
  switch (cursor_.peek(1)) {
    case '\'':
      cursor_.skip(2);
      push({OpenKind::kPrefix, begin, 0, "function", false});
      return;
    case '+':
    case '-': {
      const bool negated = cursor_.peek(1) == '-';
      cursor_.skip(2);
      push({OpenKind::kFeature, begin, 0, {}, negated});
      return;
    }
    case '\\':
      return read_character(begin);
    case ':':  // an uninterned symbol, as in (in-package #:demo)
      cursor_.skip(2);
      return read_token();
    default:
      return reject_macro(begin);
  }
}

}  // namespace parallax::compiler
