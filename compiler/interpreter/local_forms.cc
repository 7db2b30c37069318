// Functions and macros of a form's own: flet, labels, macrolet.
#include <utility>
#include <vector>

#include "compiler/interpreter/form_compiler.h"
#include "compiler/interpreter/function_calls.h"
#include "compiler/interpreter/lisp_macros.h"

namespace parallax::compiler {
namespace {

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

/// (macrolet ((name parameters form...)...) form...)
void form_macrolet(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() < 2 || (!c.data.is_list(items[1]) && !c.data.is_nil(items[1]))) {
    return c.refuse(form, "expected a list of macros");
  }
  const auto scope = c.code.scope().size();
  std::vector<LexicalBinding> bound;
  for (const auto definition : c.data.children(items[1])) {
    const auto parts = c.data.children(definition);
    if (parts.size() < 2 || !c.data.is_symbol(parts[0])) {
      c.malformed(form, "a macro is (name parameters form...)");
      continue;
    }
    const auto& name = c.data.name(parts[0]);
    const auto macro = declare_macro(c, definition, name, parts[1]);
    bound.push_back(c.code.named(BindingKind::kMacro, name, macro.unit));
    c.defined.local_macros[macro.unit] = macro;
    c.defined.unwritten[macro.unit] = {{}, macro, name, parts.subspan(2), c.position};
    c.complete(macro.unit);
  }
  c.code.show(bound);
  c.compile_body(c.skip_declarations(items.subspan(2)));
  c.code.cut_scope(scope);
}

}  // namespace

std::span<const FormEntry> local_forms() {
  static constexpr FormEntry kForms[] = {
      {"flet", form_flet},
      {"labels", form_flet},
      {"macrolet", form_macrolet},
  };
  return kForms;
}

}  // namespace parallax::compiler
