#include "compiler/interpreter/form_compiler.h"
#include "compiler/interpreter/variables.h"

namespace parallax::compiler {
namespace {

void form_dolist(FormCompiler& c, DatumId form, FormItems items) {
  const auto head = items.size() < 2 ? FormItems() : c.data.children(items[1]);
  if (head.size() < 2 || head.size() > 3 || !c.data.is_symbol(head[0])) {
    return c.refuse(form, "expected (variable list) and a body");
  }
  const auto block = c.code.open_block("nil");
  c.compile(head[1]);
  const auto loop = begin_list_loop(c, head[0], form);
  c.compile_body(c.skip_declarations(items.subspan(2)));
  end_list_loop(c, loop, form);
  if (head.size() == 3) {
    c.compile(head[2]);
  } else {
    c.nil(form);
  }
  close_variables(c, loop.scope, 2, form);
  c.code.close_block(block);
}

void form_dotimes(FormCompiler& c, DatumId form, FormItems items) {
  const auto head = items.size() < 2 ? FormItems() : c.data.children(items[1]);
  if (head.size() < 2 || head.size() > 3 || !c.data.is_symbol(head[0])) {
    return c.refuse(form, "expected (variable count) and a body");
  }
  const auto block = c.code.open_block("nil");
  const auto scope = c.code.scope().size();
  c.compile(head[1]);
  const auto count = c.code.height() - 1;
  c.code.constant(c.values.number(Number(0)), form);
  const auto index = c.code.height() - 1;
  bind_top(c, head[0], form);
  c.code.note_change(c.code.scope().back());
  const auto top = c.code.here();
  c.code.load(index, form);
  c.code.load(count, form);
  c.code.builtin("<", 2, form);
  const auto to_end = c.code.jump(PlanOp::kJumpIfNil, form);
  c.compile_body(c.skip_declarations(items.subspan(2)));
  c.code.drop(form);
  c.code.load(index, form);
  c.code.builtin("1+", 1, form);
  c.code.store_and_drop(index, form);
  c.code.jump_back(top, form);
  c.code.patch_jump(to_end);
  if (head.size() == 3) {
    c.compile(head[2]);
  } else {
    c.nil(form);
  }
  close_variables(c, scope, 2, form);
  c.code.close_block(block);
}

}  // namespace

std::span<const FormEntry> loop_forms() {
  static constexpr FormEntry kForms[] = {
      {"dolist", form_dolist},
      {"dotimes", form_dotimes},
  };
  return kForms;
}

}  // namespace parallax::compiler
