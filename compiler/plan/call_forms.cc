#include <algorithm>
#include <utility>

#include "compiler/plan/form_compiler.h"
#include "compiler/plan/function_calls.h"

namespace parallax::compiler {
namespace {

void form_funcall(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() < 2) {
    return c.refuse(form, "expected a function");
  }
  const auto callee = resolve_callee(c, form, items[1]);
  if (!callee) return c.nil(form);
  compile_call(c, form, c.form_name(form), *callee, items.subspan(2));
}

/// (apply #'f a b list): the number of arguments is known only when the list is.
void form_apply(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() < 3) {
    return c.refuse(form, "expected a function and a list of arguments");
  }
  const auto callee = resolve_callee(c, form, items[1]);
  for (const auto item : items.subspan(2, items.size() - 3)) {
    c.compile(item);
    c.code.builtin("list", 1, item);
  }
  c.compile(items.back());
  c.code.builtin("append", static_cast<std::uint32_t>(items.size() - 2), form);
  if (!callee) return;
  c.code.emit(PlanOp::kApply, 0, 0, form);
  if (callee->builtin) {
    c.code.emit(PlanOp::kBuiltin, *callee->builtin, 0, form);
    return;
  }
  const auto& parameters = callee->function->parameters;
  const auto optional = [](const PlanParameter& parameter) { return parameter.optional; };
  if (std::any_of(parameters.begin(), parameters.end(), optional)) {
    c.unsupported(form, "a function with optional parameters cannot be applied to a list");
  }
  c.code.emit(callee->level ? PlanOp::kCallLocal : PlanOp::kCall, callee->function->unit,
              callee->level.value_or(0), form);
}

/// flet and labels: local functions, which see the variables around them.
void form_flet(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() < 2 || !c.data.is_list(items[1])) {
    return c.refuse(form, "expected a list of functions");
  }
  const auto scope = c.code.scope().size();
  std::vector<std::pair<PlanFunction, FormItems>> declared;
  std::vector<LexicalBinding> bound;
  for (const auto definition : c.data.children(items[1])) {
    const auto parts = c.data.children(definition);
    if (parts.size() < 2 || !c.data.is_symbol(parts[0])) {
      c.malformed(form, "a function is (name parameters form...)");
      continue;
    }
    auto function = declare_function(c, definition, c.data.name(parts[0]), parts[1]);
    bound.push_back(c.code.named(BindingKind::kFunction, c.data.name(parts[0]), function.unit));
    c.defined.local_functions[function.unit] = function;
    declared.emplace_back(std::move(function), parts.subspan(2));
  }
  const bool recursive = c.form_name(form) == "labels";
  if (recursive) c.code.show(bound);
  for (std::size_t i = 0; i < declared.size(); ++i) {
    compile_function(c, declared[i].first, bound[i].name, declared[i].second);
  }
  if (!recursive) c.code.show(bound);
  c.compile_body(c.skip_declarations(items.subspan(2)));
  c.code.cut_scope(scope);
}

}  // namespace

std::span<const FormEntry> call_forms() {
  static constexpr FormEntry kForms[] = {
      {"funcall", form_funcall},
      {"apply", form_apply},
      {"flet", form_flet},
      {"labels", form_flet},
  };
  return kForms;
}

}  // namespace parallax::compiler
