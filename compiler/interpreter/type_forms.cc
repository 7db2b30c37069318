// Types as conditions, and the forms of Common Lisp for errors.
#include <string>
#include <utility>
#include <vector>

#include "compiler/base/codes/plans.h"
#include "compiler/interpreter/form_compiler.h"

namespace parallax::compiler {
namespace {

/// Leaves t or nil: is the value at `place` of that type?
void type_test(FormCompiler& c, DatumId type, std::uint32_t place, DatumId source) {
  c.code.load(place, source);
  c.code.constant(c.datum_value(type), type);
  c.code.builtin("typep", 2, source);
}

/// typecase and etypecase
void form_typecase(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() < 2) return c.refuse(form, "expected a value and clauses");
  c.compile(items[1]);
  const auto place = c.code.height() - 1;
  std::vector<std::size_t> to_end;
  for (const auto clause : items.subspan(2)) {
    const auto parts = c.data.children(clause);
    if (parts.empty()) {
      c.malformed(form, "a clause is (type form...)");
      continue;
    }
    const bool any = c.data.is_symbol(parts[0], "t") || c.data.is_symbol(parts[0], "otherwise");
    if (any) {
      c.code.constant(c.values.truth(), clause);
    } else {
      type_test(c, parts[0], place, clause);
    }
    const auto to_next = c.code.jump(PlanOp::kJumpIfNil, clause);
    if (parts.size() > 1) {
      c.compile_body(parts.subspan(1));
    } else {
      c.nil(clause);
    }
    to_end.push_back(c.code.jump(PlanOp::kJump, clause));
    c.code.adjust(-1);
    c.code.patch_jump(to_next);
  }
  if (c.form_name(form) == "etypecase") {
    c.code.fail("case-failure", form);
  } else {
    c.nil(form);
  }
  for (const auto jump : to_end) c.code.patch_jump(jump);
  c.code.squeeze(1, form);
}

/// The test on top: a Lisp error if it is nil; the value is nil.
void fail_if_nil(FormCompiler& c, std::string_view failure_class, DatumId form) {
  const auto to_error = c.code.jump(PlanOp::kJumpIfNil, form);
  c.nil(form);
  const auto to_end = c.code.jump(PlanOp::kJump, form);
  c.code.adjust(-1);
  c.code.patch_jump(to_error);
  c.code.fail(failure_class, form);
  c.code.patch_jump(to_end);
}

/// (check-type place type [text])
void form_check_type(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() < 3) return c.refuse(form, "expected a place and a type");
  c.compile(items[1]);
  type_test(c, items[2], c.code.height() - 1, form);
  fail_if_nil(c, "type-error", form);
  c.code.squeeze(1, form);
}

/// (assert test [places [class or text argument...]])
void form_assert(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() < 2) return c.refuse(form, "expected a test");
  c.check_no_perform(form);
  std::string failure = "simple-error";
  if (items.size() > 3 && c.data.head(items[3]) == "quote") {
    failure = c.failure_class(items[3]).value_or(failure);
  }
  c.compile(items[1]);
  fail_if_nil(c, failure, form);
}

/// (ignore-errors form...): the value of the last one, nil after a Lisp error.
void form_ignore_errors(FormCompiler& c, DatumId form, FormItems items) {
  const auto exit = c.code.open_exit();
  const auto unit = c.code.declare_unit("a failure handler", form, 1);
  c.code.enter_unit(unit);
  c.nil(form);
  c.code.emit(PlanOp::kExit, 1, exit, form);
  c.code.leave_unit(PlanOp::kEndHandler, form);
  c.code.push_handlers(c.code.add_handlers({{"error", unit}}), form);
  c.compile_body(items.subspan(1));
  c.code.pop_guard(form);
  c.code.set_exit(exit);
}

/// (handler-bind ((class function)...) form...): each function is called with the failure, while
/// the body still stands; one that returns has declined.
void form_handler_bind(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() < 2 || (!c.data.is_list(items[1]) && !c.data.is_nil(items[1]))) {
    return c.refuse(form, "expected a list of (class function) and a body");
  }
  const auto height = c.code.height();
  std::vector<HandlerClause> table;
  std::vector<std::pair<DatumId, std::uint32_t>> functions;
  for (const auto binding : c.data.children(items[1])) {
    const auto parts = c.data.children(binding);
    if (parts.size() != 2) {
      c.malformed(binding, "a binding is (class function)");
      continue;
    }
    c.compile(parts[1]);
    functions.emplace_back(binding, c.code.height() - 1);
  }
  for (const auto& [binding, place] : functions) {
    const auto function = c.code.named(BindingKind::kVariable, "", place);
    const auto unit = c.code.declare_unit("a failure handler", binding, 1);
    c.code.enter_unit(unit);
    c.code.load(function, binding);
    c.code.load(0, binding);
    c.code.call_value(1, false, binding);
    c.code.leave_unit(PlanOp::kEndHandler, binding);
    const auto name = c.data.children(binding)[0];
    const auto classes = c.data.head(name) == "or" ? c.data.children(name).subspan(1)
                                                   : c.data.children(binding).first(1);
    for (const auto one : classes) {
      const auto known = c.handled_class(one);
      if (!known) continue;
      table.push_back({*known, unit});
    }
  }
  c.code.push_handlers(c.code.add_handlers(std::move(table)), form);
  c.compile_body(items.subspan(2));
  c.code.pop_guard(form);
  c.code.squeeze(c.code.height() - 1 - height, form);
}

/// (the type form): a Lisp error if the value has another type, as with a declaration.
void form_the(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() != 3) return c.refuse(form, "expected a type and a form");
  c.compile(items[2]);
  c.code.load(c.code.height() - 1, form);
  c.code.constant(c.datum_value(items[1]), items[1]);
  c.code.builtin("%may-be", 2, form);
  fail_if_nil(c, "type-error", form);
  c.code.drop(form);
}

/// (make-instance 'class keyword value...): the class's maker.
void form_make_instance(FormCompiler& c, DatumId form, FormItems items) {
  const bool quoted = items.size() > 1 && c.data.head(items[1]) == "quote" &&
                      c.data.children(items[1]).size() == 2 &&
                      c.data.is_symbol(c.data.children(items[1])[1]);
  if (!quoted) return c.refuse(form, "expected a quoted class");
  const auto name = c.data.children(items[1])[1];
  const auto maker = "%make-" + std::string(c.data.name(name));
  if (!c.defined.functions.contains(maker)) {
    c.unknown_form(form, name);
    return c.nil(form);
  }
  std::vector<DatumId> call = {
      c.data.add_named(DatumKind::kSymbol, maker, "", c.data.source(form))};
  call.insert(call.end(), items.begin() + 2, items.end());
  c.compile(c.data.add_list(call, c.data.source(form)));
}

/// (type t variable...), the only declaration that SBCL checks and plans use.
void check_declaration(FormCompiler& c, DatumId declaration) {
  const auto parts = c.data.children(declaration);
  if (c.data.head(declaration) != "type" || parts.size() < 3) return;
  for (const auto name : parts.subspan(2)) {
    if (!c.data.is_symbol(name)) continue;
    const auto* variable = c.code.lookup(BindingKind::kVariable, c.data.name(name));
    if (variable == nullptr) continue;
    c.code.load(*variable, declaration);
    c.code.constant(c.datum_value(parts[1]), declaration);
    c.code.builtin("%may-be", 2, declaration);
    fail_if_nil(c, "type-error", declaration);
    c.code.drop(declaration);
  }
}

}  // namespace

void FormCompiler::compile_declared(FormItems body) {
  const auto rest = skip_declarations(body);
  for (const auto form : body.first(body.size() - rest.size())) {
    if (data.head(form) != "declare") continue;
    for (const auto declaration : data.children(form).subspan(1)) {
      check_declaration(*this, declaration);
    }
  }
  compile_body(rest);
}

std::span<const FormEntry> type_forms() {
  static constexpr FormEntry kForms[] = {
      {"typecase", form_typecase},
      {"etypecase", form_typecase},
      {"check-type", form_check_type},
      {"assert", form_assert},
      {"ignore-errors", form_ignore_errors},
      {"handler-bind", form_handler_bind},
      {"the", form_the},
      {"make-instance", form_make_instance},
  };
  return kForms;
}

}  // namespace parallax::compiler
