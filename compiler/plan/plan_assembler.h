#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/plan/plan_compiler.h"

namespace parallax::compiler {

/// kSpecial: a global that is rebound, its number is the index. kTask: no name; what is around it
/// belongs to another task.
enum class BindingKind : std::uint8_t {
  kVariable,
  kCounter,
  kBlock,
  kFunction,
  kRetry,
  kSpecial,
  kTask
};

/// A name that is visible here. Frames are counted from the outermost unit being written.
struct LexicalBinding {
  BindingKind kind = BindingKind::kVariable;
  std::string name;
  std::uint32_t frame = 0;
  std::uint32_t index = 0;  // variable: place in the frame; block, retry: exit; function: unit
};

/// Writes the code of a plan unit by unit: knows how high the stack of each open unit stands, which
/// names are visible, and where jumps and exits still want their targets. It knows nothing of Lisp;
/// what it writes is what it is told, one instruction or one small pattern a call.
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
  /// What follows is a task of its own, up to close_task.
  std::size_t open_task(DatumId source);
  void close_task(std::size_t scope, DatumId source);
  /// The value at `place` of the open unit is what the global means, up to pop_guard.
  void bind_special(std::uint32_t global, std::uint32_t place, DatumId source);
  void pop_guard(DatumId source);

  // --- units
  std::uint32_t declare_unit(std::string_view name, DatumId source, std::uint32_t parameters);
  void enter_unit(std::uint32_t unit);
  void leave_unit(PlanOp last, DatumId source);
  /// The branches of a `par` or `pursue`, each a unit, which take turns.
  void par(std::vector<std::uint32_t> units, bool pursue, DatumId source);

  // --- names
  /// A name of the open unit, not visible yet.
  LexicalBinding named(BindingKind kind, std::string_view name, std::uint32_t index) const;
  void show(LexicalBinding binding) { scope_.push_back(std::move(binding)); }
  void show(const std::vector<LexicalBinding>& bindings);
  /// Names the value on top; it stays until it is squeezed out.
  void bind_top(std::string_view name);
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
  };
  std::uint32_t depth() const { return static_cast<std::uint32_t>(frames_.size() - 1); }

  PlanCode code_;
  std::vector<Frame> frames_;
  std::vector<LexicalBinding> scope_;  // the innermost last
  std::map<std::string, std::uint32_t, std::less<>> string_ids_;
};

}  // namespace parallax::compiler
