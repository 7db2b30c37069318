// The meaning of a name that stands as a form: a variable, a global, an input of the plan.
#include <algorithm>
#include <string>
#include <vector>

#include "compiler/base/codes/plans.h"
#include "compiler/base/suggest.h"
#include "compiler/builtins/unknown_values.h"
#include "compiler/interpreter/form_compiler.h"

namespace parallax::compiler {

/// The first value of a global, if that is written out: macros know it before the plan runs.
std::optional<DatumId> FormCompiler::literal_of(std::uint32_t global) const {
  const auto items = data.children(code.code().globals[global].source);
  if (items.size() < 3) return std::nullopt;
  if (data.head(items[2]) == "quote" && data.children(items[2]).size() == 2) {
    return data.children(items[2])[1];
  }
  const bool written = data.is_number(items[2]) || data.is_string(items[2]) ||
                       data.is_keyword(items[2]) || data.is_nil(items[2]) ||
                       data.is_symbol(items[2], "t");
  return written ? std::optional(items[2]) : std::nullopt;
}

/// A variable like `?x` that stands free in the call that the plan begins with.
bool FormCompiler::is_input(DatumId symbol) const {
  const auto& name = data.name(symbol);
  return entry_file && data.source(symbol).file == *entry_file && name.size() > 1 &&
         name.starts_with('?');
}

/// Any value that it can have: a register that has one from the beginning.
void FormCompiler::compile_input(DatumId symbol) {
  auto& inputs = code.code().inputs;
  auto found = std::find(inputs.begin(), inputs.end(), data.name(symbol));
  if (found == inputs.end()) found = inputs.insert(found, data.name(symbol));
  const auto number = static_cast<std::uint32_t>(found - inputs.begin());
  code.constant(values.model(ModelValueId(number)), symbol);
}

void FormCompiler::compile_symbol(DatumId symbol) {
  const auto& name = data.name(symbol);
  if (name == "nil" || name == "t") return code.constant(datum_value(symbol), symbol);
  if (const auto* binding = code.lookup(BindingKind::kVariable, name)) {
    return code.load(*binding, symbol);
  }
  if (const auto global = defined.globals.find(data.key(symbol)); global != defined.globals.end()) {
    if (const auto literal = literal_of(global->second); in_macro && literal) {
      return code.constant(datum_value(*literal), symbol);
    }
    code.emit(PlanOp::kLoadGlobal, global->second, 0, symbol);
    return code.adjust(1);
  }
  if (const auto known = robot_global(name, values)) return code.constant(*known, symbol);
  if (is_input(symbol)) return compile_input(symbol);
  std::vector<std::string> names;
  for (const auto& binding : code.scope()) {
    if (binding.kind == BindingKind::kVariable) names.push_back(binding.name);
  }
  for (const auto& [global, index] : defined.globals) names.push_back(global);
  auto report = error(codes::kUnboundPlanVariable, symbol, name);
  note_other_package(report, symbol);
  if (const auto near = base::nearest_name(name, names)) {
    report.fix(fmt::format("replace `{}` with `{}`", name, *near));
  }
  nil(symbol);
}

}  // namespace parallax::compiler
