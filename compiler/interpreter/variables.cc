#include "compiler/interpreter/variables.h"

#include <algorithm>
#include <utility>

#include "compiler/base/codes/plans.h"

namespace parallax::compiler {

LexicalBinding variable(const FormCompiler& c, DatumId symbol, std::uint32_t place) {
  // Names in our own Lisp never refer to globals of the plan.
  const bool special = c.defined.globals.contains(c.data.key(symbol)) && !c.data.in_library(symbol);
  return special ? c.code.named(BindingKind::kSpecial, c.data.key(symbol), place)
                 : c.code.named(BindingKind::kVariable, c.data.name(symbol), place);
}

void show_variable(FormCompiler& c, LexicalBinding variable, DatumId source) {
  if (variable.kind == BindingKind::kSpecial) {
    const auto global = c.defined.globals.at(variable.name);
    c.code.bind_special(global, variable.index, source);
    variable.index = global;
  }
  c.code.show(std::move(variable));
}

void bind_variable(FormCompiler& c, DatumId symbol, std::uint32_t place, DatumId source) {
  show_variable(c, variable(c, symbol, place), source);
}

void bind_top(FormCompiler& c, DatumId symbol, DatumId source) {
  bind_variable(c, symbol, c.code.height() - 1, source);
}

void close_variables(FormCompiler& c, std::size_t scope, std::uint32_t count, DatumId source) {
  const auto& names = c.code.scope();
  auto specials = std::count_if(
      names.begin() + static_cast<std::ptrdiff_t>(scope), names.end(),
      [](const LexicalBinding& binding) { return binding.kind == BindingKind::kSpecial; });
  for (; specials > 0; --specials) c.code.pop_guard(source);
  if (count > 0) c.code.squeeze(count, source);
  c.code.cut_scope(scope);
}

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
  const auto global = c.defined.globals.find(c.data.is_symbol(place) ? c.data.key(place) : "");
  if (global == c.defined.globals.end()) {
    c.error(codes::kHeapWrite, place, c.form_name(form), print_datum(c.data, place));
    return nullptr;
  }
  const auto source = c.code.code().globals[global->second].source;
  if (c.data.head(source) == "defconstant") {
    c.error(codes::kHeapWrite, place, c.form_name(form), print_datum(c.data, place))
        .note(c.data.source(source), "it is a constant, defined here");
    return nullptr;
  }
  c.code.code().sets_globals = true;
  auto named = c.code.named(BindingKind::kSpecial, global->first, global->second);
  return &c.defined.set_globals.insert_or_assign(global->second, named).first->second;
}

void assign(FormCompiler& c, const LexicalBinding& place, DatumId form) {
  if (place.kind != BindingKind::kSpecial) return c.code.store(place, form);
  c.code.emit(PlanOp::kStoreSpecial, place.index, 0, form);
}

}  // namespace parallax::compiler
