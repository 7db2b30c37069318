#include <fmt/core.h>

#include <utility>

#include "compiler/base/diagnostic_codes.h"
#include "compiler/plan/plan_compiler.h"

namespace parallax::compiler {

using base::DiagnosticCode;

void PlanCompiler::form_progn(DatumId /*form*/, Items items) { compile_body(items.subspan(1)); }

void PlanCompiler::form_par(DatumId form, Items items) {
  if (items.size() > 2 && interleave_) return par_by_turns(form, items.subspan(1));
  if (items.size() > 2) {
    sink_.warning(DiagnosticCode::kParallelInOrder, data_.source(form), form_name(form));
  }
  compile_body(items.subspan(1));
}

/// Every branch is a unit of its own, which sees the variables around it.
void PlanCompiler::par_by_turns(DatumId form, Items branches) {
  std::vector<std::uint32_t> units;
  for (const auto branch : branches) {
    const auto unit = declare_unit("a branch", branch, 0);
    enter_unit(unit);
    compile(branch);
    leave_unit(PlanOp::kEndBranch, branch);
    units.push_back(unit);
  }
  emit(PlanOp::kPar, static_cast<std::uint32_t>(code_.pars.size()), 0, form);
  code_.pars.push_back(std::move(units));
  adjust(1);
}

/// Transparent forms whose first argument says where or how to run.
void PlanCompiler::form_skip_argument(DatumId form, Items items) {
  if (items.size() < 2) {
    malformed(form, "expected an argument before the body");
    return emit_constant(values_.nil(), form);
  }
  compile_body(items.subspan(2));
}

void PlanCompiler::form_if(DatumId form, Items items) {
  if (items.size() < 3 || items.size() > 4) {
    malformed(form, "expected a test, a form and perhaps another form");
    return emit_constant(values_.nil(), form);
  }
  compile(items[1]);
  const auto to_else = emit_jump(PlanOp::kJumpIfNil, items[1]);
  compile(items[2]);
  const auto to_end = emit_jump(PlanOp::kJump, form);
  adjust(-1);
  patch_jump(to_else);
  if (items.size() == 4) {
    compile(items[3]);
  } else {
    emit_constant(values_.nil(), form);
  }
  patch_jump(to_end);
}

void PlanCompiler::form_when(DatumId form, Items items) {
  if (items.size() < 2) {
    malformed(form, "expected a test");
    return emit_constant(values_.nil(), form);
  }
  compile(items[1]);
  const auto to_else = emit_jump(PlanOp::kJumpIfNil, items[1]);
  compile_body(items.subspan(2));
  const auto to_end = emit_jump(PlanOp::kJump, form);
  adjust(-1);
  patch_jump(to_else);
  emit_constant(values_.nil(), form);
  patch_jump(to_end);
}

void PlanCompiler::form_unless(DatumId form, Items items) {
  if (items.size() < 2) {
    malformed(form, "expected a test");
    return emit_constant(values_.nil(), form);
  }
  compile(items[1]);
  const auto to_body = emit_jump(PlanOp::kJumpIfNil, items[1]);
  emit_constant(values_.nil(), form);
  const auto to_end = emit_jump(PlanOp::kJump, form);
  adjust(-1);
  patch_jump(to_body);
  compile_body(items.subspan(2));
  patch_jump(to_end);
}

void PlanCompiler::form_cond(DatumId form, Items items) {
  std::vector<std::size_t> to_end;
  for (const auto clause : items.subspan(1)) {
    const auto parts = data_.children(clause);
    if (parts.empty()) {
      malformed(form, "a clause is (test form...)");
      continue;
    }
    compile(parts[0]);
    const auto place = frame().height - 1;
    // The test stays on the stack: it is the value of a clause without forms.
    emit_local(PlanOp::kLoad, place, clause);
    const auto to_next = emit_jump(PlanOp::kJumpIfNil, clause);
    if (parts.size() > 1) {
      emit(PlanOp::kPop, 0, 0, clause);
      adjust(-1);
      compile_body(parts.subspan(1));
    }
    to_end.push_back(emit_jump(PlanOp::kJump, clause));
    patch_jump(to_next);
    emit(PlanOp::kPop, 0, 0, clause);
    adjust(-1);
  }
  emit_constant(values_.nil(), form);
  for (const auto jump : to_end) patch_jump(jump);
}

void PlanCompiler::form_and(DatumId form, Items items) {
  if (items.size() == 1) return emit_constant(values_.truth(), form);
  std::vector<std::size_t> to_nil;
  for (const auto item : items.subspan(1, items.size() - 2)) {
    compile(item);
    to_nil.push_back(emit_jump(PlanOp::kJumpIfNil, item));
  }
  compile(items.back());
  if (to_nil.empty()) return;
  const auto to_end = emit_jump(PlanOp::kJump, form);
  adjust(-1);
  for (const auto jump : to_nil) patch_jump(jump);
  emit_constant(values_.nil(), form);
  patch_jump(to_end);
}

void PlanCompiler::form_or(DatumId form, Items items) {
  if (items.size() == 1) return emit_constant(values_.nil(), form);
  std::vector<std::size_t> to_end;
  for (const auto item : items.subspan(1, items.size() - 2)) {
    compile(item);
    emit_local(PlanOp::kLoad, frame().height - 1, item);
    const auto to_next = emit_jump(PlanOp::kJumpIfNil, item);
    to_end.push_back(emit_jump(PlanOp::kJump, item));
    patch_jump(to_next);
    emit(PlanOp::kPop, 0, 0, item);
    adjust(-1);
  }
  compile(items.back());
  for (const auto jump : to_end) patch_jump(jump);
}

/// Leaves t or nil: is the value at `place` the key of the clause?
void PlanCompiler::case_clause_test(DatumId key, std::uint32_t place, DatumId source) {
  emit_local(PlanOp::kLoad, place, source);
  emit_constant(datum_value(key), key);
  emit_builtin("eql", 2, source);
}

void PlanCompiler::form_case(DatumId form, Items items) {
  if (items.size() < 2) {
    malformed(form, "expected a value and clauses");
    return emit_constant(values_.nil(), form);
  }
  compile(items[1]);
  const auto place = frame().height - 1;
  std::vector<std::size_t> to_end;
  bool otherwise = false;
  for (const auto clause : items.subspan(2)) {
    const auto parts = data_.children(clause);
    if (parts.empty() || otherwise) {
      malformed(form, parts.empty() ? "a clause is (key form...)" : "`otherwise` comes last");
      continue;
    }
    const bool any = data_.is_symbol(parts[0], "t") || data_.is_symbol(parts[0], "otherwise");
    otherwise = any;
    const auto single = parts.subspan(0, 1);
    const auto keys = data_.is_list(parts[0]) ? data_.children(parts[0]) : single;
    std::vector<std::size_t> to_body;
    for (const auto key : any ? Items() : keys) {
      case_clause_test(key, place, clause);
      const auto to_next = emit_jump(PlanOp::kJumpIfNil, key);
      to_body.push_back(emit_jump(PlanOp::kJump, key));
      patch_jump(to_next);
    }
    std::optional<std::size_t> skip;
    if (!any) skip = emit_jump(PlanOp::kJump, clause);
    for (const auto jump : to_body) patch_jump(jump);
    compile_body(parts.subspan(1));
    to_end.push_back(emit_jump(PlanOp::kJump, clause));
    adjust(-1);
    if (skip) patch_jump(*skip);
  }
  if (form_name(form) == "ecase" && !otherwise) {
    emit(PlanOp::kFail, string_index("case-failure"), 0, form);
    adjust(1);
  } else {
    emit_constant(values_.nil(), form);
  }
  for (const auto jump : to_end) patch_jump(jump);
  emit(PlanOp::kSqueeze, 1, 0, form);
  adjust(-1);
}

void PlanCompiler::form_block(DatumId form, Items items) {
  if (items.size() < 2 || (!data_.is_symbol(items[1]) && !data_.is_nil(items[1]))) {
    malformed(form, "expected a name");
    return emit_constant(values_.nil(), form);
  }
  const auto block = open_block(data_.is_nil(items[1]) ? "nil" : data_.name(items[1]));
  compile_body(items.subspan(2));
  close_block(block);
}

void PlanCompiler::return_from(DatumId form, std::string_view block, std::optional<DatumId> value) {
  if (value) {
    compile(*value);
  } else {
    emit_constant(values_.nil(), form);
  }
  const auto* target = lookup(BindingKind::kBlock, block);
  if (target != nullptr) return emit_exit(*target, form);
  failed_ = true;
  sink_.error(DiagnosticCode::kReturnOutsideBlock, data_.source(form), form_name(form));
}

void PlanCompiler::form_return(DatumId form, Items items) {
  if (items.size() > 2) malformed(form, "expected at most one value");
  return_from(form, "nil", items.size() > 1 ? std::optional(items[1]) : std::nullopt);
}

void PlanCompiler::form_return_from(DatumId form, Items items) {
  const bool named = items.size() >= 2 && (data_.is_symbol(items[1]) || data_.is_nil(items[1]));
  if (!named || items.size() > 3) {
    malformed(form, "expected the name of a block and perhaps a value");
    return emit_constant(values_.nil(), form);
  }
  const std::string block = data_.is_nil(items[1]) ? "nil" : data_.name(items[1]);
  return_from(form, block, items.size() > 2 ? std::optional(items[2]) : std::nullopt);
}

/// Logging, belief updates, markers: accepted, not evaluated.
void PlanCompiler::form_ignored(DatumId form, Items /*items*/) {
  check_no_perform(form);
  emit_constant(values_.nil(), form);
}

void PlanCompiler::form_projection_check(DatumId form, Items /*items*/) {
  sink_.warning(DiagnosticCode::kProjectionIgnored, data_.source(form), form_name(form));
  check_no_perform(form);
  emit_constant(values_.nil(), form);
}

/// (holds '(fluent argument...)) and (prolog '(query argument...)) ask the model now.
void PlanCompiler::form_holds(DatumId form, Items items) {
  if (items.size() != 2) {
    malformed(form, "expected a quoted fluent such as '(holding left box)");
    return emit_constant(values_.nil(), form);
  }
  compile(items[1]);
  emit(PlanOp::kHolds, form_name(form) == "prolog" ? 1 : 0, 0, form);
}

}  // namespace parallax::compiler
