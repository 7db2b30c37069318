#include <fmt/core.h>

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "compiler/plan/form_compiler.h"
#include "compiler/plan/function_calls.h"
#include "compiler/plan/lisp_data.h"

namespace parallax::compiler {
namespace {

enum class LoopKind : std::uint8_t { kIn, kRange, kRepeat, kWhile, kUntil, kDo, kCollect };

/// One clause of the extended `loop`.
struct LoopClause {
  LoopKind kind = LoopKind::kDo;
  std::string variable;          // kIn, kRange
  std::optional<DatumId> form;   // the list, the start, the count, the test or the value
  std::optional<DatumId> limit;  // kRange; none: for ever
  std::optional<DatumId> step;   // kRange
  bool down = false;             // kRange: counts down
  bool exclusive = false;        // kRange: `below`, `above`
  std::vector<DatumId> body;     // kDo
  bool bounded() const {
    return kind == LoopKind::kIn || kind == LoopKind::kRepeat ||
           (kind == LoopKind::kRange && limit.has_value());
  }
};

struct LoopError {
  std::string text;
  std::optional<DatumId> at;
};

class LoopParser {
 public:
  LoopParser(const LispData& data, std::span<const DatumId> items) : data_(data), items_(items) {}

  std::variant<std::vector<LoopClause>, LoopError> parse() {
    if (!items_.empty() && data_.is_list(items_.front())) {
      LoopClause clause;
      clause.body.assign(items_.begin(), items_.end());
      return std::vector<LoopClause>{std::move(clause)};
    }
    std::vector<LoopClause> out;
    while (i_ < items_.size()) {
      LoopClause clause;
      if (!parse_clause(clause)) return error_;
      const bool iterates = clause.bounded() || clause.kind == LoopKind::kRange;
      if (iterates && !out.empty() && !iterating_) return LoopError{"`for` behind the body", at()};
      iterating_ = iterates;
      out.push_back(std::move(clause));
    }
    return out;
  }

 private:
  std::optional<DatumId> at() const {
    return i_ < items_.size() ? std::optional(items_[i_]) : std::nullopt;
  }
  /// The next item as a word, without taking it; loop keywords may be symbols or keywords.
  std::string_view word() const {
    if (i_ >= items_.size()) return {};
    const auto item = items_[i_];
    return data_.is_symbol(item) || data_.is_keyword(item) ? data_.name(item) : std::string_view();
  }
  bool take_word(std::string_view wanted) {
    if (word() != wanted) return false;
    ++i_;
    return true;
  }
  bool fail(std::string text) {
    error_ = {std::move(text), at()};
    return false;
  }
  bool take_form(std::optional<DatumId>& out) {
    if (i_ >= items_.size()) return fail("the clause ends too early");
    out = items_[i_++];
    return true;
  }
  bool simple(LoopClause& clause, LoopKind kind) {
    clause.kind = kind;
    ++i_;
    return take_form(clause.form);
  }
  bool parse_clause(LoopClause& clause) {
    const auto name = word();
    if (name == "repeat") return simple(clause, LoopKind::kRepeat);
    if (name == "while") return simple(clause, LoopKind::kWhile);
    if (name == "until") return simple(clause, LoopKind::kUntil);
    if (name == "collect" || name == "collecting") return simple(clause, LoopKind::kCollect);
    if (name == "do" || name == "doing") {
      ++i_;
      while (i_ < items_.size() && data_.is_list(items_[i_])) clause.body.push_back(items_[i_++]);
      return !clause.body.empty() || fail("`do` needs a form");
    }
    if (name == "for" || name == "as") {
      ++i_;
      return parse_for(clause);
    }
    return fail(fmt::format("the loop clause `{}`", print_datum(data_, items_[i_])));
  }
  bool parse_for(LoopClause& clause) {
    if (i_ >= items_.size() || !data_.is_symbol(items_[i_]))
      return fail("a loop variable is a name");
    clause.variable = data_.name(items_[i_++]);
    if (take_word("in")) {
      clause.kind = LoopKind::kIn;
      return take_form(clause.form);
    }
    clause.kind = LoopKind::kRange;
    bool any = false;
    if (take_word("from") || take_word("upfrom")) any = true;
    if (!any && take_word("downfrom")) any = clause.down = true;
    if (any && !take_form(clause.form)) return false;
    for (;;) {
      if (take_word("to") || take_word("upto")) {
      } else if (take_word("below")) {
        clause.exclusive = true;
      } else if (take_word("downto")) {
        clause.down = true;
      } else if (take_word("above")) {
        clause.down = clause.exclusive = true;
      } else if (take_word("by")) {
        any = true;
        if (!take_form(clause.step)) return false;
        continue;
      } else {
        return any || fail(fmt::format("this kind of `for {}`", clause.variable));
      }
      any = true;
      if (!take_form(clause.limit)) return false;
    }
  }

  const LispData& data_;
  std::span<const DatumId> items_;
  std::size_t i_ = 0;
  bool iterating_ = true;  // all clauses so far iterate
  LoopError error_;
};

/// Parses what follows the word `loop`: for v in L, for i from a to|upto|below|downto|above b
/// [by s], repeat n, while c, until c, do forms, collect v; or bare forms, which repeat for ever.
std::variant<std::vector<LoopClause>, LoopError> parse_loop(const LispData& data,
                                                            std::span<const DatumId> items) {
  return LoopParser(data, items).parse();
}

void form_dolist(FormCompiler& c, DatumId form, FormItems items) {
  const auto head = items.size() < 2 ? FormItems() : c.data.children(items[1]);
  if (head.size() < 2 || head.size() > 3 || !c.data.is_symbol(head[0])) {
    return c.refuse(form, "expected (variable list) and a body");
  }
  const auto block = c.code.open_block("nil");
  c.compile(head[1]);
  const auto loop = begin_list_loop(c, c.data.name(head[0]), form);
  c.compile_body(c.skip_declarations(items.subspan(2)));
  end_list_loop(c, loop, form);
  if (head.size() == 3) {
    c.compile(head[2]);
  } else {
    c.nil(form);
  }
  c.code.squeeze(2, form);
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
  c.code.bind_top(c.data.name(head[0]));
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
  c.code.squeeze(2, form);
  c.code.cut_scope(scope);
  c.code.close_block(block);
}

/// mapcar, mapc, every and some over one static list.
void form_map(FormCompiler& c, DatumId form, FormItems items) {
  if (items.size() != 3) {
    return c.refuse(form, "expected a function and one list");
  }
  const std::string name = c.form_name(form);
  const auto block = c.code.open_block("");
  const auto scope = c.code.scope().size();
  const auto result = c.code.height();
  if (name != "mapc") c.code.constant(name == "every" ? c.values.truth() : c.values.nil(), form);
  c.compile(items[2]);
  if (name == "mapc") c.code.load(result, form);  // the list is mapc's value
  const auto loop = begin_list_loop(c, "", form);
  c.code.load(loop.item, form);
  if (const auto callee = resolve_callee(c, form, items[1])) emit_call(c, *callee, 1, form);
  if (name == "mapcar") {
    c.code.load(result, form);
    c.code.builtin("cons", 2, form);
    c.code.store(result, form);
  } else if (name == "every" || name == "some") {
    const auto value = c.code.height() - 1;
    c.code.load(value, form);
    if (name == "some") c.code.builtin("null", 1, form);
    const auto to_exit = c.code.jump(PlanOp::kJumpIfNil, form);
    const auto to_next = c.code.jump(PlanOp::kJump, form);
    c.code.patch_jump(to_exit);
    c.code.leave_to(*c.code.lookup(BindingKind::kBlock, ""), form);
    c.code.patch_jump(to_next);
    if (name == "every") c.code.store(result, form);
  }
  end_list_loop(c, loop, form);
  c.code.load(result, form);
  if (name == "mapcar") c.code.builtin("reverse", 1, form);
  c.code.squeeze(3, form);
  c.code.cut_scope(scope);
  c.code.close_block(block);
}

struct LoopState {
  std::vector<std::size_t> end_jumps;
  std::vector<std::uint32_t> places;  // of each clause's first variable
  std::uint32_t result = 0;
  std::uint32_t height = 0;  // before the loop's variables
};

/// Pushes the variables of an iteration clause and notes the place of the first one.
void loop_prologue(FormCompiler& c, const LoopClause& clause, DatumId form, LoopState& state) {
  state.places.push_back(c.code.height());
  const auto constant = [&](const std::optional<DatumId>& datum, int fallback) {
    if (datum) return c.compile(*datum);
    c.code.constant(c.values.number(Number(fallback)), form);
  };
  switch (clause.kind) {
    case LoopKind::kIn:
      c.compile(*clause.form);
      c.code.emit(PlanOp::kExpectList, 0, 0, form);
      c.nil(form);
      c.code.bind_top(clause.variable);
      return;
    case LoopKind::kRange:
      constant(clause.form, 0);
      constant(clause.limit, 0);
      constant(clause.step, 1);
      c.code.show(c.code.named(BindingKind::kVariable, clause.variable, state.places.back()));
      return;
    case LoopKind::kRepeat:
      c.compile(*clause.form);
      return;
    case LoopKind::kWhile:
    case LoopKind::kUntil:
    case LoopKind::kDo:
    case LoopKind::kCollect:
      return;
  }
}

/// At the top of the loop: leave if the clause is through, else set its variable.
void loop_test(FormCompiler& c, const LoopClause& clause, std::uint32_t place, DatumId form,
               LoopState& state) {
  switch (clause.kind) {
    case LoopKind::kIn:
      c.code.load(place, form);
      state.end_jumps.push_back(c.code.jump(PlanOp::kJumpIfNil, form));
      c.code.load(place, form);
      c.code.builtin("car", 1, form);
      c.code.store_and_drop(place + 1, form);
      c.code.load(place, form);
      c.code.builtin("cdr", 1, form);
      c.code.store_and_drop(place, form);
      return;
    case LoopKind::kRange:
      if (!clause.limit) return;
      c.code.load(place, form);
      c.code.load(place + 1, form);
      c.code.builtin(
          clause.down ? (clause.exclusive ? ">" : ">=") : (clause.exclusive ? "<" : "<="), 2, form);
      state.end_jumps.push_back(c.code.jump(PlanOp::kJumpIfNil, form));
      return;
    case LoopKind::kRepeat:
      c.code.load(place, form);
      c.code.constant(c.values.number(Number(0)), form);
      c.code.builtin(">", 2, form);
      state.end_jumps.push_back(c.code.jump(PlanOp::kJumpIfNil, form));
      c.code.load(place, form);
      c.code.builtin("1-", 1, form);
      c.code.store_and_drop(place, form);
      return;
    case LoopKind::kWhile:
    case LoopKind::kUntil:
    case LoopKind::kDo:
    case LoopKind::kCollect:
      return;
  }
}

void loop_body(FormCompiler& c, const LoopClause& clause, DatumId form, LoopState& state) {
  switch (clause.kind) {
    case LoopKind::kWhile:
    case LoopKind::kUntil:
      c.compile(*clause.form);
      if (clause.kind == LoopKind::kUntil) c.code.builtin("null", 1, form);
      state.end_jumps.push_back(c.code.jump(PlanOp::kJumpIfNil, form));
      return;
    case LoopKind::kDo:
      for (const auto item : clause.body) {
        c.compile(item);
        c.code.drop(item);
      }
      return;
    case LoopKind::kCollect:
      c.compile(*clause.form);
      c.code.load(state.result, form);
      c.code.builtin("cons", 2, form);
      c.code.store_and_drop(state.result, form);
      return;
    case LoopKind::kIn:
    case LoopKind::kRange:
    case LoopKind::kRepeat:
      return;
  }
}

void loop_step(FormCompiler& c, const LoopClause& clause, std::uint32_t place, DatumId form) {
  if (clause.kind != LoopKind::kRange) return;
  c.code.load(place, form);
  c.code.load(place + 2, form);
  c.code.builtin(clause.down ? "-" : "+", 2, form);
  c.code.store_and_drop(place, form);
}

void compile_loop(FormCompiler& c, DatumId form, const std::vector<LoopClause>& clauses) {
  LoopState state;
  const auto block = c.code.open_block("nil");
  state.height = c.code.height();
  c.nil(form);
  state.result = state.height;
  bool bounded = false;
  for (const auto& clause : clauses) {
    loop_prologue(c, clause, form, state);
    bounded = bounded || clause.bounded();
  }
  std::optional<std::uint32_t> counter;
  if (!bounded) {
    c.code.constant(c.values.counter(0), form);
    counter = c.code.height() - 1;
  }
  const auto top = c.code.here();
  if (counter) c.code.emit(PlanOp::kTick, *counter, 0, form);
  for (std::size_t i = 0; i < clauses.size(); ++i) {
    loop_test(c, clauses[i], state.places[i], form, state);
  }
  for (const auto& clause : clauses) loop_body(c, clause, form, state);
  for (std::size_t i = 0; i < clauses.size(); ++i) loop_step(c, clauses[i], state.places[i], form);
  c.code.jump_back(top, form);
  for (const auto jump : state.end_jumps) c.code.patch_jump(jump);
  c.code.load(state.result, form);
  c.code.builtin("reverse", 1, form);
  const auto count = c.code.height() - 1 - state.height;
  c.code.squeeze(count, form);
  c.code.close_block(block);
}

void form_loop(FormCompiler& c, DatumId form, FormItems items) {
  const auto clauses = parse_loop(c.data, items.subspan(1));
  if (const auto* error = std::get_if<LoopError>(&clauses)) {
    c.unsupported(error->at.value_or(form), error->text);
    return c.nil(form);
  }
  compile_loop(c, form, std::get<std::vector<LoopClause>>(clauses));
}

}  // namespace

std::span<const FormEntry> loop_forms() {
  static constexpr FormEntry kForms[] = {
      {"dolist", form_dolist}, {"dotimes", form_dotimes}, {"loop", form_loop}, {"mapcar", form_map},
      {"mapc", form_map},      {"every", form_map},       {"some", form_map},
  };
  return kForms;
}

}  // namespace parallax::compiler
