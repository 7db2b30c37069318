#include <string>

#include "compiler/interpreter/form_compiler.h"
#include "compiler/interpreter/function_calls.h"
#include "compiler/interpreter/variables.h"

namespace parallax::compiler {
namespace {

void form_values(FormCompiler& c, DatumId form, FormItems items) {
  for (const auto item : items.subspan(1)) c.compile(item);
  const auto count = static_cast<std::uint32_t>(items.size() - 1);
  if (count != 1) c.code.code().multiple_values = true;
  c.code.emit(PlanOp::kValues, count, 0, form);
  c.code.adjust(1 - static_cast<int>(count));
}

/// (values-list list)
void form_values_list(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() != 2) return c.refuse(form, "expected a list");
  c.code.code().multiple_values = true;
  c.compile(items[1]);
  c.code.emit(PlanOp::kExpectList, 0, 0, form);
  c.code.emit(PlanOp::kSpreadValues, 0, 0, form);
}

/// Missing values are nil, further ones are dropped.
void form_multiple_value_bind(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() < 3 || (!c.data.is_list(items[1]) && !c.data.is_nil(items[1]))) {
    return c.refuse(form, "expected variables and a form");
  }
  const auto names = c.data.children(items[1]);
  const auto count = static_cast<std::uint32_t>(names.size());
  const auto scope = c.code.scope().size();
  const auto height = c.code.height();
  c.compile(items[2]);
  c.code.emit(PlanOp::kUnpack, count, 0, form);
  c.code.adjust(static_cast<int>(count) - 1);
  for (std::uint32_t i = 0; i < count; ++i) {
    if (!c.data.is_symbol(names[i])) {
      c.malformed(form, "a variable is a name");
      continue;
    }
    bind_variable(c, names[i], height + i, form);
  }
  c.compile_declared(items.subspan(3));
  close_variables(c, scope, count, form);
}

void form_multiple_value_list(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() != 2) return c.refuse(form, "expected a form");
  c.compile(items[1]);
  c.code.emit(PlanOp::kListValues, 0, 0, form);
}

/// (nth-value n form)
void form_nth_value(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() != 3) return c.refuse(form, "expected a number and a form");
  c.compile(items[1]);
  c.compile(items[2]);
  c.code.emit(PlanOp::kListValues, 0, 0, form);
  c.code.builtin("nth", 2, form);
}

/// (multiple-value-setq (v...) form): set as by setf; the value is the first one.
void form_multiple_value_setq(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() != 3 || !c.data.is_list(items[1])) {
    return c.refuse(form, "expected variables and a form");
  }
  const auto names = c.data.children(items[1]);
  const auto count = static_cast<std::uint32_t>(names.size());
  if (count == 0) return c.compile(items[2]);
  c.compile(items[2]);
  c.code.emit(PlanOp::kUnpack, count, 0, form);
  c.code.adjust(static_cast<int>(count) - 1);
  for (auto i = count; i-- > 0;) {
    const auto* variable = assignable(c, form, names[i]);
    if (variable != nullptr) assign(c, *variable, form);
    if (i > 0) c.code.drop(form);
  }
}

/// prog1, prog2 and multiple-value-prog1: the value of an early form.
void form_prog1(FormCompiler& c, DatumId form, FormItems items) {
  const std::string name = c.form_name(form);
  const std::size_t kept = name == "prog2" ? 2 : 1;
  if (items.size() <= kept) return c.refuse(form, "expected forms");
  for (std::size_t i = 1; i < items.size(); ++i) {
    c.compile(items[i]);
    if (i == kept && name != "multiple-value-prog1") c.code.builtin("identity", 1, form);
    if (i != kept) c.code.drop(items[i]);
  }
}

}  // namespace

/// #'f and a written lambda as a value.
void compile_function_value(FormCompiler& c, DatumId form, DatumId function) {
  const auto parts = c.data.children(function);
  if (c.data.head(function) == "lambda" && parts.size() >= 2) {
    const auto made = declare_function(c, function, "a lambda", parts[1]);
    c.code.enter_function_value(made.unit);
    compile_function_body(c, made, "", parts.subspan(2));
    return c.code.function_value(made.unit, form);
  }
  if (!c.data.is_symbol(function)) return c.refuse(form, "expected a name or a lambda");
  const auto callee = find_callee(c, function);
  if (!callee && c.data.is_symbol(function, "retry")) {
    const auto unit = c.code.declare_unit("retry", form, 0);
    c.code.enter_function_value(unit);
    c.compile(c.data.add_list(std::span(&function, 1), c.data.source(form)));
    c.code.leave_unit(PlanOp::kReturn, form);
    return c.code.function_value(unit, form);
  }
  if (!callee) {
    if (plan_forms().contains(c.data.name(function))) {
      c.unsupported(form, "it is no function here; write a lambda that calls it");
    } else {
      c.unknown_form(function, function);
    }
    return c.nil(form);
  }
  if (callee->local) return c.code.local_function_value(*callee->local, form);
  FunctionTemplate made;
  made.builtin = callee->builtin.has_value();
  made.unit = made.builtin ? *callee->builtin : callee->function->unit;
  if (made.builtin) c.code.code().multiple_values = true;  // perhaps `floor`
  if (!made.builtin && callee->function->top_level && c.in_function) {
    c.unsupported(form, "a `def-top-level-cram-function` cannot be called from a plan");
  }
  c.code.function_value(std::move(made), form);
}

namespace {

void form_function(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() != 2) return c.refuse(form, "expected a name or a lambda");
  compile_function_value(c, form, items[1]);
}

void form_lambda(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() < 2) return c.refuse(form, "expected parameters");
  compile_function_value(c, form, form);
}

}  // namespace

std::span<const FormEntry> value_forms() {
  static constexpr FormEntry kForms[] = {
      {"values", form_values},
      {"values-list", form_values_list},
      {"multiple-value-bind", form_multiple_value_bind},
      {"multiple-value-list", form_multiple_value_list},
      {"multiple-value-setq", form_multiple_value_setq},
      {"multiple-value-prog1", form_prog1},
      {"nth-value", form_nth_value},
      {"prog1", form_prog1},
      {"prog2", form_prog1},
      {"function", form_function},
      {"lambda", form_lambda},
  };
  return kForms;
}

}  // namespace parallax::compiler
