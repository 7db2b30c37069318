#include "compiler/plan/plan_binding.h"

#include <fmt/core.h>

#include <algorithm>
#include <set>
#include <utility>

#include "compiler/base/diagnostic_codes.h"
#include "compiler/plan/binding_template.h"
#include "compiler/plan/binding_text.h"

namespace parallax::compiler {
namespace {

using base::DiagnosticCode;
using base::SourceRange;

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

/// Characters of types, keys and failure classes.
bool is_name(char c) {
  return !is_blank(c) && std::string_view("()|=,;:@/").find(c) == std::string_view::npos;
}

struct Alias {
  PerformKind kind = PerformKind::kMotion;
  std::vector<std::string> types;
  std::optional<PerformKind> target_kind;
  std::string target;
  SourceRange source;
  std::size_t position = 0;  // number of entries before it
};

class BindingParser {
 public:
  BindingParser(const base::SourceFiles& files, base::FileId file, base::DiagnosticSink& sink)
      : file_(file),
        sink_(sink),
        cleaned_(clean_binding(files[file].text())),
        text_(cleaned_.text) {}

  base::Result<PlanBinding> parse();

 private:
  SourceRange range(std::size_t begin, std::size_t end) const {
    return {file_, static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end)};
  }
  void skip_blanks() {
    while (i_ < end_ && is_blank(text_[i_])) ++i_;
  }
  std::string_view peek_name() const {
    auto stop = i_;
    while (stop < end_ && is_name(text_[stop]) &&
           !std::string_view(text_).substr(stop, end_ - stop).starts_with("->")) {
      ++stop;
    }
    return std::string_view(text_).substr(i_, stop - i_);
  }
  bool take(std::string_view literal) {
    skip_blanks();
    if (!std::string_view(text_).substr(i_, end_ - i_).starts_with(literal)) return false;
    i_ += literal.size();
    return true;
  }
  bool take_word(std::string_view word) {
    skip_blanks();
    if (peek_name() != word) return false;
    i_ += word.size();
    return true;
  }
  bool expected(std::string_view what);
  bool name(std::string_view what, std::string& out);
  void parse_entry();
  bool types_of(std::vector<std::string>& types);
  bool parse_alias(Alias alias);
  bool parse_keys(BindingEntry& entry);
  bool parse_key(BindingEntry& entry);
  bool parse_event(BindingEntry& entry);
  bool parse_arguments(BindingEntry& entry);
  bool parse_formula(BindingEntry& entry);
  bool parse_tail(BindingEntry& entry);
  bool repeat_mapping(BindingEntry& entry);
  bool check_variables(const BindingEntry& entry);
  bool add(const BindingEntry& entry);
  void expand_aliases();

  base::FileId file_;
  base::DiagnosticSink& sink_;
  BindingText cleaned_;
  const std::string& text_;
  std::size_t i_ = 0;
  std::size_t end_ = 0;  // of the entry
  PlanBinding out_;
  std::vector<Alias> aliases_;
  bool failed_ = false;
};

bool BindingParser::expected(std::string_view what) {
  skip_blanks();
  failed_ = true;
  auto stop = i_;
  while (stop < end_ && !is_blank(text_[stop]) && stop - i_ < 40) ++stop;
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
  if (!take("(")) return true;
  int depth = 0;
  auto begin = i_;
  for (; i_ < end_; ++i_) {
    const char c = text_[i_];
    const bool ends = depth == 0 && (c == ',' || c == ')');
    if (ends) {
      std::string argument = text_.substr(begin, i_ - begin);
      auto pieces = parse_template(argument, range(begin, i_), sink_);
      if (!pieces) return failed_ = true, false;
      for (auto& piece : *pieces) std::erase_if(piece.text, is_blank);
      std::erase_if(*pieces, [](const TemplatePiece& piece) {
        return piece.kind == TemplatePiece::Kind::kText && piece.text.empty();
      });
      if (pieces->empty() && c == ')' && entry.event_arguments.empty()) return ++i_, true;  // E()
      if (pieces->empty()) return expected("an argument of the event");
      entry.event_arguments.push_back(std::move(*pieces));
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
  return name("the event", entry.event_symbol) && parse_arguments(entry);
}

bool BindingParser::parse_formula(BindingEntry& entry) {
  if (!take("ok:")) return expected("`ok:` and the formula of success");
  skip_blanks();
  const auto begin = i_;
  while (i_ < end_ && text_[i_] != '@') ++i_;
  auto stop = i_;
  while (stop > begin && is_blank(text_[stop - 1])) --stop;
  if (i_ == end_) return expected("`@t` or `@t+1` behind the formula");
  if (stop == begin) return expected("a formula before `@`");
  entry.formula_source = range(begin, stop);
  auto formula = parse_template(text_.substr(begin, stop - begin), entry.formula_source, sink_);
  if (!formula) return failed_ = true, false;
  entry.formula = std::move(*formula);
  if (take("@t+1")) {
    entry.time_offset = 1;
  } else if (!take("@t")) {
    return expected("`@t` or `@t+1`");
  }
  if (i_ < end_ && !is_blank(text_[i_])) return expected("`@t` or `@t+1`");
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

/// Gives a bare `place` in the formula the variable of the event's only `place(...)`.
bool BindingParser::repeat_mapping(BindingEntry& entry) {
  const auto bare = [](const TemplatePiece& piece) {
    return piece.kind == TemplatePiece::Kind::kMapped && piece.variable.empty();
  };
  for (const auto& argument : entry.event_arguments) {
    for (const auto& piece : argument) {
      if (!bare(piece)) continue;
      failed_ = true;
      sink_.error(DiagnosticCode::kBindingSyntax, entry.source,
                  fmt::format("`{}(?variable)` in the event", piece.function), "the bare name");
      return false;
    }
  }
  for (auto& piece : entry.formula) {
    if (!bare(piece)) continue;
    std::set<std::string> variables;
    for (const auto& argument : entry.event_arguments) {
      for (const auto& other : argument) {
        if (other.function == piece.function) variables.insert(other.variable);
      }
    }
    if (variables.size() == 1) {
      piece.variable = *variables.begin();
    } else {  // a constant of the model that happens to have this name
      piece = {TemplatePiece::Kind::kText, piece.function, {}, {}};
    }
  }
  return true;
}

bool BindingParser::check_variables(const BindingEntry& entry) {
  bool good = true;
  const auto check = [&](const Template& pieces, SourceRange where) {
    for (const auto& piece : pieces) {
      const auto known = [&](const BindingKey& key) { return key.variable == piece.variable; };
      if (piece.kind == TemplatePiece::Kind::kText ||
          std::any_of(entry.keys.begin(), entry.keys.end(), known)) {
        continue;
      }
      good = false;
      failed_ = true;
      sink_.error(DiagnosticCode::kBindingVariable, where, piece.variable);
    }
  };
  for (const auto& argument : entry.event_arguments) check(argument, entry.source);
  check(entry.formula, entry.formula_source);
  return good;
}

bool same_keys(const BindingEntry& a, const BindingEntry& b) {
  std::set<std::string> left;
  std::set<std::string> right;
  for (const auto& key : a.keys) left.insert(key.key);
  for (const auto& key : b.keys) right.insert(key.key);
  return left == right;
}

bool BindingParser::add(const BindingEntry& entry) {
  for (const auto& other : out_.entries) {
    if (other.kind != entry.kind || other.type != entry.type || !same_keys(other, entry)) continue;
    failed_ = true;
    sink_.error(DiagnosticCode::kDuplicateBinding, entry.source, to_string(entry.kind), entry.type)
        .note(other.source, "first bound here");
    return false;
  }
  out_.entries.push_back(entry);
  return true;
}

void BindingParser::parse_entry() {
  BindingEntry entry;
  const auto begin = i_;
  entry.kind = take_word("motion") ? PerformKind::kMotion : PerformKind::kAction;
  if (entry.kind == PerformKind::kAction) take_word("action");
  std::vector<std::string> types;
  if (!types_of(types)) return;
  entry.source = range(begin, i_);
  if (take("=")) {
    parse_alias({entry.kind, std::move(types), {}, {}, {}, 0});
    return;
  }
  if (!parse_keys(entry) || !parse_event(entry) || !parse_formula(entry) || !parse_tail(entry) ||
      !repeat_mapping(entry) || !check_variables(entry)) {
    return;
  }
  for (auto& type : types) {
    entry.type = std::move(type);
    add(entry);
  }
}

/// An alias takes over every entry of its target; an alias may name an earlier alias.
void BindingParser::expand_aliases() {
  for (const auto& alias : aliases_) {
    const auto matches = [&](const BindingEntry& entry, PerformKind kind) {
      return entry.type == alias.target && entry.kind == kind;
    };
    std::vector<BindingEntry> found;
    const auto collect = [&](PerformKind kind) {
      for (const auto& entry : out_.entries) {
        if (matches(entry, kind)) found.push_back(entry);
      }
    };
    const auto other =
        alias.kind == PerformKind::kMotion ? PerformKind::kAction : PerformKind::kMotion;
    collect(alias.target_kind.value_or(alias.kind));
    if (found.empty() && !alias.target_kind) collect(other);
    if (found.empty()) {
      failed_ = true;
      sink_.error(DiagnosticCode::kBindingAlias, alias.source, alias.target);
    }
    for (auto& entry : found) {
      for (const auto& type : alias.types) {
        entry.kind = alias.kind;
        entry.type = type;
        entry.source = alias.source;
        add(entry);
      }
    }
  }
}

base::Result<PlanBinding> BindingParser::parse() {
  end_ = cleaned_.entries.empty() ? text_.size() : cleaned_.entries.front();
  skip_blanks();
  if (i_ != end_) expected("an entry that starts with `motion` or `action`");
  for (std::size_t n = 0; n < cleaned_.entries.size(); ++n) {
    i_ = cleaned_.entries[n];
    end_ = n + 1 < cleaned_.entries.size() ? cleaned_.entries[n + 1] : text_.size();
    parse_entry();
  }
  expand_aliases();
  if (failed_) return sink_.already_reported();
  return std::move(out_);
}

}  // namespace

std::string_view to_string(PerformKind kind) {
  return kind == PerformKind::kMotion ? "motion" : "action";
}

std::string normalise_key(std::string_view key) {
  if (key == "target" || key == "pose" || key == "location" || key == "goal") return "target";
  if (key == "object" || key == "for") return "object";
  if (key == "arm" || key == "gripper" || key.starts_with("left-") || key.starts_with("right-")) {
    return "arm";
  }
  return std::string(key);
}

std::vector<std::string> PlanBinding::types(PerformKind kind) const {
  std::vector<std::string> out;
  for (const auto& entry : entries) {
    if (entry.kind != kind) continue;
    if (std::find(out.begin(), out.end(), entry.type) == out.end()) out.push_back(entry.type);
  }
  return out;
}

base::Result<PlanBinding> parse_plan_binding(const base::SourceFiles& files, base::FileId file,
                                             base::DiagnosticSink& sink) {
  return BindingParser(files, file, sink).parse();
}

}  // namespace parallax::compiler
