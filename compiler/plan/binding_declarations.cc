// Entries of a binding table that are no performs of an event: questions, objects, plans.
#include <utility>

#include "compiler/base/diagnostic_codes.h"
#include "compiler/plan/binding_parser.h"

namespace parallax::compiler {

bool BindingParser::variable(std::string& out) {
  skip_blanks();
  const auto rest = std::string_view(text_).substr(i_, end_ - i_);
  const auto length = variable_length(rest);
  if (length == 0) return expected("a variable such as `?o`");
  out = rest.substr(0, length);
  i_ += length;
  return true;
}

/// (?a ?b), with or without commas.
bool BindingParser::variables(std::vector<std::string>& out) {
  if (!take("(")) return true;
  while (!take(")")) {
    std::string one;
    if (!variable(one)) return false;
    out.push_back(std::move(one));
    take(",");
  }
  return true;
}

bool BindingParser::at_end() {
  skip_blanks();
  return i_ == end_ || expected("the next entry");
}

bool BindingParser::parse_formula_now(BindingEntry& entry) {
  if (!parse_formula(entry)) return false;
  return entry.time_offset == 0 || expected("a formula `@t`, not `@t+1`, before");
}

/// `-> plan f(?a,?b)`: the perform runs a function of the plan.
bool BindingParser::parse_plan_call(BindingEntry& entry) {
  std::string function;
  if (!name("the function of the plan", function) || !variables(entry.plan_arguments)) return false;
  entry.plan = std::move(function);
  return at_end();
}

/// `query NAME (?a ?b) ok: FORMULA @t`
void BindingParser::parse_query(std::size_t begin) {
  QueryBinding query;
  if (!name("the name of a query", query.name)) return;
  query.source = range(begin, i_);
  BindingEntry entry;
  entry.source = query.source;
  if (!variables(query.variables)) return;
  for (const auto& one : query.variables) entry.keys.push_back({{}, {}, one});
  if (!parse_formula_now(entry) || !at_end() || !repeat_mapping(entry) || !check_variables(entry)) {
    return;
  }
  for (const auto& other : out_.queries) {
    const bool same = other.name == query.name && other.variables.size() == query.variables.size();
    if (!same) continue;
    failed_ = true;
    sink_.error(base::DiagnosticCode::kDuplicateBinding, query.source, "query", query.name)
        .note(other.source, "first bound here");
    return;
  }
  query.formula = std::move(entry.formula);
  query.formula_source = entry.formula_source;
  out_.queries.push_back(std::move(query));
}

/// `object (:type ?y) ok: FORMULA @t returns ?o else CLASS`
void BindingParser::parse_object(std::size_t begin) {
  ObjectBinding object;
  object.source = range(begin, i_);
  BindingEntry entry;
  entry.source = object.source;
  entry.failure_class = object.failure_class;
  if (!parse_keys(entry) || !parse_formula_now(entry)) return;
  object.keys = entry.keys;
  if (!take_word("returns")) {
    expected("`returns` and the variable that stands for the object");
    return;
  }
  if (!variable(object.variable) || !parse_tail(entry)) return;
  if (entry.returns) {
    expected("one variable that is returned, not two,");
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

}  // namespace parallax::compiler
