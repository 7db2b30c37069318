#include "compiler/plan/form_compiler.h"
#include "compiler/plan/list_loop.h"

namespace parallax::compiler {
namespace {

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
}

/// (try-each-in-order (v list) body...): the next element after a failure.
void form_try_each(FormCompiler& c, DatumId form, FormItems items) {
  const auto head = items.size() < 2 ? FormItems() : c.data.children(items[1]);
  if (head.size() != 2 || !c.data.is_symbol(head[0])) {
    return c.refuse(form, "expected (variable list) and a body");
  }
  const auto block = c.code.open_block("");
  const LexicalBinding out = *c.code.lookup(BindingKind::kBlock, "");
  c.compile(head[1]);
  const auto loop = begin_list_loop(c, c.data.name(head[0]), form);
  const auto next = c.code.open_exit();
  c.code.push_handlers(catch_all(c, next, form), form);
  c.compile_body(items.subspan(2));
  c.code.pop_guard(form);
  c.code.leave_to(out, form);
  c.code.set_exit(next);
  end_list_loop(c, loop, form);
  c.code.fail("composite-failure", form);
  c.code.squeeze(2, form);
  c.code.close_block(block);
}

}  // namespace

std::span<const FormEntry> try_forms() {
  static constexpr FormEntry kForms[] = {
      {"try-in-order", form_try_in_order},
      {"try-each-in-order", form_try_each},
  };
  return kForms;
}

}  // namespace parallax::compiler
