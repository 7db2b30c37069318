// mapcar, mapc, mapcan, every, some, notany and notevery over one or more lists. They are written
// in line: their function may perform, and sees the variables around it.
#include <string>
#include <vector>

#include "compiler/interpreter/form_compiler.h"
#include "compiler/interpreter/function_calls.h"

namespace parallax::compiler {
namespace {

struct Mapping {
  bool collects = false;  // mapcar, mapcan
  bool tests = false;     // every, some, notany, notevery
  bool until = false;     // tests: ends at the first value that is not nil
  bool negated = false;   // tests: the value says whether it went on to the end
};

Mapping mapping(std::string_view name) {
  Mapping out;
  out.collects = name == "mapcar" || name == "mapcan";
  out.tests = name == "every" || name == "some" || name == "notany" || name == "notevery";
  out.until = name == "some" || name == "notany";
  out.negated = name == "notany" || name == "notevery";
  return out;
}

/// The value that a test has when no element ends it: of `every`, the last one is kept.
bool holds_at_end(const Mapping& kind) { return kind.until == kind.negated; }

void form_map(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() < 3) return c.refuse(form, "expected a function and a list");
  const std::string name = c.form_name(form);
  const auto kind = mapping(name);
  const auto lists = static_cast<std::uint32_t>(items.size() - 2);
  const auto block = c.code.open_block("");
  const LexicalBinding out = *c.code.lookup(BindingKind::kBlock, "");
  const auto result = c.code.height();
  c.code.constant(kind.tests && holds_at_end(kind) ? c.values.truth() : c.values.nil(), form);
  const auto function = prepare_function(c, form, items[1]);
  const auto first = c.code.height();
  for (std::uint32_t i = 0; i < lists; ++i) {
    c.compile(items[2 + i]);
    c.code.emit(PlanOp::kExpectList, 0, 0, form);
    if (i > 0 || kind.collects || kind.tests) continue;
    c.code.store(result, form);  // the first list is the value of mapc
  }
  const auto top = c.code.here();
  std::vector<std::size_t> to_end;
  for (std::uint32_t i = 0; i < lists; ++i) {
    c.code.load(first + i, form);
    to_end.push_back(c.code.jump(PlanOp::kJumpIfNil, form));
  }
  push_prepared(c, function, form);
  for (std::uint32_t i = 0; i < lists; ++i) {
    c.code.load(first + i, form);
    c.code.builtin("car", 1, form);
    c.code.load(first + i, form);
    c.code.builtin("cdr", 1, form);
    c.code.store_and_drop(first + i, form);
  }
  call_prepared(c, function, lists, form);
  if (kind.tests) {
    const auto value = c.code.height() - 1;
    c.code.load(value, form);
    if (!kind.until) c.code.builtin("null", 1, form);
    const auto to_next = c.code.jump(PlanOp::kJumpIfNil, form);
    if (kind.negated) {
      c.code.constant(c.values.boolean(!holds_at_end(kind)), form);
    } else if (kind.until) {
      c.code.load(value, form);
    } else {
      c.nil(form);
    }
    c.code.leave_to(out, form);
    c.code.adjust(-1);
    c.code.patch_jump(to_next);
  } else if (name == "mapcar") {
    c.code.load(result, form);
    c.code.builtin("cons", 2, form);
    c.code.store(result, form);
  } else if (name == "mapcan") {
    c.code.load(result, form);
    c.code.load(c.code.height() - 2, form);
    c.code.builtin("%append-reversed", 2, form);
    c.code.store_and_drop(result, form);
  }
  c.code.drop(form);
  c.code.jump_back(top, form);
  for (const auto jump : to_end) c.code.patch_jump(jump);
  c.code.load(result, form);
  if (kind.collects) c.code.builtin("reverse", 1, form);
  c.code.squeeze(lists + 2, form);
  c.code.close_block(block);
}

}  // namespace

std::span<const FormEntry> mapping_forms() {
  static constexpr FormEntry kForms[] = {
      {"mapcar", form_map}, {"mapc", form_map},   {"mapcan", form_map},   {"every", form_map},
      {"some", form_map},   {"notany", form_map}, {"notevery", form_map},
  };
  return kForms;
}

}  // namespace parallax::compiler
