// The extended `loop`. Its variables lie on the stack from the first clause to the last one; at the
// top of each round every `for` ends the loop or sets its variable, then the other clauses follow.
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "compiler/interpreter/form_compiler.h"
#include "compiler/interpreter/function_calls.h"
#include "compiler/interpreter/loop_clauses.h"
#include "compiler/interpreter/variables.h"

namespace parallax::compiler {
namespace {

class LoopCompiler {
 public:
  LoopCompiler(FormCompiler& c, DatumId form, const LoopClauses& loop)
      : c_(c), form_(form), loop_(loop) {}

  void compile() {
    const auto block = c_.code.open_block(loop_.name);
    out_ = c_.code.scope().size() - 1;
    const auto height = c_.code.height();
    collect_results(loop_.clauses);
    push_result();
    push_into(loop_.clauses);
    prologue();
    for (const auto& clause : loop_.clauses) {
      if (clause.kind == LoopKind::kInitially) compile_all(clause.body);
    }
    const auto top = c_.code.here();
    if (counter_) c_.code.emit(PlanOp::kTick, *counter_, 0, form_);
    for (std::size_t i = 0; i < loop_.clauses.size(); ++i) next(loop_.clauses[i], places_[i]);
    if (first_) {
      c_.nil(form_);
      c_.code.store_and_drop(*first_, form_);
    }
    for (const auto& clause : loop_.clauses) body(clause);
    for (std::size_t i = 0; i < loop_.clauses.size(); ++i) {
      if (!first_) step(loop_.clauses[i], places_[i]);
    }
    c_.code.jump_back(top, form_);
    for (const auto jump : end_jumps_) c_.code.patch_jump(jump);
    for (const auto& clause : loop_.clauses) {
      if (clause.kind == LoopKind::kFinally) compile_all(clause.body);
    }
    c_.code.load(height, form_);
    if (is_list_) c_.code.builtin("reverse", 1, form_);
    close_variables(c_, out_ + 1, c_.code.height() - 1 - height, form_);
    c_.code.close_block(block);
  }

 private:
  void compile_all(const std::vector<DatumId>& forms) {
    for (const auto item : forms) {
      c_.compile(item);
      c_.code.drop(item);
    }
  }

  /// Notes which kinds of result the clauses without `into` collect.
  void collect_results(const std::vector<LoopClause>& clauses) {
    for (const auto& clause : clauses) {
      collect_results(clause.inner);
      collect_results(clause.otherwise);
      const auto kind = clause.kind;
      if (kind == LoopKind::kAlways || kind == LoopKind::kNever) is_true_ = true;
      if (!clause.into.empty()) continue;
      is_list_ = is_list_ || kind == LoopKind::kCollect || kind == LoopKind::kAppend;
      is_number_ = is_number_ || kind == LoopKind::kSum || kind == LoopKind::kCount;
    }
  }

  ValueId zero() { return c_.values.number(Number(0)); }

  void push_result() {
    result_ = c_.code.height();
    const auto start = is_number_ ? zero() : (is_true_ ? c_.values.truth() : c_.values.nil());
    c_.code.constant(start, form_);
  }

  void push_into(const std::vector<LoopClause>& clauses) {
    for (const auto& clause : clauses) {
      if (!clause.into.empty() && !into_.contains(clause.into)) {
        const bool number = clause.kind == LoopKind::kSum || clause.kind == LoopKind::kCount;
        c_.code.constant(number ? zero() : c_.values.nil(), form_);
        into_.emplace(clause.into, c_.code.height() - 1);
        bind_changing(*clause.result, c_.code.height() - 1);
      }
      push_into(clause.inner);
      push_into(clause.otherwise);
    }
  }

  void bind_changing(DatumId name, std::uint32_t place) {
    bind_variable(c_, name, place, form_);
    c_.code.note_change(c_.code.scope().back());
  }

  /// Slots for the names of a pattern, nil.
  void push_names(DatumId pattern) {
    if (c_.data.is_nil(pattern)) return;
    if (c_.data.is_list(pattern)) {
      for (const auto part : c_.data.children(pattern)) push_names(part);
      return;
    }
    if (!c_.data.is_symbol(pattern)) return c_.unsupported(pattern, "a pattern consists of names");
    c_.nil(form_);
    slots_.emplace(pattern.index(), c_.code.height() - 1);
    bind_changing(pattern, c_.code.height() - 1);
  }

  /// The parts of the value on top into the slots of the pattern; missing ones are nil.
  void assign(DatumId pattern) {
    if (c_.data.is_nil(pattern)) return c_.code.drop(form_);
    if (!c_.data.is_list(pattern)) {
      const auto slot = slots_.find(pattern.index());
      if (slot != slots_.end()) c_.code.store(slot->second, form_);
      return c_.code.drop(form_);
    }
    const auto items = c_.data.children(pattern);
    const bool dotted = c_.data.is_dotted(pattern);
    for (std::size_t i = 0; i < items.size(); ++i) {
      if (dotted && i + 1 == items.size()) return assign(items[i]);
      c_.code.load(c_.code.height() - 1, form_);
      c_.code.builtin("car", 1, form_);
      assign(items[i]);
      c_.code.builtin("cdr", 1, form_);
    }
    c_.code.drop(form_);
  }

  void prologue() {
    bool bounded = c_.data.in_library(form_);  // our own Lisp ends
    bool first = false;
    bool finally = false;
    for (const auto& clause : loop_.clauses) {
      finally = finally || clause.kind == LoopKind::kFinally;
    }
    std::vector<LexicalBinding> waiting;  // joined by `and`: not visible yet
    for (const auto& clause : loop_.clauses) {
      if (!clause.joined) {
        c_.code.show(waiting);
        waiting.clear();
      }
      places_.push_back(c_.code.height());
      push_variables(clause);
      bounded = bounded || clause.bounded();
      first = first || clause.then || (finally && clause.kind == LoopKind::kRange);
    }
    if (!bounded) {
      c_.code.constant(c_.values.counter(0), form_);
      counter_ = c_.code.height() - 1;
    }
    if (!first) return;
    c_.code.constant(c_.values.truth(), form_);
    first_ = c_.code.height() - 1;
  }

  void push_form(const std::optional<DatumId>& datum, int fallback) {
    if (datum) return c_.compile(*datum);
    c_.code.constant(c_.values.number(Number(fallback)), form_);
  }

  void push_variables(const LoopClause& clause) {
    switch (clause.kind) {
      case LoopKind::kIn:
      case LoopKind::kOn:
        c_.compile(*clause.form);
        if (!clause.list.empty()) c_.code.builtin(clause.list, 1, form_);
        if (clause.kind == LoopKind::kIn) c_.code.emit(PlanOp::kExpectList, 0, 0, form_);
        if (clause.step) steps_.emplace(&clause, prepare_function(c_, form_, *clause.step));
        if (clause.second) push_names(*clause.second);
        return push_names(*clause.variable);
      case LoopKind::kRange:
        push_form(clause.form, 0);
        push_form(clause.limit, 0);
        push_form(clause.step, 1);
        return bind_changing(*clause.variable, places_.back());
      case LoopKind::kEquals:
        return push_names(*clause.variable);
      case LoopKind::kWith:
        push_names_of_with(clause);
        return;
      case LoopKind::kRepeat:
        return c_.compile(*clause.form);
      case LoopKind::kWhile:
      case LoopKind::kUntil:
      case LoopKind::kDo:
      case LoopKind::kCollect:
      case LoopKind::kAppend:
      case LoopKind::kSum:
      case LoopKind::kCount:
      case LoopKind::kMaximize:
      case LoopKind::kMinimize:
      case LoopKind::kWhen:
      case LoopKind::kReturn:
      case LoopKind::kAlways:
      case LoopKind::kNever:
      case LoopKind::kThereis:
      case LoopKind::kInitially:
      case LoopKind::kFinally:
        return;
    }
  }

  void push_names_of_with(const LoopClause& clause) {
    if (!clause.form) return push_names(*clause.variable);
    c_.compile(*clause.form);
    if (c_.data.is_symbol(*clause.variable) && !c_.data.is_nil(*clause.variable)) {
      return bind_top(c_, *clause.variable, form_);
    }
    const auto value = c_.code.height() - 1;
    push_names(*clause.variable);
    c_.code.load(value, form_);
    assign(*clause.variable);
  }

  void end_if_nil() { end_jumps_.push_back(c_.code.jump(PlanOp::kJumpIfNil, form_)); }

  /// At the top of a round: leaves the loop if the clause is through, else sets its variable.
  void next(const LoopClause& clause, std::uint32_t place) {
    if (clause.kind == LoopKind::kIn || clause.kind == LoopKind::kOn) {
      c_.code.load(place, form_);
      if (clause.kind == LoopKind::kOn) c_.code.builtin("consp", 1, form_);
      end_if_nil();
      c_.code.load(place, form_);
      if (clause.kind == LoopKind::kIn) c_.code.builtin("car", 1, form_);
      if (clause.second) {
        c_.code.load(c_.code.height() - 1, form_);
        c_.code.builtin(clause.values ? "cdr" : "car", 1, form_);
        assign(*clause.variable);
        c_.code.builtin(clause.values ? "car" : "cdr", 1, form_);
        assign(*clause.second);
      } else {
        assign(*clause.variable);
      }
      const auto by = steps_.find(&clause);
      if (by != steps_.end()) push_prepared(c_, by->second, form_);
      c_.code.load(place, form_);
      if (by != steps_.end()) {
        call_prepared(c_, by->second, 1, form_);
      } else {
        c_.code.builtin("cdr", 1, form_);
      }
      c_.code.store_and_drop(place, form_);
    } else if (clause.kind == LoopKind::kRange) {
      if (first_) step_unless_first(clause, place);
      if (!clause.limit) return;
      c_.code.load(place, form_);
      c_.code.load(place + 1, form_);
      const std::string_view down = clause.exclusive ? ">" : ">=";
      const std::string_view up = clause.exclusive ? "<" : "<=";
      c_.code.builtin(clause.down ? down : up, 2, form_);
      end_if_nil();
    } else if (clause.kind == LoopKind::kEquals) {
      equals(clause);
    } else if (clause.kind == LoopKind::kRepeat) {
      c_.code.load(place, form_);
      c_.code.constant(zero(), form_);
      c_.code.builtin(">", 2, form_);
      end_if_nil();
      c_.code.load(place, form_);
      c_.code.builtin("1-", 1, form_);
      c_.code.store_and_drop(place, form_);
    }
  }

  void step_unless_first(const LoopClause& clause, std::uint32_t place) {
    c_.code.load(*first_, form_);
    c_.code.builtin("null", 1, form_);
    const auto to_test = c_.code.jump(PlanOp::kJumpIfNil, form_);
    step(clause, place);
    c_.code.patch_jump(to_test);
  }

  void equals(const LoopClause& clause) {
    if (!clause.then) {
      c_.compile(*clause.form);
      return assign(*clause.variable);
    }
    c_.code.load(*first_, form_);
    const auto to_then = c_.code.jump(PlanOp::kJumpIfNil, form_);
    c_.compile(*clause.form);
    const auto to_end = c_.code.jump(PlanOp::kJump, form_);
    c_.code.adjust(-1);
    c_.code.patch_jump(to_then);
    c_.compile(*clause.then);
    c_.code.patch_jump(to_end);
    assign(*clause.variable);
  }

  void step(const LoopClause& clause, std::uint32_t place) {
    if (clause.kind != LoopKind::kRange) return;
    c_.code.load(place, form_);
    c_.code.load(place + 2, form_);
    c_.code.builtin(clause.down ? "-" : "+", 2, form_);
    c_.code.store_and_drop(place, form_);
  }

  void body(const LoopClause& clause) {
    switch (clause.kind) {
      case LoopKind::kWhile:
      case LoopKind::kUntil:
        c_.compile(*clause.form);
        if (clause.kind == LoopKind::kUntil) c_.code.builtin("null", 1, form_);
        return end_if_nil();
      case LoopKind::kDo:
        return compile_all(clause.body);
      case LoopKind::kWhen:
        return when(clause);
      case LoopKind::kReturn:
        c_.compile(*clause.form);
        c_.code.leave_to(c_.code.scope()[out_], form_);
        return c_.code.drop(form_);  // never reached: the stack is as high as before the clause
      case LoopKind::kAlways:
      case LoopKind::kNever:
      case LoopKind::kThereis:
        return decide(clause);
      case LoopKind::kCollect:
      case LoopKind::kAppend:
      case LoopKind::kSum:
      case LoopKind::kCount:
      case LoopKind::kMaximize:
      case LoopKind::kMinimize:
        return accumulate(clause);
      case LoopKind::kIn:
      case LoopKind::kOn:
      case LoopKind::kRange:
      case LoopKind::kEquals:
      case LoopKind::kRepeat:
      case LoopKind::kWith:
      case LoopKind::kInitially:
      case LoopKind::kFinally:
        return;
    }
  }

  void when(const LoopClause& clause) {
    c_.compile(*clause.form);
    if (clause.negated) c_.code.builtin("null", 1, form_);
    const auto to_else = c_.code.jump(PlanOp::kJumpIfNil, form_);
    for (const auto& inner : clause.inner) body(inner);
    if (clause.otherwise.empty()) return c_.code.patch_jump(to_else);
    const auto to_end = c_.code.jump(PlanOp::kJump, form_);
    c_.code.patch_jump(to_else);
    for (const auto& inner : clause.otherwise) body(inner);
    c_.code.patch_jump(to_end);
  }

  /// always, never and thereis leave the loop at once, without `finally`.
  void decide(const LoopClause& clause) {
    c_.compile(*clause.form);
    const auto value = c_.code.height() - 1;
    c_.code.load(value, form_);
    if (clause.kind == LoopKind::kAlways) c_.code.builtin("null", 1, form_);
    const auto to_next = c_.code.jump(PlanOp::kJumpIfNil, form_);
    if (clause.kind == LoopKind::kThereis) {
      c_.code.load(value, form_);
    } else {
      c_.nil(form_);
    }
    c_.code.leave_to(c_.code.scope()[out_], form_);
    c_.code.adjust(-1);
    c_.code.patch_jump(to_next);
    c_.code.drop(form_);
  }

  void accumulate(const LoopClause& clause) {
    const bool named = !clause.into.empty();
    const auto place = named ? into_.at(clause.into) : result_;
    const auto kind = clause.kind;
    if (kind == LoopKind::kCollect || kind == LoopKind::kAppend) {
      return accumulate_list(clause, place, named);
    }
    if (kind == LoopKind::kCount) {
      c_.compile(*clause.form);
      const auto to_end = c_.code.jump(PlanOp::kJumpIfNil, form_);
      c_.code.load(place, form_);
      c_.code.builtin("1+", 1, form_);
      c_.code.store_and_drop(place, form_);
      return c_.code.patch_jump(to_end);
    }
    c_.code.load(place, form_);
    c_.compile(*clause.form);
    const std::string_view best = kind == LoopKind::kMaximize ? "%larger" : "%smaller";
    c_.code.builtin(kind == LoopKind::kSum ? "+" : best, 2, form_);
    c_.code.store_and_drop(place, form_);
  }

  /// The result is collected the last element first; a variable of the plan's own in order.
  void accumulate_list(const LoopClause& clause, std::uint32_t place, bool named) {
    const bool collect = clause.kind == LoopKind::kCollect;
    if (named) {
      c_.code.load(place, form_);
      c_.compile(*clause.form);
      if (collect) c_.code.builtin("list", 1, form_);
      c_.code.builtin("append", 2, form_);
    } else if (collect) {
      c_.compile(*clause.form);
      c_.code.load(place, form_);
      c_.code.builtin("cons", 2, form_);
    } else {
      c_.compile(*clause.form);
      c_.code.load(place, form_);
      c_.code.load(c_.code.height() - 2, form_);
      c_.code.builtin("%append-reversed", 2, form_);
      c_.code.store_and_drop(place, form_);
      return c_.code.drop(form_);
    }
    c_.code.store_and_drop(place, form_);
  }

  FormCompiler& c_;
  DatumId form_;
  const LoopClauses& loop_;
  std::size_t out_ = 0;  // the block, in the scope
  std::vector<std::size_t> end_jumps_;
  std::vector<std::uint32_t> places_;             // of each clause's first variable
  std::map<std::uint32_t, std::uint32_t> slots_;  // of the names in patterns, by datum
  std::map<std::string, std::uint32_t> into_;
  std::map<const LoopClause*, FunctionArgument> steps_;
  std::uint32_t result_ = 0;
  std::optional<std::uint32_t> counter_;
  std::optional<std::uint32_t> first_;  // is this the first round?
  bool is_list_ = false;
  bool is_number_ = false;
  bool is_true_ = false;
};

void form_loop(FormCompiler& c, DatumId form, FormItems items) {
  const auto loop = parse_loop(c.data, items.subspan(1));
  if (const auto* error = std::get_if<LoopError>(&loop)) {
    c.unsupported(error->at.value_or(form), error->text);
    return c.nil(form);
  }
  LoopCompiler(c, form, std::get<LoopClauses>(loop)).compile();
}

}  // namespace

std::span<const FormEntry> loop_form() {
  static constexpr FormEntry kForms[] = {{"loop", form_loop}};
  return kForms;
}

}  // namespace parallax::compiler
