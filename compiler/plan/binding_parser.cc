#include "compiler/plan/binding_parser.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "compiler/base/ascii.h"
#include "compiler/base/diagnostic_codes.h"

namespace parallax::compiler {

using base::DiagnosticCode;

namespace {

/// Characters of types, keys and failure classes.
bool is_name(char c) {
  return !base::is_space(c) && std::string_view("()|=,;:@/").find(c) == std::string_view::npos;
}

}  // namespace

std::size_t variable_length(std::string_view text) {
  if (text.empty() || text.front() != '?') return 0;
  std::size_t i = 1;
  while (i < text.size()) {
    const bool hyphen =
        text[i] == '-' && i + 1 < text.size() && base::is_name_character(text[i + 1]);
    if (!base::is_name_character(text[i]) && !hyphen) break;
    ++i;
  }
  return i == 1 ? 0 : i;
}

std::string_view BindingParser::peek_name() const {
  auto stop = i_;
  while (stop < end_ && is_name(text_[stop]) &&
         !std::string_view(text_).substr(stop, end_ - stop).starts_with("->")) {
    ++stop;
  }
  return std::string_view(text_).substr(i_, stop - i_);
}

bool BindingParser::expected(std::string_view what) {
  skip_blanks();
  failed_ = true;
  auto stop = i_;
  while (stop < end_ && !base::is_space(text_[stop]) && stop - i_ < 40) ++stop;
  const auto found = i_ == end_ ? std::string("the end of the entry")
                                : fmt::format("`{}`", text_.substr(i_, stop - i_));
  sink_.error(DiagnosticCode::kBindingSyntax, range(i_, stop), what, found);
  return false;
}

bool BindingParser::name(std::string_view what, std::string& out) {
  skip_blanks();
  const auto word = peek_name();
  if (word.empty() || word.front() == '?') return expected(what);
  out = word;
  i_ += word.size();
  return true;
}

bool BindingParser::types_of(std::vector<std::string>& types) {
  do {
    std::string type;
    if (!name("the name of a type", type)) return false;
    types.push_back(std::move(type));
  } while (take("|"));
  return true;
}

bool BindingParser::parse_alias(Alias alias) {
  if (take_word("motion")) alias.target_kind = PerformKind::kMotion;
  if (!alias.target_kind && take_word("action")) alias.target_kind = PerformKind::kAction;
  const auto begin = (skip_blanks(), i_);
  if (!name("the name of a type", alias.target)) return false;
  alias.source = range(begin, i_);
  alias.position = out_.entries.size();
  skip_blanks();
  if (i_ != end_) return expected("nothing behind an alias");
  aliases_.push_back(std::move(alias));
  return true;
}

bool BindingParser::parse_key(BindingEntry& entry) {
  BindingKey key;
  if (!take(":")) return expected("a key such as `:target`");
  std::string word;
  if (!name("the name of a key", word)) return false;
  key.key = normalise_key(word);
  skip_blanks();
  if (const auto property = peek_name(); !property.empty() && property.front() != '?') {
    key.property = property;
    i_ += property.size();
    skip_blanks();
  }
  const auto length = variable_length(std::string_view(text_).substr(i_, end_ - i_));
  if (length != 0) {
    key.variable = text_.substr(i_, length);
    i_ += length;
  } else {
    key.variable = key.key == "target" ? "?p" : fmt::format("?{}", key.key.substr(0, 1));
  }
  entry.keys.push_back(std::move(key));
  return true;
}

bool BindingParser::parse_keys(BindingEntry& entry) {
  if (!take("(")) return true;  // a type without arguments
  while (!take(")")) {
    skip_blanks();
    if (i_ == end_) return expected("`)`");
    if (!parse_key(entry)) return false;
  }
  return true;
}

bool BindingParser::parse_arguments(BindingEntry& entry) {
  constexpr std::size_t kMaxArguments = 100;
  if (!take("(")) return true;
  int depth = 0;
  auto begin = i_;
  for (; i_ < end_; ++i_) {
    const char c = text_[i_];
    const bool ends = depth == 0 && (c == ',' || c == ')');
    if (ends) {
      const bool empty =
          std::all_of(text_.begin() + static_cast<std::ptrdiff_t>(begin),
                      text_.begin() + static_cast<std::ptrdiff_t>(i_), base::is_space);
      if (empty && c == ')' && entry.event_arguments.empty()) return ++i_, true;  // E()
      if (empty) return expected("an argument of the event");
      if (entry.event_arguments.size() == kMaxArguments) {
        return expected(fmt::format("at most {} arguments", kMaxArguments));
      }
      const auto argument = read_formula_tree(range(begin, i_), text_, sink_);
      if (!argument) return failed_ = true, false;
      entry.event_arguments.push_back(without_blanks(*argument));
      begin = i_ + 1;
      if (c == ')') return ++i_, true;
    }
    if (c == '(') ++depth;
    if (c == ')') --depth;
  }
  return expected("`)`");
}

bool BindingParser::parse_event(BindingEntry& entry) {
  if (!take("->")) return expected(entry.keys.empty() ? "`(`, `->` or `=`" : "`->`");
  if (take_word("plan")) return parse_plan_call(entry);
  return name("the event", entry.event_symbol) && parse_arguments(entry);
}

bool BindingParser::parse_formula(BindingEntry& entry) {
  if (!take("ok:")) return expected("`ok:` and the formula of success");
  skip_blanks();
  const auto begin = i_;
  while (i_ < end_ && text_[i_] != '@') ++i_;
  auto stop = i_;
  while (stop > begin && base::is_space(text_[stop - 1])) --stop;
  if (i_ == end_) return expected("`@t` or `@t+1` behind the formula");
  if (stop == begin) return expected("a formula before `@`");
  entry.formula_source = range(begin, stop);
  auto formula = read_formula_tree(entry.formula_source, text_, sink_);
  if (!formula) return failed_ = true, false;
  entry.formula = std::move(*formula);
  if (take("@t+1")) {
    entry.time_offset = 1;
  } else if (!take("@t")) {
    return expected("`@t` or `@t+1`");
  }
  if (i_ < end_ && !base::is_space(text_[i_])) return expected("`@t` or `@t+1`");
  return true;
}

bool BindingParser::parse_tail(BindingEntry& entry) {
  for (;;) {
    skip_blanks();
    if (i_ == end_) return true;
    if (take_word("returns")) {
      std::string variable;
      if (!name("the variable that is returned", variable)) return false;
      entry.returns = std::move(variable);
    } else if (take_word("else")) {
      const auto begin = (skip_blanks(), i_);
      if (!name("a failure class", entry.failure_class)) return false;
      entry.failure_source = range(begin, i_);
    } else {
      return expected("`returns`, `else` or the next entry");
    }
  }
}

void BindingParser::parse_entry() {
  BindingEntry entry;
  const auto begin = i_;
  if (take_word("query")) return parse_query(begin);
  if (take_word("object")) return parse_object(begin);
  entry.kind = take_word("motion") ? PerformKind::kMotion : PerformKind::kAction;
  if (entry.kind == PerformKind::kAction) take_word("action");
  std::vector<std::string> types;
  if (!types_of(types)) return;
  entry.source = range(begin, i_);
  if (take("=")) {
    parse_alias({entry.kind, std::move(types), {}, {}, {}, 0});
    return;
  }
  if (!parse_keys(entry) || !parse_event(entry)) return;
  if (!entry.plan && (!parse_formula(entry) || !parse_tail(entry))) return;
  if (!repeat_mapping(entry) || !check_variables(entry)) return;
  for (auto& type : types) {
    entry.type = std::move(type);
    add(entry);
  }
}

}  // namespace parallax::compiler
