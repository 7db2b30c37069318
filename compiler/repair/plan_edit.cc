#include "compiler/repair/plan_edit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <tuple>

#include "compiler/base/ground_name.h"
#include "compiler/repair/edit_grammar.h"

namespace parallax::compiler {
namespace {

constexpr std::size_t kPlanLineWidth = 100;

std::size_t column_of(std::string_view text, std::size_t at) {
  const auto line = text.rfind('\n', at == 0 ? 0 : at - 1);
  return at == 0 || line == std::string_view::npos ? at : at - line - 1;
}

/// The end of the parenthesis that opens at `begin`; actions have no parentheses in strings.
std::size_t closing(std::string_view text, std::size_t begin) {
  std::size_t open = 0;
  for (auto i = begin; i < text.size(); ++i) {
    if (text[i] == '(') ++open;
    if (text[i] == ')' && --open == 0) return i + 1;
  }
  return text.size();
}

/// An action on one line, or in several where it is too long: the parts of its designator then
/// stand below each other.
std::string laid_out(const std::string& action, std::size_t column) {
  const auto designator = action.find('(', 1);
  if (column + action.size() <= kPlanLineWidth || designator == std::string::npos) return action;
  const auto first = action.find('(', designator + 1);
  if (first == std::string::npos) return action;
  auto out = action.substr(0, first);
  auto used = column + first;
  for (auto at = first; at < action.size() && action[at] == '(';) {
    const auto end = closing(action, at);
    if (at != first && used + 1 + (end - at) + 2 > kPlanLineWidth) {
      out += "\n" + std::string(column + first, ' ');
      used = column + first;
    } else if (at != first) {
      out += ' ';
      ++used;
    }
    out += action.substr(at, end - at);
    used += end - at;
    at = end;
    while (at < action.size() && action[at] == ' ') ++at;
    if (at < action.size() && action[at] == '(') continue;
    return out + action.substr(at);
  }
  return out;
}

/// Text around a statement: `open` is followed by a line end, and the statement is indented by
/// `indent` more columns.
struct Wrapping {
  std::vector<std::string> open;      // lines, the first at the statement's own column
  std::vector<std::size_t> indented;  // lines behind the first, relative to it
  std::size_t indent = 2;
  std::string close;
};

/// `(when C` or `(unless C`, without the body.
std::string asking(const std::string& condition) {
  constexpr std::string_view kNot = "(not ";
  if (!condition.starts_with(kNot)) return "(when " + condition;
  return "(unless " + condition.substr(kNot.size(), condition.size() - kNot.size() - 1);
}

std::string counter_name(const PlanText& plan) {
  std::string name = "tries";
  for (int i = 2; plan.data().knows_name(name); ++i) name = fmt::format("tries-{}", i);
  return name;
}

Wrapping wrapping(const PlanText& plan, const PlanEdit& edit) {
  switch (edit.kind) {
    case PlanEdit::Kind::kGuard:
      return {{asking(edit.condition)}, {}, 2, ")"};
    case PlanEdit::Kind::kRetry: {
      const auto tries = counter_name(plan);
      return {
          {fmt::format("({} (({} {}))", plan.prefixed("with-retry-counters"), tries, kPlanRetries),
           fmt::format("({}", plan.prefixed("with-failure-handling")),
           fmt::format("(({} (e) ({} {} ({}))))", plan.prefixed(edit.failure),
                       plan.prefixed("do-retry"), tries, plan.prefixed("retry"))},
          {2, 6},
          4,
          "))"};
    }
    case PlanEdit::Kind::kHandle:
      return {{fmt::format("({}", plan.prefixed("with-failure-handling")),
               fmt::format("(({} (e) (return)))", plan.prefixed(edit.failure))},
              {4},
              2,
              ")"};
    case PlanEdit::Kind::kInsert:
    case PlanEdit::Kind::kMove:
      break;
  }
  return {};
}

/// Lines of the form that begin inside a string keep their beginning.
bool in_string(const PlanText& plan, DatumId form, std::uint32_t at) {
  bool inside = false;
  plan.for_each_datum({form}, [&](DatumId datum) {
    const auto& source = plan.source(datum);
    inside = inside || (plan.data().is_string(datum) && source.begin < at && at < source.end);
  });
  return inside;
}

void wrap(const PlanText& plan, const PlanEdit& edit, std::vector<TextChange>& out) {
  const auto& source = plan.source(edit.at);
  const auto text = plan.files()[source.file].text();
  const auto column = column_of(text, source.begin);
  const auto around = wrapping(plan, edit);
  auto open = around.open.front();
  for (std::size_t i = 1; i < around.open.size(); ++i) {
    open += "\n" + std::string(column + around.indented[i - 1], ' ') + around.open[i];
  }
  open += "\n" + std::string(column + around.indent, ' ');
  out.push_back({source.file, source.begin, source.begin, std::move(open)});
  for (auto i = source.begin; i < source.end; ++i) {
    if (text[i] != '\n' || text[i + 1] == '\n' || in_string(plan, edit.at, i + 1)) continue;
    out.push_back({source.file, i + 1, i + 1, std::string(around.indent, ' ')});
  }
  out.push_back({source.file, source.end, source.end, around.close});
}

/// The text of a form at another column: its further lines are moved like the first.
std::string moved_text(const PlanText& plan, DatumId form, std::size_t column) {
  const auto& source = plan.source(form);
  const auto text = plan.files()[source.file].text();
  const auto from = column_of(text, source.begin);
  std::string out;
  for (auto i = source.begin; i < source.end; ++i) {
    out += text[i];
    if (text[i] != '\n' || in_string(plan, form, i + 1)) continue;
    if (column >= from) {
      if (text[i + 1] != '\n') out += std::string(column - from, ' ');
      continue;
    }
    for (auto drop = from - column; drop > 0 && text[i + 1] == ' '; --drop) ++i;
  }
  return out;
}

bool is_layout(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

}  // namespace

TextChange statement_dropped(const PlanText& plan, DatumId form) {
  const auto& source = plan.source(form);
  const auto text = plan.files()[source.file].text();
  auto begin = source.begin;
  while (begin > 0 && is_layout(text[begin - 1])) --begin;
  // Behind a comment the line end stays, or the text after it would become part of the comment.
  const auto line = text.rfind('\n', begin == 0 ? 0 : begin - 1);
  const auto line_begin = line == std::string_view::npos ? 0 : line + 1;
  const bool comment = text.substr(line_begin, begin - line_begin).find(';') != text.npos;
  if (comment) {
    begin = source.begin;
    while (begin > 0 && (text[begin - 1] == ' ' || text[begin - 1] == '\t')) --begin;
  }
  auto end = source.end;
  if (comment && end < text.size() && text[end] == '\n') ++end;
  return {source.file, begin, end, ""};
}

std::vector<TextChange> plan_changes(const PlanText& plan, const std::vector<PlanEdit>& edits) {
  std::vector<TextChange> out;
  for (const auto& edit : edits) {
    const auto& source = plan.source(edit.at);
    const auto column = column_of(plan.files()[source.file].text(), source.begin);
    const auto in_front = [&](std::string text) {
      out.push_back({source.file, source.begin, source.begin,
                     std::move(text) + "\n" + std::string(column, ' ')});
    };
    switch (edit.kind) {
      case PlanEdit::Kind::kInsert:
        if (edit.condition.empty()) {
          in_front(laid_out(edit.action, column));
        } else {
          in_front(fmt::format("{}\n{}{})", asking(edit.condition), std::string(column + 2, ' '),
                               laid_out(edit.action, column + 2)));
        }
        break;
      case PlanEdit::Kind::kMove:
        in_front(moved_text(plan, *edit.moved, column));
        out.push_back(statement_dropped(plan, *edit.moved));
        break;
      case PlanEdit::Kind::kGuard:
      case PlanEdit::Kind::kRetry:
      case PlanEdit::Kind::kHandle:
        wrap(plan, edit, out);
        break;
    }
  }
  return out;
}

std::string form_words(const PlanText& plan, DatumId form) {
  std::string text;
  for (const char c : plan.written(form)) {
    if (!is_layout(c)) {
      text += c;
    } else if (!text.empty() && text.back() != ' ') {
      text += ' ';
    }
  }
  constexpr std::size_t kMost = 60;
  if (text.size() > kMost) text = text.substr(0, kMost - 3) + "...";
  return fmt::format("`{}` ({})", text, plan.place(form));
}

std::string plan_edit_words(const PlanText& plan, const PlanEdit& edit) {
  switch (edit.kind) {
    case PlanEdit::Kind::kInsert:
      return fmt::format("`{}` is done in front of {}{}", edit.action, form_words(plan, edit.at),
                         edit.condition.empty() ? "" : ", where `" + edit.condition + "`");
    case PlanEdit::Kind::kMove:
      return fmt::format("{} goes in front of {}", form_words(plan, *edit.moved),
                         form_words(plan, edit.at));
    case PlanEdit::Kind::kGuard:
      return fmt::format("{} is done only where `{}`", form_words(plan, edit.at), edit.condition);
    case PlanEdit::Kind::kRetry:
      return fmt::format("{} is tried again, {} times at most, where it fails with `{}`",
                         form_words(plan, edit.at), kPlanRetries, edit.failure);
    case PlanEdit::Kind::kHandle:
      return fmt::format("where {} fails with `{}`, the plan goes on behind it",
                         form_words(plan, edit.at), edit.failure);
  }
  return {};
}

std::string plan_edit_fluent(std::size_t edit) { return fmt::format("PlanEdit{}", edit); }

namespace {

/// Texts that are put in at a place: those of a form that ends there stand in front of those of one
/// that begins.
struct Piece {
  base::FileId file;
  std::uint32_t at = 0;
  bool begins = false;
  std::string text;
  std::size_t edit = 0;
};

}  // namespace

GuardedPlan guarded_plan(const PlanText& plan, const std::vector<PlanEdit>& edits) {
  std::vector<Piece> pieces;
  const auto add = [&](DatumId form, std::size_t edit, bool begins, std::string text) {
    const auto& source = plan.source(form);
    pieces.push_back(
        {source.file, begins ? source.begin : source.end, begins, std::move(text), edit});
  };
  // Wrappings of a form lie around each other, insertions in front of all of them.
  std::map<DatumId, std::pair<std::vector<std::size_t>, std::vector<std::size_t>>> by_form;
  for (std::size_t i = 0; i < edits.size(); ++i) {
    const bool before =
        edits[i].kind == PlanEdit::Kind::kInsert || edits[i].kind == PlanEdit::Kind::kMove;
    (before ? by_form[edits[i].at].first : by_form[edits[i].at].second).push_back(i);
  }
  std::map<DatumId, std::vector<std::size_t>> moved;
  for (std::size_t i = 0; i < edits.size(); ++i) {
    if (edits[i].moved) {
      moved[*edits[i].moved].push_back(i);
      by_form[*edits[i].moved];
    }
  }
  for (const auto& [form, of_form] : by_form) {
    const auto question = [&](std::size_t i) {
      return fmt::format("(holds '({}))", plan_name(plan_edit_fluent(i)));
    };
    for (const auto i : of_form.first) {
      const auto& edit = edits[i];
      const auto action = edit.moved ? std::string(plan.written(*edit.moved)) : edit.action;
      add(form, i, true, fmt::format("(when {} {}\n) ", question(i), action));
    }
    std::vector<std::string> closing;
    const auto around = [&](std::size_t i, std::string open, std::string close) {
      add(form, i, true, std::move(open));
      closing.push_back(std::move(close));
    };
    for (const auto i : moved[form]) around(i, fmt::format("(unless {} ", question(i)), "\n)");
    for (const auto i : of_form.second) {
      const auto& edit = edits[i];
      if (edit.kind == PlanEdit::Kind::kGuard) {
        around(i, fmt::format("(when (or (not {}) {}) ", question(i), edit.condition), "\n)");
      } else if (edit.kind == PlanEdit::Kind::kRetry) {
        around(i,
               fmt::format("(with-retry-counters ((%tries{} {})) (with-failure-handling (({} (e) "
                           "(when {} (do-retry %tries{} (retry))))) ",
                           i, kPlanRetries, edit.failure, question(i), i),
               "\n))");
      } else {
        around(i,
               fmt::format("(with-failure-handling (({} (e) (when {} (return)))) ", edit.failure,
                           question(i)),
               "\n)");
      }
    }
    std::reverse(closing.begin(), closing.end());
    for (auto& text : closing) add(form, edits.size(), false, std::move(text));
  }
  std::stable_sort(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) {
    return std::tuple(a.file, a.at, a.begins) < std::tuple(b.file, b.at, b.begins);
  });
  GuardedPlan out;
  out.parts.resize(edits.size());
  for (std::size_t i = 0; i < pieces.size();) {
    const auto file = pieces[i].file;
    const auto text = plan.files()[file].text();
    const auto& name = plan.files()[file].name();
    std::string guarded;
    std::size_t at = 0;
    for (; i < pieces.size() && pieces[i].file == file; ++i) {
      guarded += text.substr(at, pieces[i].at - at);
      at = pieces[i].at;
      const auto begin = guarded.size();
      guarded += pieces[i].text;
      if (pieces[i].edit < edits.size()) {
        out.parts[pieces[i].edit].push_back({name, begin, guarded.size()});
      }
    }
    guarded += text.substr(at);
    out.files.emplace(name, std::move(guarded));
  }
  return out;
}

std::string plan_name(const std::string& model_name) {
  std::string out;
  for (std::size_t i = 0; i < model_name.size(); ++i) {
    const auto c = static_cast<unsigned char>(model_name[i]);
    if (std::isupper(c) != 0 && i > 0 &&
        std::isupper(static_cast<unsigned char>(model_name[i - 1])) == 0) {
      out += '-';
    }
    out += static_cast<char>(std::tolower(c));
  }
  return out;
}

std::string plan_condition(const std::string& fluent, bool holds) {
  std::string question = "(holds '(" + plan_name(base::symbol_of(fluent));
  for (const auto& argument : arguments_of(fluent)) question += " " + plan_name(argument);
  question += "))";
  return holds ? question : "(not " + question + ")";
}

}  // namespace parallax::compiler
