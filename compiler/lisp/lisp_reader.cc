#include "compiler/lisp/lisp_reader.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/base/codes/plans.h"
#include "compiler/lisp/lisp_token.h"

namespace parallax::compiler {

using base::SourceRange;

namespace {

/// Kind of an open datum, which waits for its next part.
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
  std::optional<SourceRange> dot = std::nullopt;  // kList: where its dot stands
  std::size_t tail = 0;                           // the first child behind the dot
};

/// Reads a file without recursion: open data lie on a stack.
class LispReader {
 public:
  LispReader(const base::SourceFiles& files, base::FileId file, LispText into,
             base::DiagnosticSink& sink)
      : file_(file), cursor_(files[file].text()), sink_(sink), out_(std::move(into)) {}

  base::Result<LispText> read();

 private:
  base::SourceRange range(std::uint32_t begin) const { return {file_, begin, cursor_.position()}; }
  base::DiagnosticBuilder unreadable(base::SourceRange where, std::string_view text) {
    failed_ = true;
    return sink_.error(codes::kUnreadableDatum, where, text);
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
  void read_dot(std::string_view dots, SourceRange where);
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
        push({OpenKind::kSkip, top.begin, 0, {}, false, {}, 0});
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
  if (top.dot && finished_.size() != top.tail + 1) {
    unreadable(*top.dot, "one datum stands behind a dot, and `)` behind that");
  }
  const bool dotted = top.dot && finished_.size() == top.tail + 1;
  const auto list = dotted ? out_.data.add_dotted({children.begin(), children.end() - 1},
                                                  children.back(), range(top.begin))
                           : out_.data.add_list(children, range(top.begin));
  finished_.resize(top.first_child);
  deliver(list);
}

void LispReader::read_next() {
  const auto begin = cursor_.position();
  const auto prefix = [&](std::size_t length, std::string_view word) {
    cursor_.skip(length);
    push({OpenKind::kPrefix, begin, 0, word, false, {}, 0});
  };
  switch (cursor_.peek()) {
    case '(':
      if (!open_.empty() && !column_one_ && begin != 0 && cursor_.since(begin - 1) == "\n") {
        column_one_ = SourceRange{file_, begin, begin + 1};
      }
      cursor_.skip(1);
      push({OpenKind::kList, begin, finished_.size(), {}, false, {}, 0});
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
      read_dot(token.text, range(begin));
      return;
    }
  }
  read_symbol(token, begin);
}

/// The dot of (a . b). What is wrong with its neighbours is said where the list ends.
void LispReader::read_dot(std::string_view dots, SourceRange where) {
  const bool in_list = !open_.empty() && open_.back().kind == OpenKind::kList;
  if (dots != "." || !in_list || open_.back().dot || finished_.size() == open_.back().first_child) {
    if (!suppressed()) {
      unreadable(where, dots == "." ? "a dot stands once in a list, behind a datum of it"
                                    : "a symbol of dots only");
    }
    if (in_list) open_.back().dot.reset();  // one message is enough
    return;
  }
  open_.back().dot = where;
  open_.back().tail = finished_.size();
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
  deliver(out_.data.add_named(kind, name, text.substr(0, colon), range(begin), colons == 1));
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
  sink_.error(codes::kUnsupportedReaderMacro, range(begin),
              list_follows ? std::string("#(") : std::string(cursor_.since(begin)));
}

void LispReader::read_sharp() {
  const auto begin = cursor_.position();
  switch (cursor_.peek(1)) {
    case '\'':
      cursor_.skip(2);
      push({OpenKind::kPrefix, begin, 0, "function", false, {}, 0});
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
  return read_lisp(files, std::span(&file, 1), sink);
}

base::Result<LispText> read_lisp(const base::SourceFiles& files, std::span<const base::FileId> plan,
                                 base::DiagnosticSink& sink) {
  PARALLAX_REQUIRE(!plan.empty(), "a plan has at least one file");
  LispText text;
  text.file = plan.front();
  bool failed = false;
  for (const auto file : plan) {
    auto read = LispReader(files, file, std::move(text), sink).read();
    failed |= !read;
    text = read ? *std::move(read) : LispText{plan.front(), {}, {}, {}};
  }
  if (failed) return sink.already_reported();
  return text;
}

}  // namespace parallax::compiler
