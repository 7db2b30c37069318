#include <fmt/core.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "compiler/base/codes/plans.h"
#include "compiler/interpreter/form_compiler.h"
#include "compiler/interpreter/lisp_macros.h"
#include "compiler/interpreter/variables.h"

namespace parallax::compiler {

namespace {

struct HandlerSource {
  std::vector<DatumId> classes;
  std::optional<DatumId> variable;
  FormItems body;
  DatumId source;
  bool takes_failure = true;  // false: calling it with the failure is an error
};

/// `class`, `(or class...)` or `(class...)`.
std::vector<DatumId> class_list(FormCompiler& c, DatumId datum) {
  if (c.data.head(datum) == "quote" && c.data[datum].count == 2)
    return class_list(c, c.data.children(datum)[1]);
  if (!c.data.is_list(datum)) return {datum};
  auto items = c.data.children(datum);
  if (c.data.head(datum) == "or") items = items.subspan(1);
  return {items.begin(), items.end()};
}

/// A handler runs on top of the failed body, in a frame of its own; `retry_exit` starts the body.
std::uint32_t compile_handler(FormCompiler& c, const HandlerSource& handler,
                              std::uint32_t retry_exit) {
  const auto scope = c.code.scope().size();
  c.code.show(c.code.named(BindingKind::kRetry, "", retry_exit));
  const auto unit = c.code.declare_unit("a failure handler", handler.source, 1);
  c.code.enter_unit(unit);
  if (handler.variable) bind_variable(c, *handler.variable, 0, handler.source);
  if (!handler.takes_failure) {
    c.always_fails(handler.source, "it is called with the failure and has no variable for it");
    c.code.drop(handler.source);
  }
  c.compile_body(c.skip_declarations(handler.body));
  close_variables(c, scope, 0, handler.source);
  c.code.leave_unit(PlanOp::kEndHandler, handler.source);
  return unit;
}

/// Does the clean-up or handler neither act nor look at anything, as one of log entries and events
/// only?
bool does_nothing(const PlanUnit& unit) {
  return std::all_of(unit.code.begin(), unit.code.end(), [](const PlanInstruction& instruction) {
    return instruction.op == PlanOp::kConstant || instruction.op == PlanOp::kPop ||
           instruction.op == PlanOp::kEndCleanup || instruction.op == PlanOp::kEndHandler;
  });
}

void handling(FormCompiler& c, DatumId form, const std::vector<HandlerSource>& handlers,
              FormItems body) {
  const auto block = c.code.open_block("nil");
  const auto start = c.code.open_exit();
  const auto retry = c.code.named(BindingKind::kRetry, "", start);
  // `retry` comes back here with a value, as every exit does.
  c.nil(form);
  c.code.set_exit(start);
  c.code.drop(form);
  std::vector<HandlerClause> table;
  std::vector<HandlerClause> opening;
  for (const auto& handler : handlers) {
    const auto unit = compile_handler(c, handler, start);
    for (const auto name : handler.classes) {
      const auto known = c.handled_class(name, does_nothing(c.code.code().units[unit]));
      if (!known) continue;
      // CRAM names the function of a clause by its class: of two with one name the last is called.
      for (auto& clause : table) {
        if (clause.failure_class == *known) clause.unit = unit;
      }
      table.push_back({*known, unit});
    }
  }
  for (const auto& clause : table) opening.push_back({clause.failure_class, clause.unit, true});
  table.insert(table.begin(), opening.begin(), opening.end());
  c.code.push_handlers(c.code.add_handlers(std::move(table)), form);
  c.code.show(retry);
  c.compile_body(body);
  c.code.pop_guard(form);
  c.code.close_block(block);
}

void form_with_failure_handling(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() < 2 || (!c.data.is_list(items[1]) && !c.data.is_nil(items[1]))) {
    return c.refuse(form, "expected a list of handlers and a body");
  }
  std::vector<HandlerSource> handlers;
  for (const auto clause : c.data.children(items[1])) {
    const auto parts = c.data.children(clause);
    const auto variable = parts.size() < 2 ? FormItems() : c.data.children(parts[1]);
    const bool shaped = parts.size() >= 2 &&
                        (c.data.is_list(parts[1]) || c.data.is_nil(parts[1])) &&
                        variable.size() < 2 && (variable.empty() || c.data.is_symbol(variable[0]));
    if (!shaped) {
      c.malformed(form, "a handler is (class (variable) form...), as in (plan-failure (e) ...)");
      continue;
    }
    HandlerSource handler{class_list(c, parts[0]), std::nullopt, parts.subspan(2), clause};
    handler.takes_failure = !variable.empty();
    if (handler.takes_failure) handler.variable = variable[0];
    handlers.push_back(std::move(handler));
  }
  handling(c, form, handlers, items.subspan(2));
}

/// (handle-failure CLASS (body...) handler...): the macro of CRAM's pick-and-place tutorial.
void form_handle_failure(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() < 3 || !c.data.is_list(items[2])) {
    return c.refuse(form, "expected a class, a list of forms and handler forms");
  }
  const HandlerSource handler{class_list(c, items[1]), std::nullopt, items.subspan(3), form};
  handling(c, form, {handler}, c.data.children(items[2]));
}

void form_with_retry_counters(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() < 2 || !c.data.is_list(items[1])) {
    return c.refuse(form, "expected a list of (counter count)");
  }
  const auto scope = c.code.scope().size();
  std::vector<LexicalBinding> bound;
  std::vector<DatumId> numbers;
  for (const auto counter : c.data.children(items[1])) {
    const auto parts = c.data.children(counter);
    if (parts.size() != 2 || !c.data.is_symbol(parts[0])) {
      c.malformed(form, "a counter is (name count)");
      continue;
    }
    c.compile(parts[1]);
    bound.push_back(
        c.code.named(BindingKind::kCounter, c.data.name(parts[0]), c.code.height() - 1));
    numbers.push_back(parts[1]);
  }
  for (std::size_t i = 0; i < bound.size(); ++i) {
    c.code.show(bound[i]);
    c.defined.counters[c.code.scope().back().serial] = {form, numbers[i]};
  }
  c.compile_body(items.subspan(2));
  close_variables(c, scope, static_cast<std::uint32_t>(bound.size()), form);
}

/// The counter that the form names. The macros of CRAM's with-retry-counters know its own counters
/// only, not those of a form around it.
const LexicalBinding* counter(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() < 2 || !c.data.is_symbol(items[1])) {
    c.malformed(form, "expected the name of a counter");
    return nullptr;
  }
  const auto* binding = c.code.lookup(BindingKind::kCounter, c.data.name(items[1]));
  if (binding == nullptr) {
    c.error(codes::kUnboundPlanVariable, items[1], c.data.name(items[1]))
        .note("counters are bound by `with-retry-counters`");
    return nullptr;
  }
  const auto& names = c.code.scope();
  const auto innermost = std::find_if(names.rbegin(), names.rend(), [](const LexicalBinding& name) {
    return name.kind == BindingKind::kCounter;
  });
  const auto own = c.defined.counters.at(binding->serial).form;
  const auto inner = c.defined.counters.at(innermost->serial).form;
  if (own == inner) return binding;
  c.error(codes::kUnsupportedPlanForm, form, c.form_name(form),
          fmt::format("`{}` is a counter of an outer `with-retry-counters`, which the inner one "
                      "does not know",
                      binding->name))
      .note(c.data.source(inner), "the inner one")
      .fix("bind the counters of both in one `with-retry-counters`");
  return nullptr;
}

void form_do_retry(FormCompiler& c, DatumId form, FormItems items) {
  const auto* found = counter(c, form, items);
  if (found == nullptr) return c.nil(form);
  const LexicalBinding place = *found;
  c.code.load(place, form);
  c.code.constant(c.values.number(Number(0)), form);
  c.code.builtin(">", 2, form);
  const auto to_else = c.code.jump(PlanOp::kJumpIfNil, form);
  c.code.load(place, form);
  c.code.builtin("1-", 1, form);
  c.code.store(place, form);
  c.code.drop(form);
  c.compile_body(items.subspan(2));
  c.otherwise_nil({to_else}, form);
}

void form_get_counter(FormCompiler& c, DatumId form, FormItems items) {
  const auto* found = counter(c, form, items);
  if (found == nullptr) return c.nil(form);
  c.code.load(*found, form);
}

/// How many data the form has, but no more than `limit`.
std::size_t size_of(const LispData& data, DatumId form, std::size_t limit) {
  std::size_t size = 0;
  std::vector<DatumId> open = {form};
  for (; !open.empty() && size < limit; ++size) {
    const auto items = data.children(open.back());
    open.pop_back();
    open.insert(open.end(), items.begin(), items.end());
  }
  return size;
}

/// The number is computed again, here: CRAM's macro puts the form of the number in its place.
void form_reset_counter(FormCompiler& c, DatumId form, FormItems items) {
  const auto* found = counter(c, form, items);
  if (found == nullptr) return c.nil(form);
  const LexicalBinding place = *found;
  const auto number = c.defined.counters.at(place.serial).number;
  if (c.resetting) return c.refuse(form, "the number of a counter cannot reset a counter");
  c.repeated += size_of(c.data, number, kMaxMacroData);
  if (c.repeated >= kMaxMacroData) {
    c.error(codes::kMacroLimit, form, kMaxMacroData, "data");
    return c.nil(form);
  }
  c.resetting = true;
  c.compile(number);
  c.resetting = false;
  c.code.store(place, form);
}

void form_retry(FormCompiler& c, DatumId form, FormItems /*items*/) {
  c.nil(form);
  const auto* target = c.code.lookup(BindingKind::kRetry, "");
  if (target == nullptr) {
    c.error(codes::kRetryOutsideHandler, form);
  } else if (c.code.in_other_task(*target)) {
    c.error(codes::kRetryOutsideHandler, form)
        .note(
            "a branch of `par` and a tagged form run in a task of their own, which a retry cannot "
            "leave; let it fail with a class that the handler retries on");
  } else {
    c.code.leave_to(*target, form);
  }
}

/// Leaves the failure with those of its slots that the plan reads; false: it reads none, and
/// nothing was written.
bool failure_with_slots(FormCompiler& c, DatumId form, FormItems items) {
  const auto is_read = [&](DatumId item) {
    return c.data.is_keyword(item) && c.defined.read_initargs.contains(c.data.name(item));
  };
  std::vector<std::size_t> read;
  for (std::size_t i = 2; i + 1 < items.size(); i += 2) {
    if (is_read(items[i])) read.push_back(i);
  }
  if (read.empty()) return false;
  const auto name = c.failure_class(items[1]);
  c.code.constant(c.values.symbol(name.value_or("plan-failure")), form);
  for (const auto i : read) {
    c.compile(items[i]);
    c.compile(items[i + 1]);
  }
  c.code.builtin("%failure", static_cast<std::uint32_t>(1 + 2 * read.size()), form);
  return true;
}

/// (fail 'class ...), (fail "text" ...), (fail), (fail e) with the variable of a handler.
void form_fail(FormCompiler& c, DatumId form, FormItems items) {
  c.check_no_perform(form);
  const bool lisp_error = c.form_name(form) == "error";
  const bool has_class = items.size() > 1 && !c.data.is_string(items[1]);
  const bool quoted = has_class && c.data.head(items[1]) == "quote";
  if (has_class && !quoted) {
    c.compile(items[1]);
    c.code.emit(PlanOp::kFailValue, 0, 0, form);
    return;
  }
  if (quoted && failure_with_slots(c, form, items)) {
    c.code.emit(PlanOp::kFailValue, 0, 0, form);
    return;
  }
  std::optional<std::string> name = lisp_error ? "simple-error" : "simple-plan-failure";
  if (has_class) name = c.failure_class(items[1]);
  c.code.fail(name.value_or("plan-failure"), form);
}

/// (signal 'class ...): CRAM ends the task with a plan failure or an error that nobody handles, so
/// it never returns there; of other conditions it would.
void form_signal(FormCompiler& c, DatumId form, FormItems items) {
  const bool quoted = items.size() > 1 && c.data.head(items[1]) == "quote";
  const auto name = quoted ? c.failure_class(items[1]) : std::nullopt;
  const auto& classes = c.code.code().classes;
  if (items.size() < 2 || c.data.is_string(items[1])) {
    c.unsupported(form, "a text is neither a plan failure nor an error");
    return c.nil(form);
  }
  if (name && !classes.is_a(*name, "plan-failure") && !classes.is_a(*name, "error")) {
    c.unsupported(form, "the class is neither a plan failure nor an error");
    return c.nil(form);
  }
  form_fail(c, form, items);
}

/// (make-condition 'class :slot value...): the failure, which `fail` raises.
void form_make_condition(FormCompiler& c, DatumId form, FormItems items) {
  c.check_no_perform(form);
  if (items.size() < 2 || c.data.head(items[1]) != "quote") {
    return c.refuse(form, "expected a quoted failure class");
  }
  if (failure_with_slots(c, form, items)) return;
  const auto name = c.failure_class(items[1]);
  c.code.constant(name ? c.values.failure(*name) : c.values.nil(), form);
}

/// (:no-error (variable...) form...): the values on top in the variables.
void bind_values(FormCompiler& c, FormItems clause, DatumId form) {
  const auto names = c.data.children(clause[1]);
  const auto count = static_cast<std::uint32_t>(names.size());
  const auto scope = c.code.scope().size();
  const auto first = c.code.height() - 1;
  c.code.emit(PlanOp::kUnpack, count, 0, form);
  c.code.adjust(static_cast<int>(count) - 1);
  for (std::uint32_t i = 0; i < count; ++i) {
    if (c.data.is_symbol(names[i])) {
      bind_variable(c, names[i], first + i, form);
    } else {
      c.malformed(form, "a variable is a name");
    }
  }
  c.compile_declared(clause.subspan(2));
  close_variables(c, scope, count, form);
}

/// (handler-case form (class (e) form...)...): unwinds first, then takes the first clause that
/// fits.
void form_handler_case(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() < 2) return c.refuse(form, "expected a form and clauses");
  std::vector<HandlerClause> table;
  std::vector<std::pair<std::uint32_t, FormItems>> clauses;
  FormItems no_error;
  for (const auto clause : items.subspan(2)) {
    const auto parts = c.data.children(clause);
    const bool after = parts.size() >= 2 && c.data.is_keyword(parts[0]) && no_error.empty() &&
                       c.data.name(parts[0]) == "no-error" &&
                       (c.data.is_list(parts[1]) || c.data.is_nil(parts[1]));
    if (after) {
      no_error = parts;
      continue;
    }
    const bool shaped = parts.size() >= 2 &&
                        (c.data.is_list(parts[1]) || c.data.is_nil(parts[1])) &&
                        c.data.children(parts[1]).size() <= 1 && !c.data.is_keyword(parts[0]);
    if (!shaped) {
      c.malformed(clause,
                  "a clause is (class (variable) form...) or (:no-error (variable...) form...)");
      continue;
    }
    const auto exit = c.code.open_exit();
    const auto unit = c.code.declare_unit("a failure handler", clause, 1);
    c.code.enter_unit(unit);
    c.code.load(0, clause);
    c.code.emit(PlanOp::kExit, 1, exit, clause);
    c.code.leave_unit(PlanOp::kEndHandler, clause);
    for (const auto name : class_list(c, parts[0])) {
      if (const auto known = c.handled_class(name)) table.push_back({*known, unit});
    }
    clauses.emplace_back(exit, parts);
  }
  c.code.push_handlers(c.code.add_handlers(std::move(table)), form);
  c.compile(items[1]);
  c.code.pop_guard(form);
  if (!no_error.empty()) bind_values(c, no_error, form);
  std::vector<std::size_t> to_end;
  for (const auto& [exit, parts] : clauses) {
    to_end.push_back(c.code.jump(PlanOp::kJump, form));
    c.code.set_exit(exit);  // with the failure on the stack
    const auto scope = c.code.scope().size();
    const auto variable = c.data.children(parts[1]);
    if (!variable.empty()) bind_top(c, variable[0], form);
    c.compile_body(c.skip_declarations(parts.subspan(2)));
    close_variables(c, scope, 1, form);
  }
  for (const auto jump : to_end) c.code.patch_jump(jump);
}

void form_unwind_protect(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() < 2) {
    return c.refuse(form, "expected a form and clean-up forms");
  }
  const auto unit = c.code.declare_unit("a clean-up", form, 0);
  c.code.enter_unit(unit);
  c.compile_body(items.subspan(2));
  c.code.leave_unit(PlanOp::kEndCleanup, form);
  if (does_nothing(c.code.code().units[unit])) return c.compile(items[1]);
  c.code.push_cleanup(unit, form);
  c.compile(items[1]);
  c.code.pop_guard(form);
  c.code.emit(PlanOp::kRunCleanup, unit, 0, form);
}

/// A handler that takes every plan failure to `exit` of the frame around it.
std::uint32_t catch_all(FormCompiler& c, std::uint32_t exit, DatumId source) {
  const auto unit = c.code.declare_unit("the next branch", source, 1);
  c.code.enter_unit(unit);
  c.nil(source);
  c.code.emit(PlanOp::kExit, 1, exit, source);
  c.code.leave_unit(PlanOp::kEndHandler, source);
  return c.code.add_handlers({{"plan-failure", unit}});
}

void form_try_in_order(FormCompiler& c, DatumId form, FormItems items) {
  const auto block = c.code.open_block("nil");
  std::vector<std::size_t> to_end;
  for (const auto branch : items.subspan(1)) {
    const auto next = c.code.open_exit();
    c.code.push_handlers(catch_all(c, next, branch), branch);
    c.compile(branch);
    c.code.pop_guard(branch);
    to_end.push_back(c.code.jump(PlanOp::kJump, branch));
    c.code.set_exit(next);
    c.code.drop(branch);
  }
  c.code.fail("composite-failure", form);
  for (const auto jump : to_end) c.code.patch_jump(jump);
  c.code.close_block(block);
}

/// (try-each-in-order (v list) body...): the next element after a failure.
void form_try_each(FormCompiler& c, DatumId form, FormItems items) {
  const auto head = items.size() < 2 ? FormItems() : c.data.children(items[1]);
  if (head.size() != 2 || !c.data.is_symbol(head[0])) {
    return c.refuse(form, "expected (variable list) and a body");
  }
  const auto block = c.code.open_block("nil");
  const LexicalBinding out = *c.code.lookup(BindingKind::kBlock, "nil");
  c.compile(head[1]);
  const auto loop = begin_list_loop(c, head[0], form);
  const auto next = c.code.open_exit();
  c.code.push_handlers(catch_all(c, next, form), form);
  c.compile_body(items.subspan(2));
  c.code.pop_guard(form);
  c.code.leave_to(out, form);
  c.code.set_exit(next);
  end_list_loop(c, loop, form);
  c.code.fail("composite-failure", form);
  close_variables(c, loop.scope, 2, form);
  c.code.close_block(block);
}

}  // namespace

void compile_reader(FormCompiler& c, DatumId form, const ConditionSlot& slot, DatumId condition) {
  c.compile(condition);
  std::vector<ValueId> initargs;
  for (const auto& name : slot.initargs) initargs.push_back(c.values.keyword(name));
  c.code.constant(c.values.list(initargs), form);
  if (slot.initial) {
    c.compile(*slot.initial);
  } else {
    c.nil(form);
  }
  c.code.builtin("%slot", 3, form);
}

std::span<const FormEntry> failure_forms() {
  static constexpr FormEntry kForms[] = {
      {"with-failure-handling", form_with_failure_handling},
      {"handle-failure", form_handle_failure},
      {"with-retry-counters", form_with_retry_counters},
      {"do-retry", form_do_retry},
      {"get-counter", form_get_counter},
      {"reset-counter", form_reset_counter},
      {"retry", form_retry},
      {"fail", form_fail},
      {"error", form_fail},
      {"signal", form_signal},
      {"make-condition", form_make_condition},
      {"handler-case", form_handler_case},
      {"unwind-protect", form_unwind_protect},
      {"try-in-order", form_try_in_order},
      {"try-each-in-order", form_try_each},
  };
  return kForms;
}

}  // namespace parallax::compiler
