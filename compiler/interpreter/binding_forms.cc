#include <string_view>
#include <vector>

#include "compiler/interpreter/destructuring.h"
#include "compiler/interpreter/form_compiler.h"
#include "compiler/interpreter/variables.h"

namespace parallax::compiler {
namespace {

void let(FormCompiler& c, DatumId form, FormItems items, bool sequential) {
  if (items.size() < 2 || (!c.data.is_list(items[1]) && !c.data.is_nil(items[1]))) {
    return c.refuse(form, "expected a list of bindings");
  }
  const auto scope = c.code.scope().size();
  std::vector<LexicalBinding> bound;
  std::uint32_t count = 0;
  for (const auto binding : c.data.children(items[1])) {
    const auto parts = c.data.children(binding);
    const auto name = parts.empty() ? binding : parts.front();
    if (!c.data.is_symbol(name) || parts.size() > 2) {
      c.malformed(form, "a binding is a name or (name value)");
      continue;
    }
    if (parts.size() == 2) {
      c.compile(parts[1]);
    } else {
      c.nil(binding);
    }
    ++count;
    bound.push_back(variable(c, name, c.code.height() - 1));
    if (sequential) show_variable(c, bound.back(), form);
  }
  for (const auto& binding : bound) {
    if (!sequential) show_variable(c, binding, form);
  }
  c.compile_declared(items.subspan(2));
  close_variables(c, scope, count, form);
}

void form_let(FormCompiler& c, DatumId form, FormItems items) { let(c, form, items, false); }
void form_let_star(FormCompiler& c, DatumId form, FormItems items) { let(c, form, items, true); }

void form_setf(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() % 2 == 0) c.malformed(form, "expected pairs of a place and a value");
  if (items.size() < 3) return c.nil(form);
  for (std::size_t i = 1; i + 1 < items.size(); i += 2) {
    if (i > 1) {
      c.code.drop(form);
    }
    c.compile(items[i + 1]);
    const auto* target = assignable(c, form, items[i]);
    if (target != nullptr) assign(c, *target, form);
  }
}

void form_incf(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() < 2 || items.size() > 3) {
    return c.refuse(form, "expected a variable and perhaps a step");
  }
  const auto* target = assignable(c, form, items[1]);
  if (target == nullptr) return c.nil(form);
  const LexicalBinding place = *target;  // compiling may grow the scope
  const std::string_view operation = c.form_name(form) == "decf" ? "-" : "+";
  if (items.size() == 3) {
    // The step is computed before the variable is read.
    const auto step = c.code.height();
    c.compile(items[2]);
    c.compile(items[1]);
    c.code.load(step, form);
    c.code.builtin(operation, 2, form);
    c.code.squeeze(1, form);
  } else {
    c.compile(items[1]);
    c.code.constant(c.values.number(Number(1)), form);
    c.code.builtin(operation, 2, form);
  }
  assign(c, place, form);
}

/// (push value variable), and (pushnew value variable), which adds a value that is not yet a member
/// by `eql`.
void form_push(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() != 3) {
    return c.refuse(form, "expected a value and a variable");
  }
  c.compile(items[1]);
  const auto* target = assignable(c, form, items[2]);
  if (target == nullptr) return;
  const LexicalBinding place = *target;
  c.compile(items[2]);
  c.code.builtin(c.form_name(form) == "push" ? "cons" : "adjoin", 2, form);
  assign(c, place, form);
}

/// (pop variable) is the first element, which the variable loses.
void form_pop(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() != 2) return c.refuse(form, "expected a variable");
  const auto* target = assignable(c, form, items[1]);
  if (target == nullptr) return c.nil(form);
  const LexicalBinding place = *target;
  c.compile(items[1]);
  c.code.builtin("car", 1, form);
  c.compile(items[1]);
  c.code.builtin("cdr", 1, form);
  assign(c, place, form);
  c.code.drop(form);
}

void form_destructuring_bind(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() < 3 || !c.data.is_list(items[1])) {
    return c.refuse(form, "expected a pattern and a list");
  }
  const auto scope = c.code.scope().size();
  const auto height = c.code.height();
  c.compile(items[2]);
  c.code.emit(PlanOp::kExpectList, 0, 0, form);
  destructure(c, form, items[1], height);
  c.compile_declared(items.subspan(3));
  close_variables(c, scope, c.code.height() - 1 - height, form);
}

}  // namespace

std::span<const FormEntry> binding_forms() {
  static constexpr FormEntry kForms[] = {
      {"let", form_let},   {"let*", form_let_star},
      {"setf", form_setf}, {"setq", form_setf},
      {"incf", form_incf}, {"decf", form_incf},
      {"push", form_push}, {"pushnew", form_push},
      {"pop", form_pop},   {"destructuring-bind", form_destructuring_bind},
  };
  return kForms;
}

}  // namespace parallax::compiler
