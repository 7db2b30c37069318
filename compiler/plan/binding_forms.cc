#include "compiler/base/diagnostic_codes.h"
#include "compiler/plan/destructuring.h"
#include "compiler/plan/form_compiler.h"

namespace parallax::compiler {
namespace {

using base::DiagnosticCode;

/// A `let` of a global rebinds it for what its body calls, as far as that runs in the same task.
int show_variable(FormCompiler& c, LexicalBinding variable, DatumId form) {
  if (variable.kind != BindingKind::kSpecial) {
    c.code.show(std::move(variable));
    return 0;
  }
  const auto global = c.defined.globals.find(variable.name);
  c.code.bind_special(global->second, variable.index, form);
  variable.index = global->second;
  c.code.show(std::move(variable));
  return 1;
}

void let(FormCompiler& c, DatumId form, FormItems items, bool sequential) {
  if (items.size() < 2 || (!c.data.is_list(items[1]) && !c.data.is_nil(items[1]))) {
    return c.refuse(form, "expected a list of bindings");
  }
  const auto scope = c.code.scope().size();
  std::vector<LexicalBinding> bound;
  std::uint32_t count = 0;
  int specials = 0;
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
    const bool is_global = c.defined.globals.contains(c.data.key(name));
    bound.push_back(is_global ? c.code.named(BindingKind::kSpecial, c.data.key(name), 0)
                              : c.code.named(BindingKind::kVariable, c.data.name(name), 0));
    bound.back().index = c.code.height() - 1;
    if (sequential) specials += show_variable(c, bound.back(), form);
  }
  for (const auto& variable : bound) {
    if (!sequential) specials += show_variable(c, variable, form);
  }
  c.compile_body(c.skip_declarations(items.subspan(2)));
  for (; specials > 0; --specials) c.code.pop_guard(form);
  c.code.squeeze(count, form);
  c.code.cut_scope(scope);
}

void form_let(FormCompiler& c, DatumId form, FormItems items) { let(c, form, items, false); }
void form_let_star(FormCompiler& c, DatumId form, FormItems items) { let(c, form, items, true); }

/// The variable that a form may change, lexical or rebound, or a report of why it may not.
const LexicalBinding* assignable(FormCompiler& c, DatumId form, DatumId place) {
  if (c.data.is_symbol(place) && !c.data.is_nil(place)) {
    if (const auto* binding = c.code.lookup(BindingKind::kVariable, c.data.name(place)))
      return binding;
    const auto* special = c.code.lookup(BindingKind::kSpecial, c.data.key(place));
    if (special != nullptr && !c.code.in_other_task(*special)) return special;
    if (!c.defined.globals.contains(c.data.key(place))) {
      c.compile(place);  // reports it
      c.code.drop(place);
      return nullptr;
    }
  }
  auto error =
      c.error(DiagnosticCode::kHeapWrite, place, c.form_name(form), print_datum(c.data, place));
  if (const auto global = c.defined.globals.find(c.data.is_symbol(place) ? c.data.key(place) : "");
      global != c.defined.globals.end()) {
    error.note(c.data.source(c.code.code().globals[global->second].source),
               "it is a global constant, defined here");
  }
  return nullptr;
}

void assign(FormCompiler& c, const LexicalBinding& place, DatumId form) {
  if (place.kind != BindingKind::kSpecial) return c.code.store(place, form);
  c.code.emit(PlanOp::kStoreSpecial, place.index, 0, form);
}

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
  c.compile(items[1]);
  if (items.size() == 3) {
    c.compile(items[2]);
  } else {
    c.code.constant(c.values.number(Number(1)), form);
  }
  c.code.builtin(c.form_name(form) == "decf" ? "-" : "+", 2, form);
  assign(c, place, form);
}

/// (push value variable), and (pushnew value variable), which adds what is no member by `eql`.
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
  c.compile_body(c.skip_declarations(items.subspan(3)));
  const auto count = c.code.height() - 1 - height;
  c.code.squeeze(count, form);
  c.code.cut_scope(scope);
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
