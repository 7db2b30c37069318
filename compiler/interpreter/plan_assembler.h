#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/interpreter/plan_compiler.h"

namespace parallax::compiler {

/// kSpecial: a global that is rebound, its number is the index. kTask: no name; what is around it
/// belongs to another task. kMacro: of a `macrolet`. kTag: of a `tagbody`.
enum class BindingKind : std::uint8_t {
  kVariable,
  kCounter,
  kBlock,
  kFunction,
  kRetry,
  kSpecial,
  kTask,
  kMacro,
  kTag
};

/// A name that is visible here. Frames are counted from the outermost unit being written.
struct LexicalBinding {
  BindingKind kind = BindingKind::kVariable;
  std::string name;
  std::uint32_t frame = 0;
  std::uint32_t index = 0;   // variable: place in the frame; block, retry: exit; function: unit
  std::uint32_t height = 0;  // of the stack when it was named
  std::uint32_t serial = 0;  // of a name that was shown: tells variables apart
};

/// Writes the code of a plan unit by unit: knows how high the stack of each open unit stands, which
/// names are visible, and which jumps and exits still lack their targets. It knows nothing of Lisp;
/// each call writes one instruction or one small pattern.
class PlanAssembler {
 public:
  // --- instructions
  std::size_t emit(PlanOp op, std::uint32_t a, std::uint32_t b, DatumId source);
  /// The stack is so much higher than the instructions so far say.
  void adjust(int change);
  std::uint32_t height() const { return frames_.back().height; }
  /// After an error, when a form has stopped half-way.
  void set_height(std::uint32_t height) { frames_.back().height = height; }
  void constant(ValueId value, DatumId source);
  void builtin(std::string_view name, std::uint32_t arguments, DatumId source);
  void drop(DatumId source);
  /// Drops `count` values below the top.
  void squeeze(std::uint32_t count, DatumId source);
  void fail(std::string_view failure_class, DatumId source);
  std::uint32_t string_index(std::string_view text);

  // --- jumps and exits
  std::uint32_t here() const;
  /// A jump whose target is not known yet; a conditional one takes its test off the stack.
  std::size_t jump(PlanOp op, DatumId source);
  void jump_back(std::uint32_t to, DatumId source) { emit(PlanOp::kJump, to, 0, source); }
  void patch_jump(std::size_t at);
  /// A place that control leaves for with one value more than the stack has now; set_exit says
  /// where it is.
  std::uint32_t open_exit();
  void set_exit(std::uint32_t exit) { code_.exits[exit].pc = here(); }
  void leave_to(const LexicalBinding& target, DatumId source);
  struct Block {
    std::uint32_t exit = 0;
    std::size_t scope = 0;
  };
  Block open_block(std::string_view name);
  /// The block ends here, one value higher than it began: that of its form.
  void close_block(const Block& block);

  // --- failures
  std::uint32_t add_handlers(std::vector<HandlerClause> table);
  void push_handlers(std::uint32_t table, DatumId source);
  void push_cleanup(std::uint32_t unit, DatumId source);
  /// Opens a task of its own for the code that follows, up to close_task.
  std::size_t open_task(DatumId source);
  void close_task(std::size_t scope, DatumId source);
  /// Up to pop_guard, the global means the value at `place` of the open unit.
  void bind_special(std::uint32_t global, std::uint32_t place, DatumId source);
  void pop_guard(DatumId source);

  // --- units
  std::uint32_t declare_unit(std::string_view name, DatumId source, std::uint32_t parameters);
  void enter_unit(std::uint32_t unit);
  void leave_unit(PlanOp last, DatumId source);
  /// The branches of a `par` or `pursue`, each a unit, which take turns.
  void par(std::vector<std::uint32_t> units, bool pursue, DatumId source);
  /// The unit being written, set aside while a unit of its own is written in between.
  struct Suspended;
  Suspended suspend();
  void resume(Suspended outside);

  // --- function values
  /// Opens the unit of a function value; leave_unit closes it. Variables that it uses and that
  /// never change go along with it; what else it uses from outside, it shares.
  void enter_function_value(std::uint32_t unit);
  /// Pushes the value of the unit that was left just now.
  void function_value(std::uint32_t unit, DatumId source);
  /// Pushes a function that is no unit of its own: one of the plan, a built-in, a local function.
  void function_value(FunctionTemplate made, DatumId source);
  void local_function_value(const LexicalBinding& local, DatumId source);
  void call_value(std::uint32_t arguments, bool spread, DatumId source);
  /// A call of the local function follows.
  void note_local_call(const LexicalBinding& local) { note_use(local, local.height, false); }
  /// The variable changes after it was bound.
  void note_change(const LexicalBinding& variable) { changed_.insert(variable.serial); }

  // --- names
  /// A name of the open unit, not visible yet.
  LexicalBinding named(BindingKind kind, std::string_view name, std::uint32_t index) const;
  void show(LexicalBinding binding) {
    binding.serial = ++serials_;
    scope_.push_back(std::move(binding));
  }
  void show(const std::vector<LexicalBinding>& bindings);
  const std::vector<LexicalBinding>& scope() const { return scope_; }
  void cut_scope(std::size_t size) { scope_.resize(size); }
  const LexicalBinding* lookup(BindingKind kind, std::string_view name) const;
  /// Does a task begin between here and the name, which `lookup` gave?
  bool in_other_task(const LexicalBinding& binding) const;
  /// How many units out the name belongs to.
  std::uint32_t level_of(const LexicalBinding& binding) const;
  void load(const LexicalBinding& binding, DatumId source);
  void store(const LexicalBinding& binding, DatumId source);
  void load(std::uint32_t place, DatumId source);  // of the open unit
  void store(std::uint32_t place, DatumId source);
  void store_and_drop(std::uint32_t place, DatumId source);

  PlanCode& code() { return code_; }
  const PlanCode& code() const { return code_; }

 private:
  struct Frame {
    std::uint32_t unit = 0;
    std::uint32_t height = 0;
    std::uint32_t guards = 0;
    bool is_value = false;  // its unit becomes a function value
  };
  /// A function value around a use of an outer variable.
  struct ValueFrame {
    std::uint32_t unit = 0;
    std::uint32_t depth = 0;
  };
  struct OuterUse {
    std::uint32_t unit = 0;
    std::size_t at = 0;  // the instruction, of a load
    std::uint32_t depth = 0;
    std::vector<ValueFrame> values;  // outermost first; not empty
    std::uint32_t frame = 0;         // where the variable is
    std::uint32_t index = 0;
    std::optional<std::uint32_t> serial;  // of the variable that is loaded; none: shared
  };
  std::uint32_t depth() const { return static_cast<std::uint32_t>(frames_.size() - 1); }
  void note_use(const LexicalBinding& binding, std::uint32_t index, bool is_load);
  void resolve_uses();
  void keep(const OuterUse& use);

  PlanCode code_;
  std::vector<Frame> frames_;
  std::vector<LexicalBinding> scope_;  // the innermost last
  std::uint32_t serials_ = 0;
  std::set<std::uint32_t> changed_;
  std::vector<OuterUse> uses_;
  std::map<std::uint32_t, std::uint32_t> values_made_;                     // unit -> its template
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> kept_;  // unit, serial -> slot
  std::map<std::string, std::uint32_t, std::less<>> string_ids_;
};

struct PlanAssembler::Suspended {
  std::vector<Frame> frames;
  std::vector<LexicalBinding> scope;
  std::vector<OuterUse> uses;
};

}  // namespace parallax::compiler
