// What a form compiler says of forms that are wrong or not in the subset.
#include <fmt/core.h>

#include <algorithm>

#include "compiler/base/diagnostic_codes.h"
#include "compiler/base/suggest.h"
#include "compiler/plan/form_compiler.h"
#include "compiler/plan/plan_builtins.h"

namespace parallax::compiler {

using base::DiagnosticCode;

namespace {

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

std::string FormCompiler::form_name(DatumId form) const {
  if (const auto head = data.head(form)) return std::string(*head);
  if (!data.is_list(form)) return print_datum(data, form);
  return "(...)";
}

void FormCompiler::malformed(DatumId form, std::string_view text) {
  error(DiagnosticCode::kMalformedForm, form, form_name(form), text);
}

void FormCompiler::refuse(DatumId form, std::string_view text) {
  malformed(form, text);
  nil(form);
}

void FormCompiler::unsupported(DatumId form, std::string_view text) {
  error(DiagnosticCode::kUnsupportedPlanForm, form, form_name(form), text);
}

void FormCompiler::unknown_form(DatumId form, std::string_view name) {
  if (const auto* hint = find_hint(kReactive, name)) {
    error(DiagnosticCode::kReactiveForm, form, name)
        .note(fmt::format("the nearest form of the subset is `{}`", hint->text));
    return;
  }
  if (const auto* hint = find_hint(kRejected, name)) {
    error(DiagnosticCode::kUnsupportedPlanForm, form, name, hint->text);
    return;
  }
  auto report = error(DiagnosticCode::kUnknownPlanForm, form, name);
  // Looking for the nearest name is the expensive part; nobody reads the thousandth suggestion.
  if (sink_.error_count() > kMaxSuggestions) return;
  std::vector<std::string> names;
  for (const auto& [known, function] : defined.functions) names.push_back(known);
  for (const auto& [known, function] : plan_forms()) names.emplace_back(known);
  for (const auto& builtin : plan_builtins()) {
    if (builtin.name.front() != '%') names.emplace_back(builtin.name);
  }
  // Half the word may be wrong: naming the nearest form helps more than naming none.
  const auto near = base::nearest_name(name, names, std::max<std::size_t>(2, name.size() / 2));
  if (near) report.note(fmt::format("the nearest form of the subset is `{}`", *near));
}

void FormCompiler::check_no_perform(DatumId form) {
  std::vector<DatumId> open = {form};
  while (!open.empty()) {
    const auto datum = open.back();
    open.pop_back();
    const auto items = data.children(datum);
    if (data.head(datum) == "perform") {
      error(DiagnosticCode::kUnsupportedPlanForm, datum, "perform",
            fmt::format("the arguments of `{}` are not evaluated", form_name(form)));
      return;
    }
    open.insert(open.end(), items.begin(), items.end());
  }
}

}  // namespace parallax::compiler
