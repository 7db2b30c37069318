#include "compiler/base/diagnostic_codes.h"
#include "compiler/plan/form_compiler.h"

namespace parallax::compiler {
namespace {

using base::DiagnosticCode;

void form_quote(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() != 2) c.malformed(form, "expected one datum");
  c.code.constant(items.size() == 2 ? c.datum_value(items[1]) : c.values.nil(), form);
}

void quasiquote(FormCompiler& c, DatumId datum) {
  const auto items = c.data.children(datum);
  const auto head = c.data.head(datum).value_or("");
  if (items.empty()) return c.code.constant(c.datum_value(datum), datum);
  if (head == "unquote" && items.size() == 2) return c.compile(items[1]);
  if (head == "quasiquote") {
    c.unsupported(datum, "nested backquotes");
    return c.nil(datum);
  }
  const bool dotted = c.data.is_dotted(datum);
  for (const auto item : items) {
    const auto parts = c.data.children(item);
    if (dotted && item == items.back()) {
      quasiquote(c, item);
    } else if (c.data.head(item) == "unquote-splicing" && parts.size() == 2) {
      c.compile(parts[1]);
    } else {
      quasiquote(c, item);
      c.code.builtin("list", 1, item);
    }
  }
  c.code.builtin("append", static_cast<std::uint32_t>(items.size()), datum);
}

void form_quasiquote(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() == 2) return quasiquote(c, items[1]);
  c.malformed(form, "expected one datum");
  c.nil(form);
}

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

void form_push(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() != 3) {
    return c.refuse(form, "expected a value and a variable");
  }
  c.compile(items[1]);
  const auto* target = assignable(c, form, items[2]);
  if (target == nullptr) return;
  const LexicalBinding place = *target;
  c.compile(items[2]);
  c.code.builtin("cons", 2, form);
  assign(c, place, form);
}

/// Binds the names of `pattern` to the elements of the list at `place`; the new variables stay on
/// the stack.
void destructure(FormCompiler& c, DatumId form, DatumId pattern, std::uint32_t place) {
  const auto items = c.data.children(pattern);
  c.code.load(place, form);
  c.code.constant(c.values.number(Number(static_cast<std::int64_t>(items.size()))), form);
  c.code.builtin("%expect-length", 2, form);
  c.code.store_and_drop(place, form);
  for (std::size_t i = 0; i < items.size(); ++i) {
    c.code.constant(c.values.number(Number(static_cast<std::int64_t>(i))), form);
    c.code.load(place, form);
    c.code.builtin("nth", 2, form);
    if (c.data.is_list(items[i])) {
      destructure(c, form, items[i], c.code.height() - 1);
    } else if (c.data.is_symbol(items[i]) && !c.data.name(items[i]).starts_with("&")) {
      c.code.bind_top(c.data.name(items[i]));
    } else {
      c.unsupported(items[i], "a pattern consists of names");
    }
  }
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

/// (values a b ...) is its first value, for whoever does not ask for the others.
void form_values(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() == 1) return c.nil(form);
  for (const auto item : items.subspan(1)) c.compile(item);
  for (auto extra = items.size() - 2; extra > 0; --extra) c.code.drop(form);
}

/// (multiple-value-bind (v...) (values a...) form...): the values must be written there.
void form_multiple_value_bind(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() < 3 || (!c.data.is_list(items[1]) && !c.data.is_nil(items[1]))) {
    return c.refuse(form, "expected variables and a form");
  }
  if (c.data.head(items[2]) != "values") {
    c.unsupported(form,
                  "the values come from `(values ...)` itself; let the function return a list "
                  "and use `destructuring-bind`");
    return c.nil(form);
  }
  const auto given = c.data.children(items[2]).subspan(1);
  const auto names = c.data.children(items[1]);
  const auto scope = c.code.scope().size();
  const auto height = c.code.height();
  for (const auto value : given) c.compile(value);
  for (auto i = given.size(); i < names.size(); ++i) c.nil(form);
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!c.data.is_symbol(names[i])) {
      c.malformed(form, "a variable is a name");
      continue;
    }
    c.code.show(c.code.named(BindingKind::kVariable, c.data.name(names[i]),
                             height + static_cast<std::uint32_t>(i)));
  }
  const auto count = c.code.height() - height;
  c.compile_body(c.skip_declarations(items.subspan(3)));
  c.code.squeeze(count, form);
  c.code.cut_scope(scope);
}

}  // namespace

std::span<const FormEntry> binding_forms() {
  static constexpr FormEntry kForms[] = {
      {"quote", form_quote},   {"quasiquote", form_quasiquote},
      {"let", form_let},       {"let*", form_let_star},
      {"setf", form_setf},     {"setq", form_setf},
      {"incf", form_incf},     {"decf", form_incf},
      {"push", form_push},     {"destructuring-bind", form_destructuring_bind},
      {"values", form_values}, {"multiple-value-bind", form_multiple_value_bind},
  };
  return kForms;
}

}  // namespace parallax::compiler
