// Forms that use the solutions of `prolog`, and designators made for the length of a body.
#include "compiler/interpreter/form_compiler.h"
#include "compiler/interpreter/variables.h"

namespace parallax::compiler {
namespace {

/// (force-ll (prolog goal)): all solutions; of any other list the list itself.
void form_force(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() != 2) return c.refuse(form, "expected a list");
  const auto inner = c.data.children(items[1]);
  if (c.data.head(items[1]) != "prolog" || inner.size() != 2) {
    c.compile(items[1]);
    return c.code.builtin("force-ll", 1, form);
  }
  c.compile(inner[1]);
  c.code.emit(PlanOp::kHolds, 2, 0, form);
}

/// (with-vars-bound (?x...) bindings form...): the variables as the bindings have them.
void bind_variables(FormCompiler& c, DatumId form, FormItems items, bool strictly) {
  if (items.size() < 3 || !c.data.is_list(items[1])) {
    return c.refuse(form, "expected a list of variables and the bindings of a solution");
  }
  const auto scope = c.code.scope().size();
  const auto height = c.code.height();
  c.compile(items[2]);
  for (const auto variable : c.data.children(items[1])) {
    if (!c.data.is_symbol(variable)) {
      c.malformed(form, "a variable is a name");
      continue;
    }
    c.code.constant(c.values.symbol(c.data.name(variable)), variable);
    c.code.load(height, form);
    c.code.builtin(strictly ? "%bound-value" : "var-value", 2, form);
    bind_top(c, variable, form);
  }
  c.compile_body(c.skip_declarations(items.subspan(3)));
  close_variables(c, scope, c.code.height() - 1 - height, form);
}

void form_vars_bound(FormCompiler& c, DatumId form, FormItems items) {
  bind_variables(c, form, items, false);
}
void form_vars_strictly_bound(FormCompiler& c, DatumId form, FormItems items) {
  bind_variables(c, form, items, true);
}

/// (with-desig-props (key...) designator form...): variables called like the properties.
void form_with_props(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() < 3 || !c.data.is_list(items[1])) {
    return c.refuse(form, "expected a list of properties and a designator");
  }
  const auto scope = c.code.scope().size();
  const auto height = c.code.height();
  c.compile(items[2]);
  for (const auto key : c.data.children(items[1])) {
    if (!c.data.is_symbol(key)) {
      c.malformed(form, "a property is a name");
      continue;
    }
    c.code.load(height, form);
    c.code.constant(c.values.keyword(c.data.name(key)), key);
    c.code.builtin("desig-prop-value", 2, form);
    bind_top(c, key, form);
  }
  c.compile_body(c.skip_declarations(items.subspan(3)));
  close_variables(c, scope, c.code.height() - 1 - height, form);
}

/// (with-designators ((name class description)...) form...), one after the other.
void form_with_designators(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() < 2 || !c.data.is_list(items[1])) {
    return c.refuse(form, "expected a list of (name class description)");
  }
  const auto scope = c.code.scope().size();
  std::uint32_t count = 0;
  for (const auto made : c.data.children(items[1])) {
    const auto parts = c.data.children(made);
    if (parts.size() != 3 || !c.data.is_symbol(parts[0])) {
      c.malformed(form, "expected (name class description)");
      continue;
    }
    c.compile(parts[1]);
    c.compile(parts[2]);
    c.code.builtin("make-designator", 2, made);
    bind_top(c, parts[0], form);
    ++count;
  }
  c.compile_body(c.skip_declarations(items.subspan(2)));
  close_variables(c, scope, count, form);
}

}  // namespace

std::span<const FormEntry> prolog_forms() {
  static constexpr FormEntry kForms[] = {
      {"force-ll", form_force},
      {"with-vars-bound", form_vars_bound},
      {"with-vars-strictly-bound", form_vars_strictly_bound},
      {"with-designators", form_with_designators},
      {"with-desig-props", form_with_props},
  };
  return kForms;
}

}  // namespace parallax::compiler
