#include <fmt/core.h>

#include <utility>

#include "compiler/base/diagnostic_codes.h"
#include "compiler/base/suggest.h"
#include "compiler/plan/plan_compiler.h"

namespace parallax::compiler {

using base::DiagnosticCode;

/// The class that a symbol, perhaps quoted, names; reports CPL041.
std::optional<std::string> PlanCompiler::failure_class(DatumId datum) {
  if (data_.head(datum) == "quote" && data_[datum].count == 2) datum = data_.children(datum)[1];
  if (!data_.is_symbol(datum)) {
    malformed(datum, "expected the name of a failure class");
    return std::nullopt;
  }
  if (auto known = code_.classes.canonical(data_.name(datum))) return known;
  failed_ = true;
  const auto names = code_.classes.names();
  auto error =
      sink_.error(DiagnosticCode::kUnknownFailureClass, data_.source(datum), data_.name(datum));
  if (const auto near = base::nearest_name(data_.name(datum), names, 4)) {
    error.fix(fmt::format("replace `{}` with `{}`", data_.name(datum), *near));
  }
  return std::nullopt;
}

/// `class`, `(or class...)` or `(class...)`.
std::vector<DatumId> PlanCompiler::class_list(DatumId datum) {
  if (data_.head(datum) == "quote" && data_[datum].count == 2)
    return class_list(data_.children(datum)[1]);
  if (!data_.is_list(datum)) return {datum};
  auto items = data_.children(datum);
  if (data_.head(datum) == "or") items = items.subspan(1);
  return {items.begin(), items.end()};
}

/// A handler runs on top of the failed body, in a frame of its own; `retry_exit` starts the body.
std::uint32_t PlanCompiler::compile_handler(const HandlerSource& handler,
                                            std::uint32_t retry_exit) {
  const auto scope = scope_.size();
  const auto depth = static_cast<std::uint32_t>(frames_.size() - 1);
  scope_.push_back({BindingKind::kRetry, "", depth, retry_exit});
  const auto unit = declare_unit("a failure handler", handler.source, 1);
  enter_unit(unit);
  if (handler.variable) {
    scope_.push_back({BindingKind::kVariable, data_.name(*handler.variable), depth + 1, 0});
  }
  compile_body(skip_declarations(handler.body));
  leave_unit(PlanOp::kEndHandler, handler.source);
  scope_.resize(scope);
  return unit;
}

void PlanCompiler::handling(DatumId form, const std::vector<HandlerSource>& handlers, Items body) {
  const auto block = open_block("nil");
  const auto start = static_cast<std::uint32_t>(code_.exits.size());
  code_.exits.push_back({0, frame().height, frame().guards});
  // `retry` comes back here with a value, as every exit does.
  emit_constant(values_.nil(), form);
  code_.exits[start].pc = here();
  emit(PlanOp::kPop, 0, 0, form);
  adjust(-1);
  std::vector<HandlerClause> table;
  for (const auto& handler : handlers) {
    const auto unit = compile_handler(handler, start);
    for (const auto name : handler.classes) {
      if (const auto known = failure_class(name)) table.push_back({*known, unit});
    }
  }
  const auto index = static_cast<std::uint32_t>(code_.handlers.size());
  code_.handlers.push_back(std::move(table));
  emit(PlanOp::kPushHandlers, index, 0, form);
  ++frame().guards;
  compile_body(body);
  emit(PlanOp::kPopGuard, 0, 0, form);
  --frame().guards;
  close_block(block);
}

void PlanCompiler::form_with_failure_handling(DatumId form, Items items) {
  if (items.size() < 2 || (!data_.is_list(items[1]) && !data_.is_nil(items[1]))) {
    malformed(form, "expected a list of handlers and a body");
    return emit_constant(values_.nil(), form);
  }
  std::vector<HandlerSource> handlers;
  for (const auto clause : data_.children(items[1])) {
    const auto parts = data_.children(clause);
    const auto variable = parts.size() < 2 ? Items() : data_.children(parts[1]);
    const bool shaped = parts.size() >= 2 && (data_.is_list(parts[1]) || data_.is_nil(parts[1])) &&
                        variable.size() <= 1 && (variable.empty() || data_.is_symbol(variable[0]));
    if (!shaped) {
      malformed(form, "a handler is (class (variable) form...)");
      continue;
    }
    HandlerSource handler{class_list(parts[0]), std::nullopt, parts.subspan(2), clause};
    if (!variable.empty()) handler.variable = variable[0];
    handlers.push_back(std::move(handler));
  }
  handling(form, handlers, items.subspan(2));
}

/// (handle-failure CLASS (body...) handler...): the macro of CRAM's pick-and-place tutorial.
void PlanCompiler::form_handle_failure(DatumId form, Items items) {
  if (items.size() < 3 || !data_.is_list(items[2])) {
    malformed(form, "expected a class, a list of forms and handler forms");
    return emit_constant(values_.nil(), form);
  }
  const HandlerSource handler{class_list(items[1]), std::nullopt, items.subspan(3), form};
  handling(form, {handler}, data_.children(items[2]));
}

void PlanCompiler::form_with_retry_counters(DatumId form, Items items) {
  if (items.size() < 2 || !data_.is_list(items[1])) {
    malformed(form, "expected a list of (counter count)");
    return emit_constant(values_.nil(), form);
  }
  const auto scope = scope_.size();
  std::uint32_t count = 0;
  std::vector<LexicalBinding> bound;
  const auto depth = static_cast<std::uint32_t>(frames_.size() - 1);
  for (const auto counter : data_.children(items[1])) {
    const auto parts = data_.children(counter);
    if (parts.size() != 2 || !data_.is_symbol(parts[0])) {
      malformed(form, "a counter is (name count)");
      continue;
    }
    compile(parts[1]);  // the current count, and below it the one that reset-counter restores
    bound.push_back({BindingKind::kCounter, data_.name(parts[0]), depth, frame().height});
    emit_local(PlanOp::kLoad, frame().height - 1, counter);
    count += 2;
  }
  scope_.insert(scope_.end(), bound.begin(), bound.end());
  compile_body(items.subspan(2));
  emit(PlanOp::kSqueeze, count, 0, form);
  adjust(-static_cast<int>(count));
  scope_.resize(scope);
}

const PlanCompiler::LexicalBinding* PlanCompiler::counter(DatumId form, Items items) {
  if (items.size() < 2 || !data_.is_symbol(items[1])) {
    malformed(form, "expected the name of a counter");
    return nullptr;
  }
  if (const auto* binding = lookup(BindingKind::kCounter, data_.name(items[1]))) return binding;
  failed_ = true;
  sink_.error(DiagnosticCode::kUnboundPlanVariable, data_.source(items[1]), data_.name(items[1]))
      .note("counters are bound by `with-retry-counters`");
  return nullptr;
}

void PlanCompiler::form_do_retry(DatumId form, Items items) {
  const auto* found = counter(form, items);
  if (found == nullptr) return emit_constant(values_.nil(), form);
  const LexicalBinding place = *found;
  emit_variable(PlanOp::kLoad, place, form);
  emit_constant(values_.number(Number(0)), form);
  emit_builtin(">", 2, form);
  const auto to_else = emit_jump(PlanOp::kJumpIfNil, form);
  emit_variable(PlanOp::kLoad, place, form);
  emit_builtin("1-", 1, form);
  emit_variable(PlanOp::kStore, place, form);
  emit(PlanOp::kPop, 0, 0, form);
  adjust(-1);
  compile_body(items.subspan(2));
  const auto to_end = emit_jump(PlanOp::kJump, form);
  adjust(-1);
  patch_jump(to_else);
  emit_constant(values_.nil(), form);
  patch_jump(to_end);
}

void PlanCompiler::form_get_counter(DatumId form, Items items) {
  const auto* found = counter(form, items);
  if (found == nullptr) return emit_constant(values_.nil(), form);
  emit_variable(PlanOp::kLoad, *found, form);
}

void PlanCompiler::form_reset_counter(DatumId form, Items items) {
  const auto* found = counter(form, items);
  if (found == nullptr) return emit_constant(values_.nil(), form);
  const LexicalBinding place = *found;
  LexicalBinding initial = place;
  --initial.index;
  emit_variable(PlanOp::kLoad, initial, form);
  emit_variable(PlanOp::kStore, place, form);
}

void PlanCompiler::form_retry(DatumId form, Items /*items*/) {
  emit_constant(values_.nil(), form);
  if (const auto* target = lookup(BindingKind::kRetry, "")) return emit_exit(*target, form);
  failed_ = true;
  sink_.error(DiagnosticCode::kRetryOutsideHandler, data_.source(form));
}

/// (fail 'class ...), (fail "text" ...), (fail), (fail e) with the variable of a handler.
void PlanCompiler::form_fail(DatumId form, Items items) {
  check_no_perform(form);
  const bool has_class = items.size() > 1 && !data_.is_string(items[1]);
  if (has_class && data_.is_symbol(items[1])) {
    compile(items[1]);
    emit(PlanOp::kFailValue, 0, 0, form);
    return;
  }
  std::optional<std::string> name = "simple-plan-failure";
  if (has_class) name = failure_class(items[1]);
  emit(PlanOp::kFail, string_index(name.value_or("plan-failure")), 0, form);
  adjust(1);
}

void PlanCompiler::form_unwind_protect(DatumId form, Items items) {
  if (items.size() < 2) {
    malformed(form, "expected a form and clean-up forms");
    return emit_constant(values_.nil(), form);
  }
  const auto unit = declare_unit("a clean-up", form, 0);
  enter_unit(unit);
  compile_body(items.subspan(2));
  leave_unit(PlanOp::kEndCleanup, form);
  emit(PlanOp::kPushCleanup, unit, 0, form);
  ++frame().guards;
  compile(items[1]);
  emit(PlanOp::kPopGuard, 0, 0, form);
  --frame().guards;
  emit(PlanOp::kRunCleanup, unit, 0, form);
}

/// A handler that takes every plan failure to `exit` of the frame around it.
std::uint32_t PlanCompiler::catch_all(std::uint32_t exit, DatumId source) {
  const auto unit = declare_unit("the next branch", source, 1);
  enter_unit(unit);
  emit_constant(values_.nil(), source);
  emit(PlanOp::kExit, 1, exit, source);
  leave_unit(PlanOp::kEndHandler, source);
  code_.handlers.push_back({{"plan-failure", unit}});
  return static_cast<std::uint32_t>(code_.handlers.size() - 1);
}

void PlanCompiler::form_try_in_order(DatumId form, Items items) {
  std::vector<std::size_t> to_end;
  for (const auto branch : items.subspan(1)) {
    const auto next = static_cast<std::uint32_t>(code_.exits.size());
    code_.exits.push_back({0, frame().height, frame().guards});
    emit(PlanOp::kPushHandlers, catch_all(next, branch), 0, branch);
    ++frame().guards;
    compile(branch);
    emit(PlanOp::kPopGuard, 0, 0, branch);
    --frame().guards;
    to_end.push_back(emit_jump(PlanOp::kJump, branch));
    code_.exits[next].pc = here();
    emit(PlanOp::kPop, 0, 0, branch);
    adjust(-1);
  }
  emit(PlanOp::kFail, string_index("composite-failure"), 0, form);
  adjust(1);
  for (const auto jump : to_end) patch_jump(jump);
}

}  // namespace parallax::compiler
