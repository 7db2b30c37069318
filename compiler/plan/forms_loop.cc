#include <fmt/core.h>

#include <utility>

#include "compiler/plan/loop_clauses.h"
#include "compiler/plan/plan_compiler.h"

namespace parallax::compiler {

/// Opens a loop over the static list on top: two variables on the stack, the rest of the list and
/// its current element. The body follows and leaves one value, which end_list_loop drops.
PlanCompiler::ListLoop PlanCompiler::begin_list_loop(std::string_view variable, DatumId source) {
  ListLoop loop;
  emit(PlanOp::kExpectList, 0, 0, source);
  loop.list = frame().height - 1;
  emit_constant(values_.nil(), source);
  loop.item = frame().height - 1;
  bind_variable(variable);
  loop.top = here();
  emit_local(PlanOp::kLoad, loop.list, source);
  loop.end_jump = emit_jump(PlanOp::kJumpIfNil, source);
  emit_local(PlanOp::kLoad, loop.list, source);
  emit_builtin("car", 1, source);
  store_and_drop(loop.item, source);
  emit_local(PlanOp::kLoad, loop.list, source);
  emit_builtin("cdr", 1, source);
  store_and_drop(loop.list, source);
  return loop;
}

/// Closes the loop; its two variables are still there, the second one nil.
void PlanCompiler::end_list_loop(const ListLoop& loop, DatumId source) {
  emit(PlanOp::kPop, 0, 0, source);
  adjust(-1);
  emit(PlanOp::kJump, loop.top, 0, source);
  patch_jump(loop.end_jump);
  emit_constant(values_.nil(), source);
  store_and_drop(loop.item, source);
}

void PlanCompiler::form_dolist(DatumId form, Items items) {
  const auto head = items.size() < 2 ? Items() : data_.children(items[1]);
  if (head.size() < 2 || head.size() > 3 || !data_.is_symbol(head[0])) {
    malformed(form, "expected (variable list) and a body");
    return emit_constant(values_.nil(), form);
  }
  const auto block = open_block("nil");
  compile(head[1]);
  const auto loop = begin_list_loop(data_.name(head[0]), form);
  compile_body(skip_declarations(items.subspan(2)));
  end_list_loop(loop, form);
  if (head.size() == 3) {
    compile(head[2]);
  } else {
    emit_constant(values_.nil(), form);
  }
  emit(PlanOp::kSqueeze, 2, 0, form);
  adjust(-2);
  close_block(block);
}

void PlanCompiler::form_dotimes(DatumId form, Items items) {
  const auto head = items.size() < 2 ? Items() : data_.children(items[1]);
  if (head.size() < 2 || head.size() > 3 || !data_.is_symbol(head[0])) {
    malformed(form, "expected (variable count) and a body");
    return emit_constant(values_.nil(), form);
  }
  const auto block = open_block("nil");
  const auto scope = scope_.size();
  compile(head[1]);
  const auto count = frame().height - 1;
  emit_constant(values_.number(Number(0)), form);
  const auto index = frame().height - 1;
  bind_variable(data_.name(head[0]));
  const auto top = here();
  emit_local(PlanOp::kLoad, index, form);
  emit_local(PlanOp::kLoad, count, form);
  emit_builtin("<", 2, form);
  const auto to_end = emit_jump(PlanOp::kJumpIfNil, form);
  compile_body(skip_declarations(items.subspan(2)));
  emit(PlanOp::kPop, 0, 0, form);
  adjust(-1);
  emit_local(PlanOp::kLoad, index, form);
  emit_builtin("1+", 1, form);
  store_and_drop(index, form);
  emit(PlanOp::kJump, top, 0, form);
  patch_jump(to_end);
  if (head.size() == 3) {
    compile(head[2]);
  } else {
    emit_constant(values_.nil(), form);
  }
  emit(PlanOp::kSqueeze, 2, 0, form);
  adjust(-2);
  scope_.resize(scope);
  close_block(block);
}

/// mapcar, mapc, every and some over one static list.
void PlanCompiler::form_map(DatumId form, Items items) {
  if (items.size() != 3) {
    malformed(form, "expected a function and one list");
    return emit_constant(values_.nil(), form);
  }
  const std::string name = form_name(form);
  const auto block = open_block("");
  const auto scope = scope_.size();
  const auto result = frame().height;
  if (name != "mapc") emit_constant(name == "every" ? values_.truth() : values_.nil(), form);
  compile(items[2]);
  if (name == "mapc") emit_local(PlanOp::kLoad, result, form);  // the list is mapc's value
  const auto loop = begin_list_loop("", form);
  emit_local(PlanOp::kLoad, loop.item, form);
  if (const auto callee = resolve_callee(form, items[1])) emit_call(*callee, 1, form);
  if (name == "mapcar") {
    emit_local(PlanOp::kLoad, result, form);
    emit_builtin("cons", 2, form);
    emit_local(PlanOp::kStore, result, form);
  } else if (name == "every" || name == "some") {
    const auto value = frame().height - 1;
    emit_local(PlanOp::kLoad, value, form);
    if (name == "some") emit_builtin("null", 1, form);
    const auto to_exit = emit_jump(PlanOp::kJumpIfNil, form);
    const auto to_next = emit_jump(PlanOp::kJump, form);
    patch_jump(to_exit);
    emit_exit(*lookup(BindingKind::kBlock, ""), form);
    patch_jump(to_next);
    if (name == "every") emit_local(PlanOp::kStore, result, form);
  }
  end_list_loop(loop, form);
  emit_local(PlanOp::kLoad, result, form);
  if (name == "mapcar") emit_builtin("reverse", 1, form);
  emit(PlanOp::kSqueeze, 3, 0, form);
  adjust(-3);
  scope_.resize(scope);
  close_block(block);
}

/// (try-each-in-order (v list) body...): the next element after a failure.
void PlanCompiler::form_try_each(DatumId form, Items items) {
  const auto head = items.size() < 2 ? Items() : data_.children(items[1]);
  if (head.size() != 2 || !data_.is_symbol(head[0])) {
    malformed(form, "expected (variable list) and a body");
    return emit_constant(values_.nil(), form);
  }
  const auto block = open_block("");
  const LexicalBinding out = *lookup(BindingKind::kBlock, "");
  compile(head[1]);
  const auto loop = begin_list_loop(data_.name(head[0]), form);
  const auto next = static_cast<std::uint32_t>(code_.exits.size());
  code_.exits.push_back({0, frame().height, frame().guards});
  emit(PlanOp::kPushHandlers, catch_all(next, form), 0, form);
  ++frame().guards;
  compile_body(items.subspan(2));
  emit(PlanOp::kPopGuard, 0, 0, form);
  --frame().guards;
  emit_exit(out, form);
  code_.exits[next].pc = here();
  end_list_loop(loop, form);
  emit(PlanOp::kFail, string_index("composite-failure"), 0, form);
  adjust(1);
  emit(PlanOp::kSqueeze, 2, 0, form);
  adjust(-2);
  close_block(block);
}

void PlanCompiler::form_loop(DatumId form, Items items) {
  const auto clauses = parse_loop(data_, items.subspan(1));
  if (const auto* error = std::get_if<LoopError>(&clauses)) {
    unsupported(error->at.value_or(form), error->text);
    return emit_constant(values_.nil(), form);
  }
  compile_loop(form, std::get<std::vector<LoopClause>>(clauses));
}

}  // namespace parallax::compiler
