#include <fmt/core.h>

#include <utility>

#include "compiler/base/diagnostic_codes.h"
#include "compiler/base/suggest.h"
#include "compiler/plan/plan_compiler.h"

namespace parallax::compiler {
namespace {

using base::DiagnosticCode;

bool defines_function(std::string_view head) {
  return head == "defun" || head == "def-cram-function" || head == "def-top-level-cram-function";
}

bool defines_global(std::string_view head) {
  return head == "defparameter" || head == "defvar" || head == "defconstant";
}

bool is_housekeeping(std::string_view head) {
  return head == "in-package" || head == "defpackage" || head == "declaim" || head == "declare" ||
         head == "proclaim" || head == "export";
}

}  // namespace

/// Drops docstrings and declarations at the head of a body.
PlanCompiler::Items PlanCompiler::skip_declarations(Items body) const {
  while (!body.empty()) {
    const bool docstring = data_.is_string(body.front()) && body.size() > 1;
    if (!docstring && data_.head(body.front()) != "declare") break;
    body = body.subspan(1);
  }
  return body;
}

void PlanCompiler::parameter(DatumId form, DatumId item, std::string_view mode, Signature& out) {
  Parameter result;
  result.optional = !mode.empty();
  auto name = item;
  const auto parts = data_.children(item);
  if (result.optional && !parts.empty() && parts.size() <= 2) {
    name = parts.front();
    if (parts.size() == 2) result.default_value = parts[1];
  }
  if (!data_.is_symbol(name) || data_.is_nil(name)) {
    malformed(form, "a parameter is a name");
    out.good = false;
    return;
  }
  if (result.default_value && !data_.is_nil(*result.default_value)) {
    const auto value = *result.default_value;
    const bool constant = !data_.is_list(value) || data_.head(value) == "quote";
    const bool variable =
        data_.is_symbol(value) && data_.name(value).front() != '*' && data_.name(value) != "t";
    if (!constant || variable) {
      unsupported(form, "the default of a parameter must be a constant");
      out.good = false;
    }
  }
  result.name = data_.name(name);
  if (mode == "&key") result.keyword = result.name;
  out.parameters.push_back(std::move(result));
}

PlanCompiler::Signature PlanCompiler::parameter_list(DatumId form, DatumId list) {
  Signature out;
  if (!data_.is_list(list) && !data_.is_nil(list)) {
    malformed(form, "expected a list of parameters");
    out.good = false;
  }
  std::string mode;
  for (const auto item : data_.children(list)) {
    const bool marker = data_.is_symbol(item) && data_.name(item).starts_with("&");
    if (!marker) {
      parameter(form, item, mode, out);
      continue;
    }
    mode = data_.name(item);
    if (mode == "&optional" || mode == "&key") continue;
    unsupported(form, fmt::format("`{}` in a parameter list", mode));
    out.good = false;
    break;
  }
  return out;
}

PlanCompiler::Function PlanCompiler::declare_function(DatumId form, std::string_view name,
                                                      DatumId parameters) {
  auto signature = parameter_list(form, parameters);
  const auto count = static_cast<std::uint32_t>(signature.parameters.size());
  const auto unit = declare_unit(name, form, count);
  code_.units[unit].recursive_limit = true;
  return {unit, std::move(signature.parameters), form};
}

void PlanCompiler::compile_function(const Function& function, std::string_view block_name,
                                    Items body) {
  const auto scope = scope_.size();
  enter_unit(function.unit);
  const auto depth = static_cast<std::uint32_t>(frames_.size() - 1);
  for (std::uint32_t i = 0; i < function.parameters.size(); ++i) {
    scope_.push_back({BindingKind::kVariable, function.parameters[i].name, depth, i});
  }
  const auto block = open_block(block_name);
  compile_body(skip_declarations(body));
  close_block(block);
  leave_unit(PlanOp::kReturn, function.source);
  scope_.resize(scope);
}

bool PlanCompiler::define_name(DatumId form, DatumId name) {
  if (!data_.is_symbol(name)) {
    malformed(form, "expected a name");
    return false;
  }
  const auto [entry, added] = defined_.emplace(data_.name(name), name);
  if (added) return true;
  failed_ = true;
  sink_.error(DiagnosticCode::kDuplicatePlanDefinition, data_.source(name), data_.name(name))
      .note(data_.source(entry->second), "first defined here");
  return false;
}

void PlanCompiler::define_function(DatumId form, Items items) {
  if (items.size() < 3) return malformed(form, "expected a name, parameters and a body");
  if (!define_name(form, items[1])) return;
  const auto& name = data_.name(items[1]);
  if (forms().contains(name))
    return unsupported(form, fmt::format("`{}` is a built-in form", name));
  const auto function = declare_function(form, name, items[2]);
  code_.functions.emplace(name, function.unit);
  functions_.emplace(name, function);
  function_order_.push_back(name);
}

void PlanCompiler::define_global(DatumId form, Items items) {
  if (items.size() < 2) return malformed(form, "expected a name and a value");
  // A function and a variable of one name live in different namespaces in Lisp; here they clash.
  if (!define_name(form, items[1])) return;
  globals_.emplace(data_.name(items[1]), static_cast<std::uint32_t>(code_.globals.size()));
  code_.globals.push_back({data_.name(items[1]), form});
  global_forms_.push_back(form);
}

void PlanCompiler::define_condition(DatumId form, Items items) {
  if (items.size() < 3 || !data_.is_symbol(items[1]) || !data_.is_list(items[2])) {
    return malformed(form, "expected a name and a list of parents");
  }
  std::vector<std::string> parents;
  for (const auto parent : data_.children(items[2])) {
    if (const auto known = failure_class(parent)) parents.push_back(*known);
  }
  if (parents.empty()) parents.emplace_back("simple-plan-failure");
  if (code_.classes.add(data_.name(items[1]), std::move(parents))) return;
  failed_ = true;
  sink_.error(DiagnosticCode::kDuplicatePlanDefinition, data_.source(items[1]),
              data_.name(items[1]));
}

void PlanCompiler::collect_definitions() {
  // Failure classes come first: a handler may stand above the definition of its class.
  for (const auto form : text_.forms) {
    if (data_.head(form) == "define-condition") define_condition(form, data_.children(form));
  }
  for (const auto form : text_.forms) {
    const auto head = data_.head(form).value_or("");
    const auto items = data_.children(form);
    if (defines_function(head)) {
      define_function(form, items);
    } else if (defines_global(head)) {
      define_global(form, items);
    } else if (!is_housekeeping(head) && head != "define-condition") {
      bare_forms_.push_back(form);
    }
  }
}

void PlanCompiler::compile_functions() {
  const auto first = text_.forms.front();
  code_.definitions = declare_unit("the definitions", first, 0);
  enter_unit(code_.definitions);
  for (const auto form : global_forms_) {
    const auto items = data_.children(form);
    if (items.size() > 2) {
      compile(items[2]);
    } else {
      emit_constant(values_.nil(), form);
    }
    emit(PlanOp::kStoreGlobal, globals_.at(data_.name(items[1])), 0, form);
    adjust(-1);
  }
  leave_unit(PlanOp::kDone, first);
  for (const auto& name : function_order_) {
    const auto& function = functions_.at(name);
    compile_function(function, name, data_.children(function.source).subspan(3));
  }
}

}  // namespace parallax::compiler
