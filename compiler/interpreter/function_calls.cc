#include "compiler/interpreter/function_calls.h"

#include <fmt/core.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>

#include "compiler/base/codes/plans.h"
#include "compiler/builtins/plan_builtins.h"
#include "compiler/interpreter/form_compiler.h"

namespace parallax::compiler {

namespace {

/// A value for a parameter that the call leaves out.
void push_default(FormCompiler& c, const PlanParameter& parameter, DatumId source) {
  if (parameter.computed) {
    c.code.constant(c.values.not_given(), source);
  } else if (parameter.default_value) {
    c.compile(*parameter.default_value);
  } else {
    c.nil(source);
  }
}

/// Are the arguments to be sorted while the plan runs? So where keywords follow `&rest`, and where
/// they stand in another order than the parameters: arguments are computed in written order.
bool binds_late(const FormCompiler& c, const PlanFunction& function, FormItems arguments) {
  const auto& parameters = function.parameters;
  const auto is_key = [](const PlanParameter& parameter) { return !parameter.keyword.empty(); };
  const auto key = std::find_if(parameters.begin(), parameters.end(), is_key);
  if (key == parameters.end()) return false;
  const auto rest = [](const PlanParameter& parameter) { return parameter.rest; };
  if (std::any_of(parameters.begin(), parameters.end(), rest)) return true;
  auto last = key;
  const auto others =
      std::min(arguments.size(), static_cast<std::size_t>(key - parameters.begin()));
  arguments = arguments.subspan(others);
  for (std::size_t i = 0; i + 1 < arguments.size(); i += 2) {
    if (!c.data.is_keyword(arguments[i])) continue;
    const auto mine =
        std::find_if(parameters.begin(), parameters.end(), [&](const auto& parameter) {
          return is_key(parameter) && parameter.keyword == c.data.name(arguments[i]);
        });
    if (mine == parameters.end()) continue;
    if (mine < last) return true;
    last = mine;
  }
  return false;
}

/// Pushes one value for every parameter, in the order of the parameters.
bool push_arguments(FormCompiler& c, DatumId form, std::string_view name,
                    const PlanFunction& function, FormItems arguments) {
  const auto wrong = [&](std::string text) {
    c.error(codes::kPlanArguments, form, name, text)
        .note(c.data.source(function.source), "defined here");
    return false;
  };
  const auto height = c.code.height();
  std::size_t next = 0;
  for (const auto& parameter : function.parameters) {
    std::optional<DatumId> value;
    if (parameter.rest) {
      const auto others = arguments.subspan(next);
      for (const auto other : others) c.compile(other);
      c.code.builtin("list", static_cast<std::uint32_t>(others.size()), form);
      next = arguments.size();
      continue;
    }
    if (!parameter.keyword.empty()) {
      for (auto i = next; i + 1 < arguments.size(); i += 2) {
        const bool mine =
            c.data.is_keyword(arguments[i]) && c.data.name(arguments[i]) == parameter.keyword;
        if (mine && !value) value = arguments[i + 1];
      }
    } else if (next < arguments.size()) {
      value = arguments[next++];
    } else if (!parameter.optional) {
      c.code.set_height(height);
      return wrong(fmt::format("no value for `{}`", parameter.name));
    }
    if (value) {
      c.compile(*value);
    } else {
      push_default(c, parameter, form);
    }
  }
  for (auto i = next; i < arguments.size(); i += 2) {
    const auto keyed = [&](const PlanParameter& parameter) {
      return c.data.is_keyword(arguments[i]) && parameter.keyword == c.data.name(arguments[i]);
    };
    const bool known = i + 1 < arguments.size() &&
                       std::any_of(function.parameters.begin(), function.parameters.end(), keyed);
    if (known) continue;
    if (function.other_keys && i + 1 < arguments.size() && c.data.is_keyword(arguments[i])) {
      c.compile(arguments[i + 1]);  // evaluated, and of no further use
      c.code.drop(form);
      continue;
    }
    c.code.set_height(height);
    return wrong(fmt::format("unexpected argument `{}`", print_datum(c.data, arguments[i])));
  }
  return true;
}

/// A function that is named or written out, as #'f, 'f, a lambda or #'(lambda ...).
std::optional<Callee> named_callee(FormCompiler& c, DatumId function) {
  const auto head = c.data.head(function).value_or("");
  auto parts = c.data.children(function);
  if ((head == "function" || head == "quote") && parts.size() == 2) {
    function = parts[1];
    parts = c.data.children(function);
    if (c.data.is_symbol(function)) {
      return head == "quote" ? find_global_callee(c, function) : find_callee(c, function);
    }
    if (head == "quote") return std::nullopt;
  }
  if (c.data.head(function) != "lambda" || parts.size() < 2) return std::nullopt;
  const auto lambda = declare_function(c, function, "a lambda", parts[1]);
  compile_function(c, lambda, "", parts.subspan(2));
  Callee callee;
  callee.function = &(c.defined.local_functions[lambda.unit] = lambda);
  callee.level = 0;
  return callee;
}

/// Pushes a function of the plan as a value that is called here.
void callee_value(FormCompiler& c, const Callee& callee, DatumId source) {
  if (callee.local) return c.code.local_function_value(*callee.local, source);
  FunctionTemplate made;
  made.unit = callee.function->unit;
  made.level = callee.level;
  if (callee.level) made.shared = {{0, c.code.height()}};
  c.code.function_value(std::move(made), source);
}

/// 'f of a name that means no function: said here, also on paths that no execution takes.
void check_quoted_name(FormCompiler& c, DatumId function) {
  const auto parts = c.data.children(function);
  if (c.data.head(function) != "quote" || parts.size() != 2 || !c.data.is_symbol(parts[1])) return;
  c.unknown_form(function, parts[1]);
}

void form_funcall(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() < 2) {
    return c.refuse(form, "expected a function");
  }
  if (const auto callee = named_callee(c, items[1])) {
    return compile_call(c, form, c.form_name(form), *callee, items.subspan(2));
  }
  check_quoted_name(c, items[1]);
  c.compile(items[1]);
  for (const auto item : items.subspan(2)) c.compile(item);
  c.code.call_value(static_cast<std::uint32_t>(items.size() - 2), false, form);
}

/// (apply #'f a b list): the number of arguments is known only when the list is.
void form_apply(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() < 3) {
    return c.refuse(form, "expected a function and a list of arguments");
  }
  for (const auto item : items.subspan(1)) c.compile(item);
  c.code.call_value(static_cast<std::uint32_t>(items.size() - 2), true, form);
}

/// (multiple-value-call f form...): with all values of all forms.
void form_multiple_value_call(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() < 2) return c.refuse(form, "expected a function");
  c.compile(items[1]);
  for (const auto item : items.subspan(2)) {
    c.compile(item);
    c.code.emit(PlanOp::kListValues, 0, 0, item);
  }
  c.code.builtin("append", static_cast<std::uint32_t>(items.size() - 2), form);
  c.code.call_value(1, true, form);
}

}  // namespace

std::optional<Callee> find_global_callee(const FormCompiler& c, DatumId symbol) {
  Callee callee;
  if (const auto found = c.defined.functions.find(c.data.key(symbol));
      found != c.defined.functions.end()) {
    callee.function = &found->second;
    return callee;
  }
  callee.builtin = find_builtin(c.data.name(symbol));
  if (!callee.builtin) return std::nullopt;
  return callee;
}

std::optional<Callee> find_callee(const FormCompiler& c, DatumId symbol) {
  const auto* local = c.code.lookup(BindingKind::kFunction, c.data.name(symbol));
  if (local == nullptr) return find_global_callee(c, symbol);
  Callee callee;
  callee.function = &c.defined.local_functions.at(local->index);
  callee.level = c.code.level_of(*local);
  callee.local = *local;
  return callee;
}

FunctionArgument prepare_function(FormCompiler& c, DatumId form, DatumId function) {
  FunctionArgument out;
  out.callee = named_callee(c, function);
  const auto* named = out.callee ? out.callee->function : nullptr;
  const bool sorts =
      named != nullptr && std::any_of(named->parameters.begin(), named->parameters.end(),
                                      [](const PlanParameter& parameter) {
                                        return parameter.rest || !parameter.keyword.empty();
                                      });
  if (sorts) {
    callee_value(c, *out.callee, form);
    out.callee.reset();
  } else if (out.callee) {
    c.nil(form);
  } else {
    check_quoted_name(c, function);
    c.compile(function);
  }
  out.place = c.code.height() - 1;
  return out;
}

void push_prepared(FormCompiler& c, const FunctionArgument& function, DatumId source) {
  if (!function.callee) c.code.load(function.place, source);
}

void call_prepared(FormCompiler& c, const FunctionArgument& function, std::uint32_t count,
                   DatumId source) {
  if (function.callee) return emit_call(c, *function.callee, count, source);
  c.code.call_value(count, false, source);
}

namespace {

bool gives_values(std::string_view builtin) {
  return builtin == "floor" || builtin == "ceiling" || builtin == "truncate" ||
         builtin == "round" || builtin == "gethash";
}

/// `pushed` values are on the stack, one for each parameter.
void enter_function(FormCompiler& c, const Callee& callee, std::uint32_t pushed, DatumId source) {
  const auto op = callee.level ? PlanOp::kCallLocal : PlanOp::kCall;
  if (callee.local) c.code.note_local_call(*callee.local);
  c.code.emit(op, callee.function->unit, callee.level.value_or(0), source);
  c.code.adjust(1 - static_cast<int>(pushed));
}

}  // namespace

void emit_call(FormCompiler& c, const Callee& callee, std::uint32_t count, DatumId source) {
  if (callee.builtin) {
    const auto& builtin = plan_builtins()[*callee.builtin];
    if (count < builtin.min_arguments || count > builtin.max_arguments) {
      c.error(
          codes::kPlanArguments, source, builtin.name,
          fmt::format("takes {} {} arguments, not {}",
                      count < builtin.min_arguments ? "at least" : "at most",
                      count < builtin.min_arguments ? builtin.min_arguments : builtin.max_arguments,
                      count));
    }
    c.code.emit(PlanOp::kBuiltin, *callee.builtin, count, source);
    if (gives_values(builtin.name)) c.code.code().multiple_values = true;
    return c.code.adjust(1 - static_cast<int>(count));
  }
  const auto& parameters = callee.function->parameters;
  const auto optional = [](const PlanParameter& parameter) {
    return parameter.optional || parameter.rest;
  };
  const auto required = parameters.size() - static_cast<std::size_t>(std::count_if(
                                                parameters.begin(), parameters.end(), optional));
  if (count < required || count > parameters.size()) {
    c.error(codes::kPlanArguments, source, c.form_name(source),
            fmt::format("the function takes {} arguments, not {}", required, count));
  }
  for (auto i = static_cast<std::size_t>(count); i < parameters.size(); ++i) {
    if (parameters[i].rest) {
      c.nil(source);
    } else {
      push_default(c, parameters[i], source);
    }
  }
  if (count > 0 && count == parameters.size() && parameters.back().rest) {
    c.code.builtin("list", 1, source);
  }
  enter_function(c, callee, std::max(count, static_cast<std::uint32_t>(parameters.size())), source);
}

namespace {

/// Functions of Lisp that may change the list that they are given: ours leave it as it was. A list
/// that a call has just made is seen by nobody else.
void note_changed_list(FormCompiler& c, DatumId form, std::string_view name, FormItems arguments) {
  struct Changing {
    std::string_view name;
    std::size_t list = 0;  // which argument
  };
  static constexpr Changing kChanging[] = {
      {"sort"},      {"stable-sort"},  {"nreverse"},         {"nconc"},
      {"delete", 1}, {"delete-if", 1}, {"delete-if-not", 1}, {"delete-duplicates"},
  };
  static constexpr std::string_view kFresh[] = {"list",   "copy-list", "mapcar",    "remove",
                                                "loop",   "reverse",   "remove-if", "remove-if-not",
                                                "mapcan", "subseq"};
  const auto* known = std::find_if(std::begin(kChanging), std::end(kChanging),
                                   [&](const Changing& one) { return one.name == name; });
  if (known == std::end(kChanging) || arguments.size() <= known->list || c.data.in_library(form)) {
    return;
  }
  const auto head = c.data.head(arguments[known->list]).value_or("");
  if (std::find(std::begin(kFresh), std::end(kFresh), head) != std::end(kFresh)) return;
  c.code.code().gaps.push_back(
      {fmt::format("what `{}` leaves of its list", name), form, GapKind::kMeaning});
}

}  // namespace

void compile_call(FormCompiler& c, DatumId form, std::string_view name, const Callee& callee,
                  FormItems arguments) {
  // Without keywords the built-in of that name does the same.
  const bool ours = callee.function != nullptr && c.data.in_library(callee.function->source);
  if (const auto known = ours ? find_builtin(name) : std::nullopt;
      known && plan_builtins()[*known].max_arguments >= arguments.size()) {
    Callee builtin;
    builtin.builtin = known;
    return compile_call(c, form, name, builtin, arguments);
  }
  if (ours || callee.builtin) note_changed_list(c, form, name, arguments);
  if (callee.function != nullptr) {
    if (callee.function->top_level && c.in_function) {
      for (const auto argument : arguments) {
        c.compile(argument);
        c.code.drop(argument);
      }
      return c.always_fails(form,
                            "a `def-top-level-cram-function` does not run in another; make it a "
                            "`def-cram-function`");
    }
    if (binds_late(c, *callee.function, arguments)) {
      callee_value(c, callee, form);
      for (const auto argument : arguments) c.compile(argument);
      return c.code.call_value(static_cast<std::uint32_t>(arguments.size()), false, form);
    }
    if (!push_arguments(c, form, name, *callee.function, arguments)) {
      return c.nil(form);
    }
    const auto count = static_cast<std::uint32_t>(callee.function->parameters.size());
    return enter_function(c, callee, count, form);
  }
  for (const auto argument : arguments) c.compile(argument);
  emit_call(c, callee, static_cast<std::uint32_t>(arguments.size()), form);
}

void compile_lambda_call(FormCompiler& c, DatumId form, FormItems items) {
  const auto callee = named_callee(c, items.front());
  if (!callee) return c.refuse(form, "expected a lambda with parameters");
  compile_call(c, form, "a lambda", *callee, items.subspan(1));
}

std::span<const FormEntry> call_forms() {
  static constexpr FormEntry kForms[] = {
      {"funcall", form_funcall},
      {"apply", form_apply},
      {"multiple-value-call", form_multiple_value_call},
  };
  return kForms;
}

}  // namespace parallax::compiler
