#include "compiler/plan/lisp_reader.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/base/ascii.h"
#include "compiler/base/diagnostic_codes.h"

namespace parallax::compiler {

using base::DiagnosticCode;
using base::SourceRange;

namespace {

/// A cursor over the text of one plan file. Byte offsets; never past the end.
class LispCursor {
 public:
  explicit LispCursor(std::string_view text) : text_(text) {}
  bool at_end() const { return position_ >= text_.size(); }
  std::uint32_t position() const { return static_cast<std::uint32_t>(position_); }
  /// The byte `ahead` of the cursor; 0 beyond the end.
  char peek(std::size_t ahead = 0) const {
    return position_ + ahead < text_.size() ? text_[position_ + ahead] : '\0';
  }
  char take() { return text_[position_++]; }
  void skip(std::size_t count) { position_ = std::min(position_ + count, text_.size()); }
  std::string_view since(std::uint32_t begin) const {
    return text_.substr(begin, position_ - begin);
  }

 private:
  std::string_view text_;
  std::size_t position_ = 0;
};

/// A symbol-like token: letters outside |bars| folded to lower case, escapes resolved.
struct LispToken {
  std::string text;
  bool escaped = false;           // some part was written in |bars| or after a backslash
  bool unterminated = false;      // the text ended inside |bars|
  bool ends_with_colon = false;   // unescaped
  std::int64_t first_colon = -1;  // index in `text` of the first unescaped colon
  std::int64_t colons = 0;        // number of unescaped colons
};

bool skip_block_comment(LispCursor& cursor) {
  std::int64_t depth = 0;
  do {
    if (cursor.at_end()) return false;
    if (cursor.peek() == '#' && cursor.peek(1) == '|') {
      ++depth;
      cursor.skip(2);
    } else if (cursor.peek() == '|' && cursor.peek(1) == '#') {
      --depth;
      cursor.skip(2);
    } else {
      cursor.skip(1);
    }
  } while (depth > 0);
  return true;
}

/// The inside of |bars|, the cursor behind the opening one.
void scan_bars(LispCursor& cursor, LispToken& token) {
  token.escaped = true;
  while (!cursor.at_end()) {
    char c = cursor.take();
    if (c == '|') return;
    if (c == '\\' && !cursor.at_end()) c = cursor.take();
    token.text += c;
  }
  token.unterminated = true;
}

bool is_lisp_blank(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f' || c == '\v';
}

/// Ends a token: blanks and ( ) " ' ; ` ,
bool is_lisp_delimiter(char c) {
  return is_lisp_blank(c) || std::string_view("()\"';`,").find(c) != std::string_view::npos;
}

LispToken scan_token(LispCursor& cursor) {
  LispToken token;
  while (!cursor.at_end() && !is_lisp_delimiter(cursor.peek())) {
    const char c = cursor.take();
    token.ends_with_colon = c == ':';
    if (c == '|') {
      scan_bars(cursor, token);
    } else if (c == '\\') {
      token.escaped = true;
      if (cursor.at_end()) {
        token.unterminated = true;
      } else {
        token.text += cursor.take();
      }
    } else {
      if (c == ':') {
        if (token.first_colon < 0) token.first_colon = static_cast<std::int64_t>(token.text.size());
        ++token.colons;
      }
      token.text += base::to_lower(c);
    }
  }
  return token;
}

/// Skips blanks, `; comments` and nested `#| comments |#`. False if a block comment does not end;
/// `begin` is then its place.
bool skip_blanks(LispCursor& cursor, std::uint32_t& begin) {
  while (!cursor.at_end()) {
    if (is_lisp_blank(cursor.peek())) {
      cursor.skip(1);
    } else if (cursor.peek() == ';') {
      while (!cursor.at_end() && cursor.peek() != '\n') cursor.skip(1);
    } else if (cursor.peek() == '#' && cursor.peek(1) == '|') {
      begin = cursor.position();
      if (!skip_block_comment(cursor)) return false;
    } else {
      return true;
    }
  }
  return true;
}

/// What waits for its next datum.
enum class OpenKind : std::uint8_t {
  kList,
  kPrefix,   // 'x and the like: takes one datum
  kFeature,  // #+ or #-: takes the feature expression
  kSkip,     // takes one datum and drops it
};

struct OpenDatum {
  OpenKind kind = OpenKind::kList;
  std::uint32_t begin = 0;
  std::size_t first_child = 0;  // kList: index into the stack of finished children
  std::string_view word;        // kPrefix: the symbol at the head of the list
  bool negated = false;         // kFeature: #-
};

/// Reads a file without recursion: what is open lies on a stack.
class LispReader {
 public:
  LispReader(const base::SourceFiles& files, base::FileId file, base::DiagnosticSink& sink)
      : file_(file), cursor_(files[file].text()), sink_(sink) {}

  base::Result<LispText> read();

 private:
  base::SourceRange range(std::uint32_t begin) const { return {file_, begin, cursor_.position()}; }
  base::DiagnosticBuilder unreadable(base::SourceRange where, std::string_view text) {
    failed_ = true;
    return sink_.error(base::DiagnosticCode::kUnreadableDatum, where, text);
  }
  bool suppressed() const { return skips_ != 0; }
  bool push(OpenDatum open);
  void pop();
  void deliver(DatumId datum);
  void deliver_once(DatumId datum, std::optional<DatumId>& wrapped);
  void close_list();
  void read_next();
  void read_string();
  void read_token();
  void read_symbol(const LispToken& token, std::uint32_t begin);
  void read_sharp();
  void read_character(std::uint32_t begin);
  void reject_macro(std::uint32_t begin);
  void report_open_list();

  base::FileId file_;
  LispCursor cursor_;
  base::DiagnosticSink& sink_;
  LispText out_;
  std::vector<OpenDatum> open_;
  std::vector<DatumId> finished_;                // children of the open lists
  std::size_t skips_ = 0;                        // open kSkip frames
  std::optional<base::SourceRange> column_one_;  // first `(` at column 1 inside an open list
  bool failed_ = false;
  bool stopped_ = false;
};

/// True if `feature` holds with the feature set {seecer}.
bool feature_holds(const LispData& data, DatumId feature) {
  const auto head = data.head(feature);
  if (!head) return !data.is_list(feature) && data.name(feature) == "seecer";
  const auto items = data.children(feature).subspan(1);
  if (*head == "not") return items.empty() || !feature_holds(data, items.front());
  const bool all = *head == "and";
  for (const auto item : items) {
    if (feature_holds(data, item) != all) return !all;
  }
  return all;
}

bool LispReader::push(OpenDatum open) {
  if (open_.size() >= kMaxLispDepth) {
    unreadable(range(open.begin), fmt::format("nested deeper than {}", kMaxLispDepth));
    stopped_ = true;
    return false;
  }
  if (open.kind == OpenKind::kSkip) ++skips_;
  open_.push_back(open);
  return true;
}

void LispReader::pop() {
  if (open_.back().kind == OpenKind::kSkip) --skips_;
  open_.pop_back();
}

/// Hands a finished datum to what waits for it: prefixes wrap it and pass it on.
void LispReader::deliver(DatumId datum) {
  if (out_.data.size() > kMaxLispData) {
    unreadable(out_.data.source(datum), fmt::format("more than {} data", kMaxLispData));
    stopped_ = true;
    return;
  }
  std::optional<DatumId> current = datum;
  while (current) {
    std::optional<DatumId> wrapped;
    deliver_once(*current, wrapped);
    current = wrapped;
  }
}

void LispReader::deliver_once(DatumId datum, std::optional<DatumId>& wrapped) {
  if (open_.empty()) {
    out_.forms.push_back(datum);
    return;
  }
  const OpenDatum top = open_.back();
  switch (top.kind) {
    case OpenKind::kList:
      finished_.push_back(datum);
      return;
    case OpenKind::kPrefix: {
      pop();
      const SourceRange word{file_, top.begin, top.begin + 1};
      const DatumId items[] = {out_.data.add_named(DatumKind::kSymbol, top.word, "", word), datum};
      wrapped = out_.data.add_list(items, range(top.begin));
      return;
    }
    case OpenKind::kFeature:
      pop();
      // A branch that is kept is simply read on; the other one is read and dropped.
      if (feature_holds(out_.data, datum) == top.negated)
        push({OpenKind::kSkip, top.begin, 0, {}, false});
      return;
    case OpenKind::kSkip:
      pop();
      return;
  }
}

void LispReader::close_list() {
  const auto begin = cursor_.position();
  cursor_.skip(1);
  if (open_.empty()) {
    unreadable(range(begin), "unmatched `)`");
    return;
  }
  while (!open_.empty() && open_.back().kind != OpenKind::kList) {
    unreadable({file_, open_.back().begin, open_.back().begin + 1}, "nothing follows this prefix");
    pop();
  }
  if (open_.empty()) return;
  const OpenDatum top = open_.back();
  pop();
  const auto children = std::span(finished_).subspan(top.first_child);
  const auto list = out_.data.add_list(children, range(top.begin));
  finished_.resize(top.first_child);
  deliver(list);
}

void LispReader::read_next() {
  const auto begin = cursor_.position();
  const auto prefix = [&](std::size_t length, std::string_view word) {
    cursor_.skip(length);
    push({OpenKind::kPrefix, begin, 0, word, false});
  };
  switch (cursor_.peek()) {
    case '(':
      if (!open_.empty() && !column_one_ && begin != 0 && cursor_.since(begin - 1) == "\n") {
        column_one_ = SourceRange{file_, begin, begin + 1};
      }
      cursor_.skip(1);
      push({OpenKind::kList, begin, finished_.size(), {}, false});
      return;
    case ')':
      close_list();
      // Only a form at column 1 inside the list that stays open to the end is a hint.
      if (open_.empty()) column_one_.reset();
      return;
    case '"':
      return read_string();
    case '\'':
      return prefix(1, "quote");
    case '`':
      return prefix(1, "quasiquote");
    case ',':
      if (cursor_.peek(1) == '@') return prefix(2, "unquote-splicing");
      return prefix(1, "unquote");
    case '#':
      return read_sharp();
    default:
      return read_token();
  }
}

void LispReader::report_open_list() {
  const auto& outermost = open_.front();
  const SourceRange where{file_, outermost.begin, outermost.begin + 1};
  if (outermost.kind != OpenKind::kList) {
    unreadable(where, "nothing follows this prefix");
    return;
  }
  auto error = unreadable(where, "this list does not end");
  if (column_one_) error.note(*column_one_, "a form starts in column 1 here, inside that list");
}

base::Result<LispText> LispReader::read() {
  out_.file = file_;
  while (!stopped_) {
    std::uint32_t comment = 0;
    if (!skip_blanks(cursor_, comment)) {
      unreadable({file_, comment, comment + 2}, "this comment does not end");
      break;
    }
    if (cursor_.at_end()) {
      if (!open_.empty()) report_open_list();
      break;
    }
    read_next();
  }
  if (failed_) return sink_.already_reported();
  return std::move(out_);
}

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

}  // namespace

base::Result<LispText> read_lisp(const base::SourceFiles& files, base::FileId file,
                                 base::DiagnosticSink& sink) {
  return LispReader(files, file, sink).read();
}

}  // namespace parallax::compiler
