#include "compiler/plan/lisp_reader.h"

#include <fmt/core.h>

#include <optional>
#include <string>
#include <utility>

#include "compiler/base/diagnostic_codes.h"
#include "compiler/plan/lisp_reader_state.h"

namespace parallax::compiler {

using base::DiagnosticCode;
using base::SourceRange;

namespace {

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

}  // namespace

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

base::Result<LispText> read_lisp(const base::SourceFiles& files, base::FileId file,
                                 base::DiagnosticSink& sink) {
  return LispReader(files, file, sink).read();
}

}  // namespace parallax::compiler
