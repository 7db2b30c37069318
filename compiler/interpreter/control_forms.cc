#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "compiler/base/codes/plans.h"
#include "compiler/interpreter/form_compiler.h"
#include "compiler/interpreter/function_calls.h"

namespace parallax::compiler {
namespace {

void form_progn(FormCompiler& c, DatumId /*form*/, FormItems items) {
  c.compile_body(items.subspan(1));
}

/// (locally declaration... form...)
void form_locally(FormCompiler& c, DatumId /*form*/, FormItems items) {
  c.compile_body(c.skip_declarations(items.subspan(1)));
}

/// (eval-when (situation...) form...): there is only one time.
void form_eval_when(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() < 2) return c.refuse(form, "expected situations and forms");
  c.compile_body(items.subspan(2));
}

/// The forms run in a task of their own.
void task(FormCompiler& c, DatumId form, FormItems body) {
  const auto scope = c.code.open_task(form);
  c.compile_body(body);
  c.code.close_task(scope, form);
}

void form_top_level(FormCompiler& c, DatumId form, FormItems items) {
  task(c, form, items.subspan(1));
}

/// `(:tag name form...)` may stand anywhere inside.
void form_with_tags(FormCompiler& c, DatumId /*form*/, FormItems items) {
  ++c.tags;
  c.compile_body(items.subspan(1));
  --c.tags;
}

/// Every branch is a unit of its own, which sees the variables around it.
void branches_by_turns(FormCompiler& c, DatumId form, FormItems branches, bool pursue) {
  std::vector<std::uint32_t> units;
  for (const auto branch : branches) {
    const auto unit = c.code.declare_unit("a branch", branch, 0);
    c.code.enter_unit(unit);
    task(c, branch, FormItems(&branch, 1));
    c.code.leave_unit(PlanOp::kEndBranch, branch);
    units.push_back(unit);
  }
  c.code.par(std::move(units), pursue, form);
}

void in_order(FormCompiler& c, DatumId form) {
  c.warning(codes::kParallelInOrder, form, c.form_name(form));
  c.code.code().gaps.push_back(
      {fmt::format("the other orders of `{}`", c.form_name(form)), form, GapKind::kOrder});
}

void form_par(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() > 2 && c.interleave) {
    return branches_by_turns(c, form, items.subspan(1), false);
  }
  if (items.size() > 2) in_order(c, form);
  if (items.size() < 2) return c.always_fails(form, "without branches it waits for nothing");
  for (std::size_t i = 1; i < items.size(); ++i) {
    task(c, items[i], items.subspan(i, 1));
    if (i > 1) c.code.drop(items[i]);  // the value is that of the first branch
  }
}

/// (try-all form...): the value of the first branch that has one; fails if all have failed.
void form_try_all(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() < 2) return c.refuse(form, "without branches it waits for nothing and fails");
  if (items.size() > 2 && c.interleave) {
    branches_by_turns(c, form, items.subspan(1), true);
    c.code.code().pars.back().tries = true;
    return;
  }
  if (items.size() > 2) in_order(c, form);
  // In written order the others begin when the first has failed.
  std::vector<DatumId> parts = {
      c.data.add_named(DatumKind::kSymbol, "try-in-order", "", c.data.source(form))};
  for (const auto branch : items.subspan(1)) {
    const DatumId task[] = {
        c.data.add_named(DatumKind::kSymbol, "top-level", "", c.data.source(branch)), branch};
    parts.push_back(c.data.add_list(task, c.data.source(branch)));
  }
  c.compile(c.data.add_list(parts, c.data.source(form)));
}

/// In written order the first branch ends before the others have performed anything. They are
/// checked all the same.
void form_pursue(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() < 2) return c.always_fails(form, "without branches it waits for nothing");
  if (items.size() > 2 && c.interleave) {
    return branches_by_turns(c, form, items.subspan(1), true);
  }
  task(c, items[1], items.subspan(1, 1));
  if (items.size() == 2) return;
  in_order(c, form);
  const auto over = c.code.jump(PlanOp::kJump, form);
  for (std::size_t i = 2; i < items.size(); ++i) {
    task(c, items[i], items.subspan(i, 1));
    c.code.drop(items[i]);
  }
  c.code.patch_jump(over);
}

/// (sleep seconds): nothing happens, except that other branches of a `par` may go on first.
void form_sleep(FormCompiler& c, DatumId form, FormItems /*items*/) {
  c.check_no_perform(form);
  if (!c.interleave) return c.nil(form);
  c.code.emit(PlanOp::kSleep, 0, 0, form);
  c.code.adjust(1);
}

/// (wait-for fluent [:timeout seconds]): without turns of branches nothing changes meanwhile.
void form_wait_for(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() < 2 || items.size() % 2 != 0) {
    return c.refuse(form, "expected a fluent and keywords");
  }
  if (!c.interleave) {
    c.error(codes::kReactiveForm, form, c.form_name(form))
        .note("with --par=interleave branches of `par` and `pursue` wait for fluents");
    return c.nil(form);
  }
  // The real one may also wake up between two changes that are one step here.
  c.code.code().gaps.push_back({"values of fluents that last for no turn", form, GapKind::kOrder});
  bool limited = false;
  for (std::size_t i = 2; i + 1 < items.size(); i += 2) {
    limited = limited || (c.data.is_keyword(items[i]) && c.data.name(items[i]) == "timeout");
  }
  c.compile(items[1]);
  c.code.emit(PlanOp::kWait, limited ? 1 : 0, 0, form);
  if (limited) c.code.builtin("value", 1, form);
}

void form_if(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() < 3 || items.size() > 4) {
    return c.refuse(form, "expected a test, a form and perhaps another form");
  }
  c.compile(items[1]);
  const auto to_else = c.code.jump(PlanOp::kJumpIfNil, items[1]);
  c.compile(items[2]);
  if (items.size() == 3) return c.otherwise_nil({to_else}, form);
  const auto to_end = c.code.jump(PlanOp::kJump, form);
  c.code.adjust(-1);
  c.code.patch_jump(to_else);
  c.compile(items[3]);
  c.code.patch_jump(to_end);
}

void form_when(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() < 2) {
    return c.refuse(form, "expected a test");
  }
  c.compile(items[1]);
  const auto to_else = c.code.jump(PlanOp::kJumpIfNil, items[1]);
  c.compile_body(items.subspan(2));
  c.otherwise_nil({to_else}, form);
}

void form_unless(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() < 2) {
    return c.refuse(form, "expected a test");
  }
  c.compile(items[1]);
  const auto to_body = c.code.jump(PlanOp::kJumpIfNil, items[1]);
  c.nil(form);
  const auto to_end = c.code.jump(PlanOp::kJump, form);
  c.code.adjust(-1);
  c.code.patch_jump(to_body);
  c.compile_body(items.subspan(2));
  c.code.patch_jump(to_end);
}

void form_cond(FormCompiler& c, DatumId form, FormItems items) {
  std::vector<std::size_t> to_end;
  for (const auto clause : items.subspan(1)) {
    const auto parts = c.data.children(clause);
    if (parts.empty()) {
      c.malformed(form, "a clause is (test form...)");
      continue;
    }
    c.compile(parts[0]);
    const auto place = c.code.height() - 1;
    // The test stays on the stack: it is the value of a clause without forms.
    c.code.load(place, clause);
    const auto to_next = c.code.jump(PlanOp::kJumpIfNil, clause);
    if (parts.size() > 1) {
      c.code.drop(clause);
      c.compile_body(parts.subspan(1));
    }
    to_end.push_back(c.code.jump(PlanOp::kJump, clause));
    c.code.patch_jump(to_next);
    c.code.drop(clause);
  }
  c.nil(form);
  for (const auto jump : to_end) c.code.patch_jump(jump);
}

void form_and(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() == 1) return c.code.constant(c.values.truth(), form);
  std::vector<std::size_t> to_nil;
  for (const auto item : items.subspan(1, items.size() - 2)) {
    c.compile(item);
    to_nil.push_back(c.code.jump(PlanOp::kJumpIfNil, item));
  }
  c.compile(items.back());
  if (!to_nil.empty()) c.otherwise_nil(to_nil, form);
}

void form_or(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() == 1) return c.nil(form);
  std::vector<std::size_t> to_end;
  for (const auto item : items.subspan(1, items.size() - 2)) {
    c.compile(item);
    c.code.load(c.code.height() - 1, item);
    const auto to_next = c.code.jump(PlanOp::kJumpIfNil, item);
    to_end.push_back(c.code.jump(PlanOp::kJump, item));
    c.code.patch_jump(to_next);
    c.code.drop(item);
  }
  c.compile(items.back());
  for (const auto jump : to_end) c.code.patch_jump(jump);
}

/// Leaves t or nil: is the value at `place` the key of the clause?
void case_clause_test(FormCompiler& c, DatumId key, std::uint32_t place, DatumId source) {
  c.code.load(place, source);
  c.code.constant(c.datum_value(key), key);
  c.code.builtin("%same", 2, source);  // `eql` of a fluent is a fluent
}

void form_case(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() < 2) {
    return c.refuse(form, "expected a value and clauses");
  }
  c.compile(items[1]);
  const auto place = c.code.height() - 1;
  std::vector<std::size_t> to_end;
  bool otherwise = false;
  for (const auto clause : items.subspan(2)) {
    const auto parts = c.data.children(clause);
    if (parts.empty() || otherwise) {
      c.malformed(form, parts.empty() ? "a clause is (key form...)" : "`otherwise` comes last");
      continue;
    }
    const bool any = c.data.is_symbol(parts[0], "t") || c.data.is_symbol(parts[0], "otherwise");
    otherwise = any;
    const auto single = parts.subspan(0, 1);
    // `nil` is the empty list of keys; the key itself is written `(nil)`.
    const bool list = c.data.is_list(parts[0]) || c.data.is_nil(parts[0]);
    const auto keys = list ? c.data.children(parts[0]) : single;
    std::vector<std::size_t> to_body;
    for (const auto key : any ? FormItems() : keys) {
      case_clause_test(c, key, place, clause);
      const auto to_next = c.code.jump(PlanOp::kJumpIfNil, key);
      to_body.push_back(c.code.jump(PlanOp::kJump, key));
      c.code.patch_jump(to_next);
    }
    std::optional<std::size_t> skip;
    if (!any) skip = c.code.jump(PlanOp::kJump, clause);
    for (const auto jump : to_body) c.code.patch_jump(jump);
    c.compile_body(parts.subspan(1));
    to_end.push_back(c.code.jump(PlanOp::kJump, clause));
    c.code.adjust(-1);
    if (skip) c.code.patch_jump(*skip);
  }
  if (c.form_name(form) == "ecase" && !otherwise) {
    c.code.fail("case-failure", form);
  } else {
    c.nil(form);
  }
  for (const auto jump : to_end) c.code.patch_jump(jump);
  c.code.squeeze(1, form);
}

void form_block(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() < 2 || (!c.data.is_symbol(items[1]) && !c.data.is_nil(items[1]))) {
    return c.refuse(form, "expected a name");
  }
  const auto block = c.code.open_block(c.data.is_nil(items[1]) ? "nil" : c.data.name(items[1]));
  c.compile_body(items.subspan(2));
  c.code.close_block(block);
}

void return_from(FormCompiler& c, DatumId form, std::string_view block,
                 std::optional<DatumId> value) {
  if (value) {
    c.compile(*value);
  } else {
    c.nil(form);
  }
  const auto* target = c.code.lookup(BindingKind::kBlock, block);
  if (target != nullptr && !c.code.in_other_task(*target)) return c.code.leave_to(*target, form);
  auto error = c.error(codes::kReturnOutsideBlock, form, c.form_name(form));
  if (target == nullptr) return;
  error.note(fmt::format(
      "the body of a `def-cram-function` and a branch of `par` run in a task of their own, which "
      "nothing leaves but its end and a failure; put `(block {} ...)` inside it and leave that",
      block));
}

void form_return(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() > 2) c.malformed(form, "expected at most one value");
  return_from(c, form, "nil", items.size() > 1 ? std::optional(items[1]) : std::nullopt);
}

void form_return_from(FormCompiler& c, DatumId form, FormItems items) {
  const bool named = items.size() >= 2 && (c.data.is_symbol(items[1]) || c.data.is_nil(items[1]));
  if (!named || items.size() > 3) {
    return c.refuse(form, "expected the name of a block and perhaps a value");
  }
  const std::string block = c.data.is_nil(items[1]) ? "nil" : c.data.name(items[1]);
  return_from(c, form, block, items.size() > 2 ? std::optional(items[2]) : std::nullopt);
}

/// The name of a symbol or a number in a `tagbody`; none: a statement.
std::optional<std::string> tag_of(const FormCompiler& c, DatumId item) {
  const auto kind = c.data[item].kind;
  const bool tag = (kind == DatumKind::kSymbol && !c.data.is_nil(item)) ||
                   kind == DatumKind::kKeyword || kind == DatumKind::kNumber;
  return tag ? std::optional(print_datum(c.data, item)) : std::nullopt;
}

/// (tagbody tag statement...): `(go tag)` leads to the tag; the value is nil.
void form_tagbody(FormCompiler& c, DatumId form, FormItems items) {
  const auto scope = c.code.scope().size();
  const auto statements = items.subspan(1);
  // Nothing static ends a loop that `go` makes: its rounds are counted, as those of `loop`.
  std::optional<std::uint32_t> counter;
  if (std::any_of(statements.begin(), statements.end(),
                  [&](DatumId item) { return tag_of(c, item).has_value(); })) {
    c.code.constant(c.values.counter(0), form);
    counter = c.code.height() - 1;
  }
  std::map<std::string, std::uint32_t> exits;
  for (const auto item : statements) {
    const auto tag = tag_of(c, item);
    if (!tag) continue;
    const auto [entry, added] = exits.emplace(*tag, c.code.open_exit());
    if (!added) c.malformed(form, "a tag stands there twice");
    c.code.show(c.code.named(BindingKind::kTag, *tag, entry->second));
  }
  // A tag is reached with a value, as every exit is.
  c.nil(form);
  for (const auto item : statements) {
    if (const auto tag = tag_of(c, item)) {
      c.code.set_exit(exits.at(*tag));
      c.code.emit(PlanOp::kTick, *counter, 0, form);
    } else {
      c.compile(item);
      c.code.drop(item);
    }
  }
  c.code.drop(form);
  if (counter) c.code.drop(form);
  c.nil(form);
  c.code.cut_scope(scope);
}

void form_go(FormCompiler& c, DatumId form, FormItems items) {
  c.nil(form);
  const auto tag = items.size() == 2 ? tag_of(c, items[1]) : std::nullopt;
  if (!tag) return c.malformed(form, "expected a tag");
  const auto* target = c.code.lookup(BindingKind::kTag, *tag);
  if (target != nullptr && !c.code.in_other_task(*target)) return c.code.leave_to(*target, form);
  c.error(codes::kReturnOutsideBlock, form, c.form_name(form));
}

/// (print x) is x.
void form_print(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() < 2) return c.refuse(form, "expected a value");
  c.check_no_perform(form);
  c.compile(items[1]);
}

/// Is everything known that the form names? Arguments of `format` may be written for people only.
bool can_be_computed(const FormCompiler& c, DatumId form) {
  std::vector<DatumId> open = {form};
  while (!open.empty()) {
    const auto datum = open.back();
    open.pop_back();
    if (c.data.is_symbol(datum) && !c.data.is_nil(datum) && c.data.name(datum) != "t") {
      const bool bound = c.code.lookup(BindingKind::kVariable, c.data.name(datum)) != nullptr;
      if (!bound && !c.defined.globals.contains(c.data.key(datum))) return false;
    }
    const auto items = c.data.children(datum);
    if (items.empty() || c.data.head(datum) == "quote") continue;
    if (!c.data.is_symbol(items.front()) || !find_callee(c, items.front())) return false;
    open.insert(open.end(), items.begin() + 1, items.end());
  }
  return true;
}

/// (format nil "text" ...) is a string; any other is nil. Directives whose argument is not known
/// stay as they are.
void form_format(FormCompiler& c, DatumId form, FormItems items) {
  c.check_no_perform(form);
  const bool text = items.size() > 2 && c.data.is_nil(items[1]) && c.data.is_string(items[2]);
  if (!text) return c.nil(form);
  c.code.constant(c.datum_value(items[2]), form);
  const auto arguments = items.subspan(3);
  const bool known = std::all_of(arguments.begin(), arguments.end(),
                                 [&](DatumId item) { return can_be_computed(c, item); });
  if (!known) return;
  for (const auto argument : arguments) c.compile(argument);
  c.code.builtin("%format", static_cast<std::uint32_t>(arguments.size() + 1), form);
}

/// (holds '(fluent argument...)) and (prolog '(query argument...)) ask the model now.
void form_holds(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() != 2) {
    return c.refuse(form, "expected a quoted fluent such as '(holding left box)");
  }
  c.compile(items[1]);
  c.code.emit(PlanOp::kHolds, c.form_name(form) == "prolog" ? 1 : 0, 0, form);
}

}  // namespace

std::span<const FormEntry> control_forms() {
  static constexpr FormEntry kForms[] = {
      {"locally", form_locally},
      {"progn", form_progn},
      {"seq", form_progn},
      {"top-level", form_top_level},
      {"with-tags", form_with_tags},
      {"with-simulated-robot", form_progn},
      {"with-real-robot", form_progn},
      {"eval-when", form_eval_when},
      {"par", form_par},
      {"pursue", form_pursue},
      {"wait-for", form_wait_for},
      {"try-all", form_try_all},
      {"sleep", form_sleep},
      {"if", form_if},
      {"when", form_when},
      {"unless", form_unless},
      {"cond", form_cond},
      {"case", form_case},
      {"ecase", form_case},
      {"and", form_and},
      {"or", form_or},
      {"block", form_block},
      {"return", form_return},
      {"return-from", form_return_from},
      {"tagbody", form_tagbody},
      {"go", form_go},
      {"holds", form_holds},
      {"prolog", form_holds},
      {"format", form_format},
      {"print", form_print},
  };
  return kForms;
}

}  // namespace parallax::compiler
