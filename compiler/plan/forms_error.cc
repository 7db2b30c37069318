#include <fmt/core.h>

#include <array>
#include <utility>

#include "compiler/base/diagnostic_codes.h"
#include "compiler/base/suggest.h"
#include "compiler/plan/plan_builtins.h"
#include "compiler/plan/plan_compiler.h"

namespace parallax::compiler {
namespace {

using base::DiagnosticCode;

constexpr std::size_t kMaxSuggestions = 50;

struct Hint {
  std::string_view form;
  std::string_view text;
};

/// Reactive forms and what to use instead.
constexpr Hint kReactive[] = {
    {"pursue", "par"},
    {"try-all", "try-in-order"},
    {"par-loop", "dolist"},
    {"partial-order", "seq"},
    {"whenever", "loop"},
    {"wait-for", "holds"},
    {"with-policy", "progn"},
    {"with-policies", "progn"},
    {"with-task-suspended", "progn"},
    {"with-task", "progn"},
    {"make-fluent", "holds"},
    {"fl-funcall", "holds"},
    {"fl-and", "and"},
    {"fl-or", "or"},
    {"fl-not", "not"},
    {"fl-eq", "eq"},
    {"pulsed", "holds"},
};

constexpr Hint kRejected[] = {
    {"defmacro", "macros are not expanded; write a function"},
    {"macrolet", "macros are not expanded; write a function"},
    {"defstruct", "there are no structures"},
    {"defclass", "there are no classes"},
    {"defmethod", "there are no generic functions; write a function"},
    {"defgeneric", "there are no generic functions; write a function"},
    {"lambda", "a lambda is only an argument of funcall, apply, mapcar, mapc, every and some"},
    {"function",
     "a function value is only an argument of funcall, apply, mapcar, mapc, every and some"},
    {"handler-case", "use `with-failure-handling`"},
    {"handler-bind", "use `with-failure-handling`"},
    {"ignore-errors", "use `with-failure-handling`"},
    {"error", "use `fail`"},
    {"tagbody", "use a loop"},
    {"go", "use a loop"},
    {"do", "use `loop` or `dotimes`"},
    {"do*", "use `loop` or `dotimes`"},
    {"catch", "use `block`"},
    {"throw", "use `return-from`"},
    {"unquote", "a comma needs a backquote around it"},
    {"unquote-splicing", "a comma needs a backquote around it"},
    {"defun", "functions are defined at top level"},
    {"def-cram-function", "functions are defined at top level"},
    {"def-top-level-cram-function", "functions are defined at top level"},
    {"defparameter", "global constants are defined at top level"},
    {"defvar", "global constants are defined at top level"},
    {"defconstant", "global constants are defined at top level"},
    {"define-condition", "failure classes are defined at top level"},
};

template <std::size_t kSize>
const Hint* find_hint(const Hint (&table)[kSize], std::string_view form) {
  for (const auto& hint : table) {
    if (hint.form == form) return &hint;
  }
  return nullptr;
}

}  // namespace

std::string PlanCompiler::form_name(DatumId form) const {
  if (const auto head = data_.head(form)) return std::string(*head);
  if (!data_.is_list(form)) return print_datum(data_, form);
  return "(...)";
}

void PlanCompiler::malformed(DatumId form, std::string_view text) {
  failed_ = true;
  sink_.error(DiagnosticCode::kMalformedForm, data_.source(form), form_name(form), text);
}

void PlanCompiler::unsupported(DatumId form, std::string_view text) {
  failed_ = true;
  sink_.error(DiagnosticCode::kUnsupportedPlanForm, data_.source(form), form_name(form), text);
}

void PlanCompiler::unknown_form(DatumId form, std::string_view name) {
  failed_ = true;
  if (const auto* hint = find_hint(kReactive, name)) {
    sink_.error(DiagnosticCode::kReactiveForm, data_.source(form), name)
        .note(fmt::format("the nearest form of the subset is `{}`", hint->text));
    return;
  }
  if (const auto* hint = find_hint(kRejected, name)) {
    sink_.error(DiagnosticCode::kUnsupportedPlanForm, data_.source(form), name, hint->text);
    return;
  }
  auto error = sink_.error(DiagnosticCode::kUnknownPlanForm, data_.source(form), name);
  // Looking for the nearest name is the expensive part; nobody reads the thousandth suggestion.
  if (sink_.error_count() > kMaxSuggestions) return;
  std::vector<std::string> names;
  for (const auto& [known, function] : functions_) names.push_back(known);
  for (const auto& [known, function] : forms()) names.emplace_back(known);
  for (const auto& builtin : plan_builtins()) {
    if (builtin.name.front() != '%') names.emplace_back(builtin.name);
  }
  // Half the word may be wrong: naming the nearest form helps more than naming none.
  const auto near = base::nearest_name(name, names, std::max<std::size_t>(2, name.size() / 2));
  if (near) error.note(fmt::format("the nearest form of the subset is `{}`", *near));
}

/// What is not evaluated must not perform either: the plan would silently lose an action.
bool PlanCompiler::check_no_perform(DatumId form) {
  std::vector<DatumId> open = {form};
  while (!open.empty()) {
    const auto datum = open.back();
    open.pop_back();
    const auto items = data_.children(datum);
    if (data_.head(datum) == "perform") {
      failed_ = true;
      sink_.error(DiagnosticCode::kUnsupportedPlanForm, data_.source(datum), "perform",
                  fmt::format("the arguments of `{}` are not evaluated", form_name(form)));
      return false;
    }
    open.insert(open.end(), items.begin(), items.end());
  }
  return true;
}

}  // namespace parallax::compiler
