#include <utility>

#include "compiler/plan/plan_compiler.h"

namespace parallax::compiler {

/// Pushes the variables of an iteration clause and notes the place of the first one.
void PlanCompiler::loop_prologue(const LoopClause& clause, DatumId form, LoopState& state) {
  state.places.push_back(frame().height);
  const auto constant = [&](const std::optional<DatumId>& datum, int fallback) {
    if (datum) return compile(*datum);
    emit_constant(values_.number(Number(fallback)), form);
  };
  switch (clause.kind) {
    case LoopKind::kIn:
      compile(*clause.form);
      emit(PlanOp::kExpectList, 0, 0, form);
      emit_constant(values_.nil(), form);
      bind_variable(clause.variable);
      return;
    case LoopKind::kRange:
      constant(clause.form, 0);
      constant(clause.limit, 0);
      constant(clause.step, 1);
      scope_.push_back({BindingKind::kVariable, clause.variable,
                        static_cast<std::uint32_t>(frames_.size() - 1), state.places.back()});
      return;
    case LoopKind::kRepeat:
      compile(*clause.form);
      return;
    case LoopKind::kWhile:
    case LoopKind::kUntil:
    case LoopKind::kDo:
    case LoopKind::kCollect:
      return;
  }
}

/// At the top of the loop: leave if the clause is through, else set its variable.
void PlanCompiler::loop_test(const LoopClause& clause, std::uint32_t place, DatumId form,
                             LoopState& state) {
  switch (clause.kind) {
    case LoopKind::kIn:
      emit_local(PlanOp::kLoad, place, form);
      state.end_jumps.push_back(emit_jump(PlanOp::kJumpIfNil, form));
      emit_local(PlanOp::kLoad, place, form);
      emit_builtin("car", 1, form);
      store_and_drop(place + 1, form);
      emit_local(PlanOp::kLoad, place, form);
      emit_builtin("cdr", 1, form);
      store_and_drop(place, form);
      return;
    case LoopKind::kRange:
      if (!clause.limit) return;
      emit_local(PlanOp::kLoad, place, form);
      emit_local(PlanOp::kLoad, place + 1, form);
      emit_builtin(clause.down ? (clause.exclusive ? ">" : ">=") : (clause.exclusive ? "<" : "<="),
                   2, form);
      state.end_jumps.push_back(emit_jump(PlanOp::kJumpIfNil, form));
      return;
    case LoopKind::kRepeat:
      emit_local(PlanOp::kLoad, place, form);
      emit_constant(values_.number(Number(0)), form);
      emit_builtin(">", 2, form);
      state.end_jumps.push_back(emit_jump(PlanOp::kJumpIfNil, form));
      emit_local(PlanOp::kLoad, place, form);
      emit_builtin("1-", 1, form);
      store_and_drop(place, form);
      return;
    case LoopKind::kWhile:
    case LoopKind::kUntil:
    case LoopKind::kDo:
    case LoopKind::kCollect:
      return;
  }
}

void PlanCompiler::loop_body(const LoopClause& clause, DatumId form, LoopState& state) {
  switch (clause.kind) {
    case LoopKind::kWhile:
    case LoopKind::kUntil:
      compile(*clause.form);
      if (clause.kind == LoopKind::kUntil) emit_builtin("null", 1, form);
      state.end_jumps.push_back(emit_jump(PlanOp::kJumpIfNil, form));
      return;
    case LoopKind::kDo:
      for (const auto item : clause.body) {
        compile(item);
        emit(PlanOp::kPop, 0, 0, item);
        adjust(-1);
      }
      return;
    case LoopKind::kCollect:
      compile(*clause.form);
      emit_local(PlanOp::kLoad, state.result, form);
      emit_builtin("cons", 2, form);
      store_and_drop(state.result, form);
      return;
    case LoopKind::kIn:
    case LoopKind::kRange:
    case LoopKind::kRepeat:
      return;
  }
}

void PlanCompiler::loop_step(const LoopClause& clause, std::uint32_t place, DatumId form) {
  if (clause.kind != LoopKind::kRange) return;
  emit_local(PlanOp::kLoad, place, form);
  emit_local(PlanOp::kLoad, place + 2, form);
  emit_builtin(clause.down ? "-" : "+", 2, form);
  store_and_drop(place, form);
}

void PlanCompiler::compile_loop(DatumId form, const std::vector<LoopClause>& clauses) {
  LoopState state;
  const auto block = open_block("nil");
  state.height = frame().height;
  emit_constant(values_.nil(), form);
  state.result = state.height;
  bool bounded = false;
  for (const auto& clause : clauses) {
    loop_prologue(clause, form, state);
    bounded = bounded || clause.bounded();
  }
  std::optional<std::uint32_t> counter;
  if (!bounded) {
    emit_constant(values_.counter(0), form);
    counter = frame().height - 1;
  }
  const auto top = here();
  if (counter) emit(PlanOp::kTick, *counter, 0, form);
  for (std::size_t i = 0; i < clauses.size(); ++i) {
    loop_test(clauses[i], state.places[i], form, state);
  }
  for (const auto& clause : clauses) loop_body(clause, form, state);
  for (std::size_t i = 0; i < clauses.size(); ++i) loop_step(clauses[i], state.places[i], form);
  emit(PlanOp::kJump, top, 0, form);
  for (const auto jump : state.end_jumps) patch_jump(jump);
  emit_local(PlanOp::kLoad, state.result, form);
  emit_builtin("reverse", 1, form);
  const auto count = frame().height - 1 - state.height;
  emit(PlanOp::kSqueeze, count, 0, form);
  adjust(-static_cast<int>(count));
  close_block(block);
}

}  // namespace parallax::compiler
