#include "compiler/plan/plan_binding.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/base/ascii.h"
#include "compiler/base/codes/plans.h"
#include "compiler/plan/binding_text.h"

namespace parallax::compiler {

using base::SourceRange;

namespace {

/// Reads the entries one by one and recovers at the next one.
class BindingParser {
 public:
  BindingParser(const base::SourceFiles& files, base::FileId file, base::DiagnosticSink& sink)
      : sink_(sink), at_(files[file].text(), file, sink) {}

  base::Result<PlanBinding> parse();

 private:
  struct Alias {
    PerformKind kind = PerformKind::kMotion;
    std::vector<std::string> types;
    std::optional<PerformKind> target_kind;
    std::string target;
    SourceRange source;
  };
  void parse_failures();
  void parse_entry();
  bool is_new(std::span<const QueryBinding> known, const QueryBinding& one, std::string_view kind);
  void parse_query(std::size_t begin);
  void parse_goal(std::size_t begin);
  void parse_object(std::size_t begin);
  bool parse_alias(Alias alias);
  bool parse_keys(BindingEntry& entry);
  bool parse_key(BindingEntry& entry);
  bool parse_event(BindingEntry& entry);
  bool parse_plan_call(BindingEntry& entry);
  bool parse_arguments(BindingEntry& entry);
  bool parse_formula(BindingEntry& entry);
  bool parse_formula_now(BindingEntry& entry);
  bool parse_tail(BindingEntry& entry);
  bool parse_reason(BindingEntry& entry);
  bool nothing_left();
  bool repeat_mapping(BindingEntry& entry);
  bool check_variables(const BindingEntry& entry);
  bool add(const BindingEntry& entry);
  void expand_aliases();

  base::DiagnosticSink& sink_;
  BindingCursor at_;
  PlanBinding out_;
  std::vector<Alias> aliases_;
  bool failed_ = false;
};

bool same_keys(const BindingEntry& a, const BindingEntry& b) {
  std::set<std::string> left;
  std::set<std::string> right;
  for (const auto& key : a.keys) left.insert(key.key);
  for (const auto& key : b.keys) right.insert(key.key);
  return left == right;
}

bool BindingParser::nothing_left() {
  at_.skip_blanks();
  return at_.at_end() || at_.expected("the next entry");
}

bool BindingParser::parse_formula_now(BindingEntry& entry) {
  if (!parse_formula(entry)) return false;
  return entry.time_offset == 0 || at_.expected("a formula `@t`, not `@t+1`, before");
}

/// `-> plan f(?a,?b)`: the perform runs a function of the plan.
bool BindingParser::parse_plan_call(BindingEntry& entry) {
  std::string package;
  std::string function;
  if (!at_.symbol("the function of the plan", package, function) ||
      !at_.variables(entry.plan_arguments)) {
    return false;
  }
  entry.plan = package.empty() ? std::move(function) : fmt::format("{}::{}", package, function);
  return nothing_left();
}

/// False: a query or a goal of that name was bound before, and that is reported.
bool BindingParser::is_new(std::span<const QueryBinding> known, const QueryBinding& one,
                           std::string_view kind) {
  for (const auto& other : known) {
    if (other.name != one.name || other.variables.size() != one.variables.size()) continue;
    failed_ = true;
    sink_.error(codes::kDuplicateBinding, one.source, kind, one.name)
        .note(other.source, "first bound here");
    return false;
  }
  return true;
}

/// `query NAME (?a ?b) ok: FORMULA @t`
void BindingParser::parse_query(std::size_t begin) {
  QueryBinding query;
  if (!at_.name("the name of a query", query.name)) return;
  query.source = at_.range(begin, at_.position());
  BindingEntry entry;
  entry.source = query.source;
  if (!at_.variables(query.variables)) return;
  for (const auto& one : query.variables) entry.keys.push_back({{}, {}, one});
  if (!parse_formula_now(entry) || !nothing_left() || !repeat_mapping(entry) ||
      !check_variables(entry)) {
    return;
  }
  if (!is_new(out_.queries, query, "query")) return;
  query.formula = std::move(entry.formula);
  query.formula_source = entry.formula_source;
  out_.queries.push_back(std::move(query));
}

/// `goal (NAME ?a ?b) -> FORMULA`
void BindingParser::parse_goal(std::size_t begin) {
  GoalBinding goal;
  if (!at_.take("(")) {
    at_.expected("a goal such as `(object-in-hand ?o)`");
    return;
  }
  std::string package;  // goals are compared without it
  if (!at_.symbol("the name of a goal", package, goal.name)) return;
  BindingEntry entry;
  while (!at_.take(")")) {
    std::string one;
    if (!at_.variable(one)) return;
    goal.variables.push_back(one);
    entry.keys.push_back({{}, {}, std::move(one)});
  }
  goal.source = entry.source = at_.range(begin, at_.position());
  if (!at_.take("->")) {
    at_.expected("`->` and the formula of the goal");
    return;
  }
  at_.skip_blanks();
  auto end = at_.position() + at_.rest().size();
  while (end > at_.position() && base::is_space(at_.text()[end - 1])) --end;
  if (end == at_.position()) {
    at_.expected("a formula");
    return;
  }
  goal.formula_source = entry.formula_source = at_.range(at_.position(), end);
  auto formula = read_formula_tree(goal.formula_source, at_.text(), sink_);
  if (!formula) {
    failed_ = true;
    return;
  }
  entry.formula = std::move(*formula);
  if (!repeat_mapping(entry) || !check_variables(entry)) return;
  if (!is_new(out_.goals, goal, "goal")) return;
  goal.formula = std::move(entry.formula);
  out_.goals.push_back(std::move(goal));
}

/// `object (:type ?y) ok: FORMULA @t returns ?o else CLASS`
void BindingParser::parse_object(std::size_t begin) {
  ObjectBinding object;
  object.source = at_.range(begin, at_.position());
  BindingEntry entry;
  entry.source = object.source;
  entry.failure_class = object.failure_class;
  if (!parse_keys(entry) || !parse_formula_now(entry)) return;
  object.keys = entry.keys;
  if (!at_.take_word("returns")) {
    at_.expected("`returns` and the variable that stands for the object");
    return;
  }
  if (!at_.variable(object.variable) || !parse_tail(entry)) return;
  if (entry.returns || !entry.reasons.empty()) {
    at_.expected(entry.returns ? "one variable that is returned, not two,"
                               : "no `on`, as nothing is performed yet,");
    return;
  }
  entry.keys.push_back({{}, {}, object.variable});
  if (!repeat_mapping(entry) || !check_variables(entry)) return;
  object.formula = std::move(entry.formula);
  object.formula_source = entry.formula_source;
  object.failure_class = std::move(entry.failure_class);
  object.failure_source = entry.failure_source;
  out_.objects.push_back(std::move(object));
}

bool BindingParser::parse_alias(Alias alias) {
  if (at_.take_word("motion")) alias.target_kind = PerformKind::kMotion;
  if (!alias.target_kind && at_.take_word("action")) alias.target_kind = PerformKind::kAction;
  const auto begin = (at_.skip_blanks(), at_.position());
  std::string package;
  if (!at_.symbol("the name of a type", package, alias.target)) return false;
  alias.source = at_.range(begin, at_.position());
  at_.skip_blanks();
  if (!at_.at_end()) return at_.expected("nothing behind an alias");
  aliases_.push_back(std::move(alias));
  return true;
}

bool BindingParser::parse_key(BindingEntry& entry) {
  BindingKey key;
  if (!at_.take(":")) return at_.expected("a key such as `:target`");
  std::string word;
  if (!at_.name("the name of a key", word)) return false;
  key.key = normalise_key(word);
  at_.skip_blanks();
  if (const auto property = at_.peek_name(); !property.empty() && property.front() != '?') {
    key.property = property;
    at_.advance(property.size());
    at_.skip_blanks();
  }
  const auto length = variable_length(at_.rest());
  if (length != 0) {
    key.variable = at_.rest().substr(0, length);
    at_.advance(length);
  } else {
    key.variable = key.key == "target" ? "?p" : fmt::format("?{}", key.key.substr(0, 1));
  }
  entry.keys.push_back(std::move(key));
  return true;
}

bool BindingParser::parse_keys(BindingEntry& entry) {
  if (!at_.take("(")) return true;  // a type without arguments
  while (!at_.take(")")) {
    at_.skip_blanks();
    if (at_.at_end()) return at_.expected("`)`");
    if (!parse_key(entry)) return false;
  }
  return true;
}

bool BindingParser::parse_arguments(BindingEntry& entry) {
  constexpr std::size_t kMaxArguments = 100;
  if (!at_.take("(")) return true;
  int depth = 0;
  auto begin = at_.position();
  for (; !at_.at_end(); at_.advance()) {
    const char c = at_.peek();
    const bool ends = depth == 0 && (c == ',' || c == ')');
    if (ends) {
      const auto argument_text = std::string_view(at_.text()).substr(begin, at_.position() - begin);
      const bool empty = std::all_of(argument_text.begin(), argument_text.end(), base::is_space);
      if (empty && c == ')' && entry.event_arguments.empty()) return at_.take(")");  // E()
      if (empty) return at_.expected("an argument of the event");
      if (entry.event_arguments.size() == kMaxArguments) {
        return at_.expected(fmt::format("at most {} arguments", kMaxArguments));
      }
      const auto argument = read_formula_tree(at_.range(begin, at_.position()), at_.text(), sink_);
      if (!argument) return failed_ = true, false;
      entry.event_arguments.push_back(without_blanks(*argument));
      if (c == ')') return at_.take(")");
      begin = at_.position() + 1;
    }
    if (c == '(') ++depth;
    if (c == ')') --depth;
  }
  return at_.expected("`)`");
}

bool BindingParser::parse_event(BindingEntry& entry) {
  if (!at_.take("->")) return at_.expected(entry.keys.empty() ? "`(`, `->` or `=`" : "`->`");
  if (at_.take_word("plan")) return parse_plan_call(entry);
  return at_.name("the event", entry.event_symbol) && parse_arguments(entry);
}

bool BindingParser::parse_formula(BindingEntry& entry) {
  if (!at_.take("ok:")) return at_.expected("`ok:` and the formula of success");
  at_.skip_blanks();
  const auto begin = at_.position();
  if (at_.take_word("always")) {
    entry.always = true;
    entry.formula_source = at_.range(begin, at_.position());
    entry.formula = equal_terms(constant_term("0"), constant_term("0"));
    return true;
  }
  while (!at_.at_end() && at_.peek() != '@') at_.advance();
  auto stop = at_.position();
  while (stop > begin && base::is_space(at_.text()[stop - 1])) --stop;
  if (at_.at_end()) return at_.expected("`@t` or `@t+1` behind the formula");
  if (stop == begin) return at_.expected("a formula before `@`");
  entry.formula_source = at_.range(begin, stop);
  auto formula = read_formula_tree(entry.formula_source, at_.text(), sink_);
  if (!formula) return failed_ = true, false;
  entry.formula = std::move(*formula);
  if (at_.take("@t+1")) {
    entry.time_offset = 1;
  } else if (!at_.take("@t")) {
    return at_.expected("`@t` or `@t+1`");
  }
  if (!at_.at_end() && !base::is_space(at_.peek())) return at_.expected("`@t` or `@t+1`");
  return true;
}

bool BindingParser::parse_tail(BindingEntry& entry) {
  for (;;) {
    at_.skip_blanks();
    if (at_.at_end()) return true;
    if (!entry.always && at_.take_word("returns")) {
      std::string variable;
      if (!at_.name("the variable that is returned", variable)) return false;
      entry.returns = std::move(variable);
    } else if (entry.always) {
      return at_.expected("the next entry, as what always succeeds finds nothing and never fails,");
    } else if (at_.take_word("else")) {
      const auto begin = (at_.skip_blanks(), at_.position());
      if (!at_.name("a failure class", entry.failure_class)) return false;
      entry.failure_source = at_.range(begin, at_.position());
    } else if (at_.take_word("on")) {
      if (!parse_reason(entry)) return false;
    } else {
      return at_.expected("`returns`, `else`, `on` or the next entry");
    }
  }
}

/// `REASON CLASS`, behind `on`
bool BindingParser::parse_reason(BindingEntry& entry) {
  FailureReason bound;
  const auto begin = (at_.skip_blanks(), at_.position());
  if (!at_.name("a reason of the simulator", bound.reason)) return false;
  const auto end = at_.position();
  for (const auto& other : entry.reasons) {
    if (other.reason != bound.reason) continue;
    failed_ = true;
    sink_.error(codes::kBindingSyntax, at_.range(begin, end), "a reason once",
                fmt::format("`{}` a second time", bound.reason));
    return false;
  }
  const auto name = (at_.skip_blanks(), at_.position());
  if (!at_.name("a failure class", bound.failure_class)) return false;
  bound.source = at_.range(name, at_.position());
  entry.reasons.push_back(std::move(bound));
  return true;
}

void BindingParser::parse_entry() {
  BindingEntry entry;
  const auto begin = at_.position();
  if (at_.take_word("query")) return parse_query(begin);
  if (at_.take_word("object")) return parse_object(begin);
  if (at_.take_word("goal")) return parse_goal(begin);
  entry.kind = at_.take_word("motion") ? PerformKind::kMotion : PerformKind::kAction;
  if (entry.kind == PerformKind::kAction) at_.take_word("action");
  std::vector<std::string> types;
  if (!at_.types(types)) return;
  entry.source = at_.range(begin, at_.position());
  if (at_.take("=")) {
    parse_alias({entry.kind, std::move(types), {}, {}, {}});
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

/// Gives a bare `place` in the formula the variable of the event's only `place(...)`.
bool BindingParser::repeat_mapping(BindingEntry& entry) {
  std::map<std::string, std::set<std::string>> mapped;  // variables, by function
  for (const auto& argument : entry.event_arguments) {
    for (const auto& parameter : argument.parameters) {
      mapped[parameter.function].insert(parameter.variable);
      if (!parameter.variable.empty()) continue;
      failed_ = true;
      sink_.error(codes::kBindingSyntax, entry.source,
                  fmt::format("`{}(?variable)` in the event", parameter.function), "the bare name");
      return false;
    }
  }
  for (auto& node : entry.formula.nodes) {
    if (node.leaf != LeafKind::kParameter) continue;
    auto& parameter = entry.formula.parameters[node.number];
    if (!parameter.variable.empty()) continue;
    const auto& variables = mapped[parameter.function];
    if (variables.size() == 1) {
      parameter.variable = *variables.begin();
    } else {  // a constant of the model that happens to have this name
      node.leaf = LeafKind::kName;
    }
  }
  return true;
}

bool BindingParser::check_variables(const BindingEntry& entry) {
  bool good = true;
  const auto check = [&](const std::string& variable, SourceRange where) {
    const auto known = [&](const BindingKey& key) { return key.variable == variable; };
    if (std::any_of(entry.keys.begin(), entry.keys.end(), known)) return;
    good = false;
    failed_ = true;
    sink_.error(codes::kBindingVariable, where, variable);
  };
  for (const auto& argument : entry.event_arguments) {
    for (const auto& parameter : argument.parameters) check(parameter.variable, entry.source);
  }
  for (const auto& parameter : entry.formula.parameters) {
    if (!parameter.variable.empty()) check(parameter.variable, entry.formula_source);
  }
  for (const auto& variable : entry.plan_arguments) check(variable, entry.source);
  return good;
}

bool BindingParser::add(const BindingEntry& entry) {
  for (const auto& other : out_.entries) {
    if (other.kind != entry.kind || other.type != entry.type || !same_keys(other, entry)) continue;
    failed_ = true;
    sink_.error(codes::kDuplicateBinding, entry.source, to_string(entry.kind), entry.type)
        .note(other.source, "first bound here");
    return false;
  }
  out_.entries.push_back(entry);
  return true;
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
      sink_.error(codes::kBindingAlias, alias.source, alias.target);
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

void BindingParser::parse_failures() {
  if (!at_.take("failures:")) return;
  if (at_.take_word("2020")) {
    out_.failures = FailureTable::k2020;
  } else if (!at_.take_word("devel")) {
    at_.expected("`devel` or `2020`, the failure classes of CRAM,");
  }
  at_.skip_blanks();
}

base::Result<PlanBinding> BindingParser::parse() {
  at_.enter(BindingCursor::kPreamble);
  parse_failures();
  if (!at_.at_end()) {
    at_.expected("an entry that starts with `motion`, `action`, `query`, `goal` or `object`");
  }
  for (std::size_t entry = 0; entry < at_.entries(); ++entry) {
    at_.enter(entry);
    parse_entry();
  }
  expand_aliases();
  if (failed_ || at_.failed()) return sink_.already_reported();
  return std::move(out_);
}

}  // namespace

base::Result<PlanBinding> parse_plan_binding(const base::SourceFiles& files, base::FileId file,
                                             base::DiagnosticSink& sink) {
  return BindingParser(files, file, sink).parse();
}

}  // namespace parallax::compiler
