// The functions of a plan as units: their parameters and their bodies.
#include <fmt/core.h>

#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "compiler/interpreter/form_compiler.h"
#include "compiler/interpreter/function_calls.h"
#include "compiler/interpreter/variables.h"

namespace parallax::compiler {
namespace {

struct Signature {
  std::vector<PlanParameter> parameters;
  std::vector<PlanParameter> variables;  // &aux
  bool other_keys = false;
  bool good = true;
};

bool is_constant(const FormCompiler& c, DatumId form) {
  if (c.data.is_nil(form)) return true;
  if (c.data.is_list(form)) return c.data.head(form) == "quote";
  return !c.data.is_symbol(form) || c.data.name(form) == "t";
}

void parameter(FormCompiler& c, DatumId form, DatumId item, std::string_view mode, Signature& out) {
  PlanParameter result;
  const bool aux = mode == "&aux";
  result.optional = mode == "&optional" || mode == "&key" || aux;
  result.rest = mode == "&rest";
  auto name = item;
  auto parts = c.data.children(item);
  if (result.optional && !parts.empty() && parts.size() <= 3) {
    name = parts.front();
    if (parts.size() > 1) result.default_value = parts[1];
    if (parts.size() > 2 && c.data.is_symbol(parts[2])) result.supplied = parts[2];
  }
  // ((:key variable) ...): the caller's name for it and the function's own.
  std::string keyword;
  if (const auto pair = c.data.children(name);
      mode == "&key" && pair.size() == 2 && c.data.is_keyword(pair[0])) {
    keyword = c.data.name(pair[0]);
    name = pair[1];
  }
  if (!c.data.is_symbol(name) || c.data.is_nil(name)) {
    c.malformed(form, "a parameter is a name");
    out.good = false;
    return;
  }
  result.computed =
      result.supplied || (result.default_value && !is_constant(c, *result.default_value));
  result.name = c.data.name(name);
  result.symbol = name;
  if (mode == "&key") result.keyword = keyword.empty() ? result.name : keyword;
  (aux ? out.variables : out.parameters).push_back(std::move(result));
}

Signature parameter_list(FormCompiler& c, DatumId form, DatumId list) {
  Signature out;
  if (!c.data.is_list(list) && !c.data.is_nil(list)) {
    c.malformed(form, "expected a list of parameters");
    out.good = false;
  }
  std::string mode;
  for (const auto item : c.data.children(list)) {
    const bool marker = c.data.is_symbol(item) && c.data.name(item).starts_with("&");
    if (!marker) {
      parameter(c, form, item, mode, out);
      continue;
    }
    mode = c.data.name(item);
    if (mode == "&body") mode = "&rest";
    if (mode == "&allow-other-keys") {
      out.other_keys = true;
      continue;
    }
    if (mode == "&optional" || mode == "&rest" || mode == "&key" || mode == "&aux") continue;
    c.unsupported(form, fmt::format("`{}` in a parameter list", mode));
    out.good = false;
    break;
  }
  return out;
}

/// The constant that stands for an argument that is not given.
ValueId default_value(FormCompiler& c, const PlanParameter& parameter) {
  if (parameter.computed) return c.values.not_given();
  if (!parameter.default_value) return c.values.nil();
  const auto parts = c.data.children(*parameter.default_value);
  return c.datum_value(parts.size() == 2 ? parts[1] : *parameter.default_value);
}

/// For calls whose arguments are known only while the plan runs.
void note_signature(FormCompiler& c, const PlanFunction& function) {
  using Kind = UnitParameter::Kind;
  auto& unit = c.code.code().units[function.unit];
  unit.other_keys = function.other_keys;
  unit.top_level = function.top_level;
  for (const auto& parameter : function.parameters) {
    auto kind = parameter.optional ? Kind::kOptional : Kind::kRequired;
    if (!parameter.keyword.empty()) kind = Kind::kKey;
    if (parameter.rest) kind = Kind::kRest;
    unit.signature.push_back(
        {kind, parameter.name, parameter.keyword, default_value(c, parameter)});
  }
}

}  // namespace

PlanFunction declare_function(FormCompiler& c, DatumId form, std::string_view name,
                              DatumId parameters) {
  auto signature = parameter_list(c, form, parameters);
  const auto count = static_cast<std::uint32_t>(signature.parameters.size());
  const auto unit = c.code.declare_unit(name, form, count);
  PlanFunction out{unit, std::move(signature.parameters), form, std::move(signature.variables)};
  out.other_keys = signature.other_keys;
  const auto kind = c.data.head(form).value_or("");
  out.top_level = kind == "def-top-level-cram-function";
  out.task = out.top_level || kind == "def-cram-function";
  note_signature(c, out);
  return out;
}

/// Computes the arguments that the call left out, in the order of the parameters.
std::uint32_t compile_defaults(FormCompiler& c, const PlanFunction& function) {
  std::uint32_t flags = 0;
  for (std::uint32_t i = 0; i < function.parameters.size(); ++i) {
    const auto& parameter = function.parameters[i];
    if (parameter.supplied) {
      c.code.load(i, function.source);
      c.code.builtin("%given", 1, function.source);
    }
    if (parameter.computed) {
      c.code.load(i, function.source);
      c.code.builtin("%given", 1, function.source);
      c.code.builtin("not", 1, function.source);
      const auto given = c.code.jump(PlanOp::kJumpIfNil, function.source);
      if (parameter.default_value) {
        c.compile(*parameter.default_value);
      } else {
        c.nil(function.source);
      }
      c.code.store_and_drop(i, function.source);
      c.code.patch_jump(given);
    }
    bind_variable(c, parameter.symbol, i, function.source);
    if (!parameter.supplied) continue;
    bind_top(c, *parameter.supplied, function.source);
    ++flags;
  }
  for (const auto& variable : function.variables) {
    if (variable.default_value) {
      c.compile(*variable.default_value);
    } else {
      c.nil(function.source);
    }
    bind_top(c, variable.symbol, function.source);
    ++flags;
  }
  return flags;
}

void compile_function(FormCompiler& c, const PlanFunction& function, std::string_view block_name,
                      FormItems body) {
  c.code.enter_unit(function.unit);
  compile_function_body(c, function, block_name, body);
}

void compile_function_body(FormCompiler& c, const PlanFunction& function,
                           std::string_view block_name, FormItems body) {
  const auto scope = c.code.scope().size();
  // The parameters of a task are bound inside it, but for those of one at top level.
  std::optional<PlanAssembler::Block> task;
  if (function.task && !function.top_level) {
    task = c.code.open_block(block_name);
    c.code.open_task(function.source);
  }
  const auto inside = c.code.scope().size();
  const auto flags = compile_defaults(c, function);
  if (task) {
    ++c.tags;
    c.compile_declared(body);
    --c.tags;
  } else {
    const auto block = c.code.open_block(block_name);
    if (function.task) c.code.open_task(function.source);
    c.compile_declared(body);
    if (function.task) c.code.pop_guard(function.source);
    c.code.close_block(block);
  }
  close_variables(c, inside, flags, function.source);
  if (task) {
    c.code.pop_guard(function.source);
    c.code.close_block(*task);
  }
  c.code.leave_unit(PlanOp::kReturn, function.source);
  c.code.cut_scope(scope);
}

}  // namespace parallax::compiler
