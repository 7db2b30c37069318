#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "compiler/base/diagnostic_codes.h"
#include "compiler/plan/plan_builtins.h"
#include "compiler/plan/plan_compiler.h"

namespace parallax::compiler {

using base::DiagnosticCode;

std::optional<PlanCompiler::Callee> PlanCompiler::find_callee(std::string_view name) const {
  Callee callee;
  if (const auto* local = lookup(BindingKind::kFunction, name)) {
    callee.function = &local_functions_.at(local->index);
    callee.level = level_of(*local);
    return callee;
  }
  if (const auto found = functions_.find(name); found != functions_.end()) {
    callee.function = &found->second;
    return callee;
  }
  callee.builtin = find_builtin(name);
  if (!callee.builtin) return std::nullopt;
  return callee;
}

/// #'f, 'f or a lambda, as the argument of funcall and the mapping functions.
std::optional<PlanCompiler::Callee> PlanCompiler::resolve_callee(DatumId form, DatumId function) {
  const auto head = data_.head(function).value_or("");
  auto parts = data_.children(function);
  if ((head == "function" || head == "quote") && parts.size() == 2) {
    function = parts[1];
    parts = data_.children(function);
  }
  if (data_.is_symbol(function)) {
    if (auto callee = find_callee(data_.name(function))) return callee;
    unknown_form(function, data_.name(function));
    return std::nullopt;
  }
  if (data_.head(function) != "lambda" || parts.size() < 2) {
    unsupported(form, "the function must be named or written out, as #'f or a lambda");
    return std::nullopt;
  }
  const auto lambda = declare_function(function, "a lambda", parts[1]);
  compile_function(lambda, "", parts.subspan(2));
  Callee callee;
  callee.function = &(local_functions_[lambda.unit] = lambda);
  callee.level = 0;
  return callee;
}

/// `:test #'eq` and the like add nothing: equality of values is structural.
PlanCompiler::Items PlanCompiler::without_test_argument(DatumId form, Items arguments) {
  if (arguments.size() != 4 || !data_.is_keyword(arguments[2])) return arguments;
  const auto parts = data_.children(arguments[3]);
  const bool named = parts.size() == 2 && data_.is_symbol(parts[1]);
  const std::string_view test = named ? std::string_view(data_.name(parts[1])) : "";
  const bool equality = test == "eq" || test == "eql" || test == "equal" || test == "equalp";
  if (data_.name(arguments[2]) != "test" || !equality) {
    unsupported(form, "only `:test` with eq, eql or equal");
  }
  return arguments.subspan(0, 2);
}

void PlanCompiler::emit_call(const Callee& callee, std::uint32_t count, DatumId source) {
  if (callee.builtin) {
    const auto& builtin = plan_builtins()[*callee.builtin];
    if (count < builtin.min_arguments || count > builtin.max_arguments) {
      failed_ = true;
      sink_.error(
          DiagnosticCode::kPlanArguments, data_.source(source), builtin.name,
          fmt::format("takes {} {} arguments, not {}",
                      count < builtin.min_arguments ? "at least" : "at most",
                      count < builtin.min_arguments ? builtin.min_arguments : builtin.max_arguments,
                      count));
    }
    emit(PlanOp::kBuiltin, *callee.builtin, count, source);
    return adjust(1 - static_cast<int>(count));
  }
  const auto& parameters = callee.function->parameters;
  const auto optional = [](const Parameter& parameter) { return parameter.optional; };
  const auto required = parameters.size() - static_cast<std::size_t>(std::count_if(
                                                parameters.begin(), parameters.end(), optional));
  if (count < required || count > parameters.size()) {
    failed_ = true;
    sink_.error(DiagnosticCode::kPlanArguments, data_.source(source), form_name(source),
                fmt::format("the function takes {} arguments, not {}", required, count));
  }
  for (auto i = static_cast<std::size_t>(count); i < parameters.size(); ++i) {
    if (parameters[i].default_value) {
      compile(*parameters[i].default_value);
    } else {
      emit_constant(values_.nil(), source);
    }
  }
  const auto pushed = std::max(count, static_cast<std::uint32_t>(parameters.size()));
  const auto op = callee.level ? PlanOp::kCallLocal : PlanOp::kCall;
  emit(op, callee.function->unit, callee.level.value_or(0), source);
  adjust(1 - static_cast<int>(pushed));
}

/// Pushes one value for every parameter, in the order of the parameters.
bool PlanCompiler::push_arguments(DatumId form, std::string_view name, const Function& function,
                                  Items arguments) {
  const auto wrong = [&](std::string text) {
    failed_ = true;
    sink_.error(DiagnosticCode::kPlanArguments, data_.source(form), name, text)
        .note(data_.source(function.source), "defined here");
    return false;
  };
  const auto height = frame().height;
  std::size_t next = 0;
  for (const auto& parameter : function.parameters) {
    std::optional<DatumId> value;
    if (!parameter.keyword.empty()) {
      for (auto i = next; i + 1 < arguments.size(); i += 2) {
        const bool mine =
            data_.is_keyword(arguments[i]) && data_.name(arguments[i]) == parameter.keyword;
        if (mine && !value) value = arguments[i + 1];
      }
    } else if (next < arguments.size()) {
      value = arguments[next++];
    } else if (!parameter.optional) {
      frame().height = height;
      return wrong(fmt::format("no value for `{}`", parameter.name));
    }
    if (!value) value = parameter.default_value;
    if (value) {
      compile(*value);
    } else {
      emit_constant(values_.nil(), form);
    }
  }
  for (auto i = next; i < arguments.size(); i += 2) {
    const auto keyed = [&](const Parameter& parameter) {
      return data_.is_keyword(arguments[i]) && parameter.keyword == data_.name(arguments[i]);
    };
    const bool known = i + 1 < arguments.size() &&
                       std::any_of(function.parameters.begin(), function.parameters.end(), keyed);
    if (known) continue;
    frame().height = height;
    return wrong(fmt::format("unexpected argument `{}`", print_datum(data_, arguments[i])));
  }
  return true;
}

void PlanCompiler::call(DatumId form, std::string_view name, const Callee& callee,
                        Items arguments) {
  if (callee.function != nullptr) {
    if (!push_arguments(form, name, *callee.function, arguments)) {
      return emit_constant(values_.nil(), form);
    }
    const auto count = static_cast<std::uint32_t>(callee.function->parameters.size());
    return emit_call(callee, count, form);
  }
  if (name == "member" || name == "find" || name == "assoc" || name == "remove") {
    arguments = without_test_argument(form, arguments);
  }
  for (const auto argument : arguments) compile(argument);
  emit_call(callee, static_cast<std::uint32_t>(arguments.size()), form);
}

void PlanCompiler::form_funcall(DatumId form, Items items) {
  if (items.size() < 2) {
    malformed(form, "expected a function");
    return emit_constant(values_.nil(), form);
  }
  const auto callee = resolve_callee(form, items[1]);
  if (!callee) return emit_constant(values_.nil(), form);
  call(form, form_name(form), *callee, items.subspan(2));
}

/// (apply #'f a b list): the number of arguments is known only when the list is.
void PlanCompiler::form_apply(DatumId form, Items items) {
  if (items.size() < 3) {
    malformed(form, "expected a function and a list of arguments");
    return emit_constant(values_.nil(), form);
  }
  const auto callee = resolve_callee(form, items[1]);
  for (const auto item : items.subspan(2, items.size() - 3)) {
    compile(item);
    emit_builtin("list", 1, item);
  }
  compile(items.back());
  emit_builtin("append", static_cast<std::uint32_t>(items.size() - 2), form);
  if (!callee) return;
  emit(PlanOp::kApply, 0, 0, form);
  if (callee->builtin) {
    emit(PlanOp::kBuiltin, *callee->builtin, 0, form);
    return;
  }
  const auto& parameters = callee->function->parameters;
  const auto optional = [](const Parameter& parameter) { return parameter.optional; };
  if (std::any_of(parameters.begin(), parameters.end(), optional)) {
    unsupported(form, "a function with optional parameters cannot be applied to a list");
  }
  emit(callee->level ? PlanOp::kCallLocal : PlanOp::kCall, callee->function->unit,
       callee->level.value_or(0), form);
}

/// flet and labels: local functions, which see the variables around them.
void PlanCompiler::form_flet(DatumId form, Items items) {
  if (items.size() < 2 || !data_.is_list(items[1])) {
    malformed(form, "expected a list of functions");
    return emit_constant(values_.nil(), form);
  }
  const auto scope = scope_.size();
  const auto depth = static_cast<std::uint32_t>(frames_.size() - 1);
  std::vector<std::pair<Function, Items>> declared;
  std::vector<LexicalBinding> bound;
  for (const auto definition : data_.children(items[1])) {
    const auto parts = data_.children(definition);
    if (parts.size() < 2 || !data_.is_symbol(parts[0])) {
      malformed(form, "a function is (name parameters form...)");
      continue;
    }
    auto function = declare_function(definition, data_.name(parts[0]), parts[1]);
    bound.push_back({BindingKind::kFunction, data_.name(parts[0]), depth, function.unit});
    local_functions_[function.unit] = function;
    declared.emplace_back(std::move(function), parts.subspan(2));
  }
  const bool recursive = form_name(form) == "labels";
  if (recursive) scope_.insert(scope_.end(), bound.begin(), bound.end());
  for (std::size_t i = 0; i < declared.size(); ++i) {
    compile_function(declared[i].first, bound[i].name, declared[i].second);
  }
  if (!recursive) scope_.insert(scope_.end(), bound.begin(), bound.end());
  compile_body(skip_declarations(items.subspan(2)));
  scope_.resize(scope);
}

}  // namespace parallax::compiler
