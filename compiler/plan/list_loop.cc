#include "compiler/plan/list_loop.h"

namespace parallax::compiler {

ListLoop begin_list_loop(FormCompiler& c, std::string_view variable, DatumId source) {
  ListLoop loop;
  c.code.emit(PlanOp::kExpectList, 0, 0, source);
  loop.list = c.code.height() - 1;
  c.nil(source);
  loop.item = c.code.height() - 1;
  c.code.bind_top(variable);
  loop.top = c.code.here();
  c.code.load(loop.list, source);
  loop.end_jump = c.code.jump(PlanOp::kJumpIfNil, source);
  c.code.load(loop.list, source);
  c.code.builtin("car", 1, source);
  c.code.store_and_drop(loop.item, source);
  c.code.load(loop.list, source);
  c.code.builtin("cdr", 1, source);
  c.code.store_and_drop(loop.list, source);
  return loop;
}

void end_list_loop(FormCompiler& c, const ListLoop& loop, DatumId source) {
  c.code.drop(source);
  c.code.jump_back(loop.top, source);
  c.code.patch_jump(loop.end_jump);
  c.nil(source);
  c.code.store_and_drop(loop.item, source);
}

}  // namespace parallax::compiler
