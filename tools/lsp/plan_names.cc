// Names of plans and of the binding tables that give them a meaning in the model.
//
// A table's entry begins with what it is about (`motion going`), and the plan says the same in a
// designator: `(a motion (type going) ...)`. Both are read with the compiler's own cursors, word by
// word, so that a text with open brackets or a missing arrow still has names. Of a plan only the
// nesting of lists is followed: the list `(type going)` names a motion if the list around it begins
// with `a motion`. Linear in the text.

#include "tools/lsp/plan_names.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <utility>

#include "compiler/base/ascii.h"
#include "compiler/base/diagnostic.h"
#include "compiler/lisp/lisp_token.h"
#include "compiler/plan/binding_text.h"
#include "tools/lsp/file_text.h"

namespace parallax::tools::lsp {
namespace {

std::string lower(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(), base::to_lower);
  return out;
}

/// A word of a table with its place, without the prefix of its package.
struct PlacedWord {
  std::string text;
  std::size_t begin = 0, end = 0;
};

std::optional<PlacedWord> take_word(compiler::BindingCursor& cursor) {
  cursor.skip_blanks();
  auto word = cursor.peek_name();
  if (word.empty() || word.front() == '?') return std::nullopt;
  cursor.advance(word.size());
  while (!cursor.at_end() && cursor.peek() == ':') {
    cursor.advance();
    word = cursor.peek_name();
    cursor.advance(word.size());
  }
  if (word.empty()) return std::nullopt;
  return PlacedWord{lower(word), cursor.position() - word.size(), cursor.position()};
}

/// One entry of a table, as far as it is typed.
struct TableEntry {
  std::string kind;                // "motion"
  std::vector<PlacedWord> types;   // `going | driving`; the one name of a query or goal
  std::string event;               // empty: none
  std::optional<PlacedWord> plan;  // `-> plan fetch(...)`
  std::string alias_kind;          // `= motion going`; may be empty
  std::optional<PlacedWord> alias;
  std::size_t begin = 0, end = 0;
};

TableEntry read_entry(compiler::BindingCursor& cursor, std::size_t number) {
  cursor.enter(number);
  TableEntry entry;
  entry.begin = cursor.position();
  entry.end = entry.begin + cursor.rest().size();
  if (auto kind = take_word(cursor)) entry.kind = kind->text;
  if (entry.kind == "object") return entry;
  cursor.skip_blanks();
  if (entry.kind == "goal" && !cursor.at_end() && cursor.peek() == '(') cursor.advance();
  while (auto type = take_word(cursor)) {
    entry.types.push_back(*std::move(type));
    if (!cursor.take("|")) break;
  }
  if (cursor.take("=")) {
    entry.alias = take_word(cursor);
    if (entry.alias && (entry.alias->text == "motion" || entry.alias->text == "action")) {
      entry.alias_kind = entry.alias->text;
      entry.alias = take_word(cursor);
    }
    return entry;
  }
  const auto arrow = cursor.rest().find("->");
  if (arrow == std::string_view::npos || entry.kind == "query" || entry.kind == "goal")
    return entry;
  cursor.advance(arrow + 2);
  cursor.skip_blanks();
  const auto name = cursor.peek_name();
  cursor.advance(name.size());
  if (name == "plan") {
    entry.plan = take_word(cursor);
  } else {
    entry.event = name;
  }
  return entry;
}

std::vector<TableEntry> entries_of(const std::string& text) {
  base::DiagnosticSink unread;
  compiler::BindingCursor cursor(text, base::FileId(), unread);
  std::vector<TableEntry> out;
  for (std::size_t i = 0; i < cursor.entries(); ++i) out.push_back(read_entry(cursor, i));
  return out;
}

std::string key_of(std::string_view kind, std::string_view name) {
  return std::string(kind) + " " + std::string(name);
}

/// The kind of the entry that an alias means: the one it says, else the one that has the type.
std::string aliased_kind(const TableEntry& alias, const std::vector<TableEntry>& entries) {
  if (!alias.alias_kind.empty()) return alias.alias_kind;
  const auto has = [&](std::string_view kind) {
    return std::any_of(entries.begin(), entries.end(), [&](const auto& entry) {
      return entry.kind == kind && entry.begin != alias.begin &&
             std::any_of(entry.types.begin(), entry.types.end(),
                         [&](const auto& type) { return type.text == alias.alias->text; });
    });
  };
  if (has(alias.kind)) return alias.kind;
  return alias.kind == "action" ? "motion" : "action";
}

/// One open list of a plan.
struct OpenList {
  std::string head;    // its first symbol
  std::string second;  // and the next one
  std::size_t symbols = 0;
};

bool defines_function(std::string_view head) {
  return head == "defun" || head == "def-cram-function" || head == "def-top-level-cram-function";
}

/// The key that a symbol of a plan means by its place in the lists around it; empty: none.
std::string key_at(const std::vector<OpenList>& lists, const std::string& name, bool is_called) {
  if (lists.empty()) return {};
  const auto& list = lists.back();
  if (list.symbols == 2 && list.head == "type" && lists.size() > 1) {
    const auto& around = lists[lists.size() - 2];
    const bool is_article = around.head == "a" || around.head == "an" || around.head == "the";
    if (is_article && (around.second == "motion" || around.second == "action"))
      return key_of(around.second, name);
  }
  if (list.symbols == 1 && lists.size() > 1) {
    const auto& around = lists[lists.size() - 2].head;
    if (around == "prolog") return key_of("query", name);
    if (around == "goal") return key_of("goal", name);
  }
  if (list.symbols == 2 && defines_function(list.head)) return key_of("function", name);
  return list.symbols == 1 || is_called ? key_of("function", name) : std::string();
}

/// Calls `each(begin, end, key, lists)` for every symbol of a plan that may name something.
template <typename Each>
void each_plan_name(const std::string& text, const Each& each) {
  compiler::LispCursor cursor(text);
  std::vector<OpenList> lists;
  std::uint32_t comment = 0;
  bool is_quoted = false;  // 'name or #'name
  while (compiler::skip_blanks(cursor, comment) && !cursor.at_end()) {
    const char c = cursor.peek();
    if (c == '(') {
      lists.emplace_back();
      cursor.skip(1);
    } else if (c == ')') {
      if (!lists.empty()) lists.pop_back();
      cursor.skip(1);
    } else if (c == '"') {
      cursor.skip(1);
      while (!cursor.at_end() && cursor.peek() != '"') cursor.skip(cursor.peek() == '\\' ? 2 : 1);
      cursor.skip(1);
    } else if (c == '#' && cursor.peek(1) == '\'') {
      cursor.skip(2);
      is_quoted = true;
      continue;
    } else if (compiler::is_lisp_delimiter(c)) {
      cursor.skip(1);
      is_quoted = c == '\'';
      continue;
    } else {
      const auto begin = cursor.position();
      const auto token = compiler::scan_token(cursor);
      if (cursor.position() == begin) cursor.skip(1);  // never without progress
      const auto colon = token.text.rfind(':');
      const auto name = colon == std::string::npos ? token.text : token.text.substr(colon + 1);
      if (!lists.empty()) {
        auto& list = lists.back();
        ++list.symbols;
        if (list.symbols == 1) list.head = name;
        if (list.symbols == 2) list.second = name;
      }
      if (!token.escaped && !name.empty() && name.front() != '?') {
        auto key = key_at(lists, name, is_quoted);
        if (!key.empty()) each(cursor.position() - name.size(), cursor.position(), key, lists);
      }
    }
    is_quoted = false;
  }
}

}  // namespace

std::vector<DeclaredName> designators_of(const std::string& path, const std::string& text) {
  const auto entries = entries_of(text);
  std::vector<DeclaredName> out;
  for (const auto& entry : entries) {
    auto declaration = text.substr(entry.begin, entry.end - entry.begin);
    // Comments behind it belong to the next entry.
    if (const auto blank = declaration.find("\n\n"); blank != std::string::npos)
      declaration.resize(blank);
    while (!declaration.empty() &&
           (base::is_space(declaration.back()) || declaration.back() == ';'))
      declaration.pop_back();
    for (const auto& type : entry.types) {
      out.push_back({key_of(entry.kind, type.text), type.text, NameKind::kDesignator, declaration,
                     comment_above(text, entry.begin), path, type.begin, type.end, entry.event});
    }
  }
  // An alias performs the event of its entry.
  for (const auto& entry : entries) {
    if (!entry.alias) continue;
    const auto key = key_of(aliased_kind(entry, entries), entry.alias->text);
    const auto meant =
        std::find_if(out.begin(), out.end(), [&](const auto& name) { return name.key == key; });
    for (auto& name : out) {
      if (meant != out.end() && name.begin >= entry.begin && name.end <= entry.end)
        name.event = meant->event;
    }
  }
  return out;
}

std::vector<DeclaredName> functions_of(const std::string& path, const std::string& text) {
  std::vector<DeclaredName> out;
  each_plan_name(text, [&](std::size_t begin, std::size_t end, const std::string& key,
                           const std::vector<OpenList>& lists) {
    const auto& list = lists.back();
    if (list.symbols != 2 || !defines_function(list.head)) return;
    const auto line = std::min(text.find('\n', end), text.size());
    const auto start = text.rfind('(', begin);
    out.push_back({key, lower(std::string_view(text).substr(begin, end - begin)),
                   NameKind::kPlanFunction, text.substr(start, line - start),
                   comment_above(text, start), path, begin, end, ""});
  });
  return out;
}

std::vector<NameMap::Word> words_of_table(const std::string& text) {
  const auto entries = entries_of(text);
  std::vector<NameMap::Word> out;
  for (const auto& entry : entries) {
    for (const auto& type : entry.types)
      out.push_back({type.begin, type.end, key_of(entry.kind, type.text)});
    if (entry.alias) {
      out.push_back({entry.alias->begin, entry.alias->end,
                     key_of(aliased_kind(entry, entries), entry.alias->text)});
    }
    if (entry.plan)
      out.push_back({entry.plan->begin, entry.plan->end, key_of("function", entry.plan->text)});
  }
  return out;
}

std::vector<NameMap::Word> words_of_plan(const std::string& text) {
  std::vector<NameMap::Word> out;
  each_plan_name(
      text, [&](std::size_t begin, std::size_t end, std::string key, const std::vector<OpenList>&) {
        out.push_back({begin, end, std::move(key)});
      });
  return out;
}

}  // namespace parallax::tools::lsp
