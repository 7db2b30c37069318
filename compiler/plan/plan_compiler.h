#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "compiler/base/result.h"
#include "compiler/plan/lisp_reader.h"
#include "compiler/plan/loop_clauses.h"
#include "compiler/plan/plan_code.h"
#include "compiler/plan/plan_value.h"

namespace parallax::compiler {

/// Turns the forms of a plan into code for the unroller's machine. One member function per form,
/// in forms_<topic>.cc; every compile_ function emits code that leaves one more value on the stack.
/// Reports everything it meets, also on paths that no execution takes, and goes on.
class PlanCompiler {
 public:
  /// `interleave`: the branches of `par` take turns; otherwise they run in written order (W-PAR).
  PlanCompiler(const LispText& text, ValueStore& values, base::DiagnosticSink& sink,
               bool interleave = false)
      : text_(text), data_(text.data), values_(values), sink_(sink), interleave_(interleave) {}

  /// `entry` names the function to run; without it the bare top-level forms run, or else the last
  /// function defined. CPL006 if there is nothing to run.
  base::Result<PlanCode> compile(const std::optional<std::string>& entry);

 private:
  using Items = std::span<const DatumId>;
  using FormFunction = void (PlanCompiler::*)(DatumId form, Items items);

  enum class BindingKind : std::uint8_t { kVariable, kCounter, kBlock, kFunction, kRetry };
  /// A name that is visible here. Frames are counted from the outermost unit being compiled.
  struct LexicalBinding {
    BindingKind kind = BindingKind::kVariable;
    std::string name;
    std::uint32_t frame = 0;
    std::uint32_t index = 0;  // variable: place in the frame; block, retry: exit; function: unit
  };
  struct UnitContext {
    std::uint32_t unit = 0;
    std::uint32_t height = 0;
    std::uint32_t guards = 0;
  };
  struct Parameter {
    std::string name;
    std::string keyword;  // not empty: passed by `:keyword`
    bool optional = false;
    std::optional<DatumId> default_value;
  };
  struct Function {
    std::uint32_t unit = 0;
    std::vector<Parameter> parameters;
    DatumId source;
  };
  struct Block {
    std::uint32_t exit = 0;
    std::size_t scope = 0;
  };

  // --- plan_compiler.cc: driver, emitting, scopes
  static const std::map<std::string_view, FormFunction>& forms();
  void collect_definitions();
  void compile_functions();
  void compile_main(const std::optional<std::string>& entry);
  void compile(DatumId form);
  void compile_symbol(DatumId symbol);
  void compile_list(DatumId form);
  void compile_body(Items body);  // progn; docstring-free
  std::size_t emit(PlanOp op, std::uint32_t a, std::uint32_t b, DatumId source);
  void emit_constant(ValueId value, DatumId source);
  std::size_t emit_jump(PlanOp op, DatumId source);
  void patch_jump(std::size_t at);
  std::uint32_t here() const;
  std::uint32_t string_index(std::string_view text);
  void adjust(int change);
  UnitContext& frame() { return frames_.back(); }
  std::uint32_t declare_unit(std::string_view name, DatumId source, std::uint32_t parameters);
  void enter_unit(std::uint32_t unit);
  void leave_unit(PlanOp last, DatumId source);
  void bind_variable(std::string_view name);  // the value on top
  const LexicalBinding* lookup(BindingKind kind, std::string_view name) const;
  std::uint32_t level_of(const LexicalBinding& binding) const;
  void emit_variable(PlanOp op, const LexicalBinding& binding, DatumId source);
  Block open_block(std::string_view name);
  void close_block(const Block& block);
  void emit_exit(const LexicalBinding& target, DatumId source);

  // --- forms_error.cc: messages
  void malformed(DatumId form, std::string_view text);
  void unsupported(DatumId form, std::string_view text);
  void unknown_form(DatumId form, std::string_view name);
  bool check_no_perform(DatumId form);
  std::string form_name(DatumId form) const;

  // --- forms_binding.cc
  void form_quote(DatumId form, Items items);
  void form_quasiquote(DatumId form, Items items);
  void quasiquote(DatumId datum);
  void form_let(DatumId form, Items items);
  void form_let_star(DatumId form, Items items);
  void let(DatumId form, Items items, bool sequential);
  void form_setf(DatumId form, Items items);
  void form_incf(DatumId form, Items items);
  void form_push(DatumId form, Items items);
  void form_destructuring_bind(DatumId form, Items items);
  void destructure(DatumId form, DatumId pattern, std::uint32_t place);
  const LexicalBinding* assignable(DatumId form, DatumId place);
  ValueId datum_value(DatumId datum);

  // --- forms_control.cc
  void form_progn(DatumId form, Items items);
  void form_par(DatumId form, Items items);
  void par_by_turns(DatumId form, Items branches);
  void form_skip_argument(DatumId form, Items items);
  void form_if(DatumId form, Items items);
  void form_when(DatumId form, Items items);
  void form_unless(DatumId form, Items items);
  void form_cond(DatumId form, Items items);
  void form_case(DatumId form, Items items);
  void form_and(DatumId form, Items items);
  void form_or(DatumId form, Items items);
  void form_block(DatumId form, Items items);
  void form_return(DatumId form, Items items);
  void form_return_from(DatumId form, Items items);
  void form_ignored(DatumId form, Items items);
  void form_projection_check(DatumId form, Items items);
  void form_holds(DatumId form, Items items);
  void return_from(DatumId form, std::string_view block, std::optional<DatumId> value);
  void case_clause_test(DatumId key, std::uint32_t place, DatumId source);

  // --- forms_loop.cc
  void form_dolist(DatumId form, Items items);
  void form_dotimes(DatumId form, Items items);
  void form_loop(DatumId form, Items items);
  void form_map(DatumId form, Items items);
  void form_try_each(DatumId form, Items items);
  struct LoopState {
    std::vector<std::size_t> end_jumps;
    std::vector<std::uint32_t> places;  // of each clause's first variable
    std::uint32_t result = 0;
    std::uint32_t height = 0;  // before the loop's variables
  };
  void compile_loop(DatumId form, const std::vector<LoopClause>& clauses);
  void loop_prologue(const LoopClause& clause, DatumId form, LoopState& state);
  void loop_test(const LoopClause& clause, std::uint32_t place, DatumId form, LoopState& state);
  void loop_body(const LoopClause& clause, DatumId form, LoopState& state);
  void loop_step(const LoopClause& clause, std::uint32_t place, DatumId form);
  struct ListLoop {
    std::uint32_t list = 0;  // place of the rest of the list
    std::uint32_t item = 0;  // place of the current element
    std::uint32_t top = 0;
    std::size_t end_jump = 0;
  };
  ListLoop begin_list_loop(std::string_view variable, DatumId source);
  void end_list_loop(const ListLoop& loop, DatumId source);
  void emit_builtin(std::string_view name, std::uint32_t arguments, DatumId source);
  void emit_local(PlanOp op, std::uint32_t place, DatumId source);
  void store_and_drop(std::uint32_t place, DatumId source);

  // --- forms_failure.cc
  void form_with_failure_handling(DatumId form, Items items);
  void form_handle_failure(DatumId form, Items items);
  void form_with_retry_counters(DatumId form, Items items);
  void form_do_retry(DatumId form, Items items);
  void form_get_counter(DatumId form, Items items);
  void form_reset_counter(DatumId form, Items items);
  void form_retry(DatumId form, Items items);
  void form_fail(DatumId form, Items items);
  void form_unwind_protect(DatumId form, Items items);
  void form_try_in_order(DatumId form, Items items);
  struct HandlerSource {
    std::vector<DatumId> classes;
    std::optional<DatumId> variable;
    Items body;
    DatumId source;
  };
  void handling(DatumId form, const std::vector<HandlerSource>& handlers, Items body);
  std::vector<DatumId> class_list(DatumId datum);
  std::optional<std::string> failure_class(DatumId datum);
  std::uint32_t compile_handler(const HandlerSource& handler, std::uint32_t retry_exit);
  std::uint32_t catch_all(std::uint32_t exit, DatumId source);
  const LexicalBinding* counter(DatumId form, Items items);

  // --- forms_designator.cc
  void form_designator(DatumId form, Items items);
  void form_perform(DatumId form, Items items);
  void designator_pair(DatumId pair);
  void designator_value(DatumId value);

  // --- forms_call.cc
  /// What a call goes to: a unit (global, or local with the distance of its frame) or a built-in.
  struct Callee {
    const Function* function = nullptr;
    std::optional<std::uint32_t> level;
    std::optional<std::uint32_t> builtin;
  };
  void form_funcall(DatumId form, Items items);
  void form_apply(DatumId form, Items items);
  void form_flet(DatumId form, Items items);
  std::optional<Callee> find_callee(std::string_view name) const;
  std::optional<Callee> resolve_callee(DatumId form, DatumId function);
  void call(DatumId form, std::string_view name, const Callee& callee, Items arguments);
  bool push_arguments(DatumId form, std::string_view name, const Function& function,
                      Items arguments);
  void emit_call(const Callee& callee, std::uint32_t count, DatumId source);
  Items without_test_argument(DatumId form, Items arguments);

  // --- definitions.cc
  struct Signature {
    std::vector<Parameter> parameters;
    bool good = true;
  };
  Signature parameter_list(DatumId form, DatumId list);
  void parameter(DatumId form, DatumId item, std::string_view mode, Signature& out);
  Function declare_function(DatumId form, std::string_view name, DatumId parameters);
  void compile_function(const Function& function, std::string_view block_name, Items body);
  bool define_name(DatumId form, DatumId name);
  void define_function(DatumId form, Items items);
  void define_global(DatumId form, Items items);
  void define_condition(DatumId form, Items items);
  Items skip_declarations(Items body) const;

  const LispText& text_;
  const LispData& data_;
  ValueStore& values_;
  base::DiagnosticSink& sink_;
  bool interleave_;
  PlanCode code_;
  std::vector<UnitContext> frames_;
  std::vector<LexicalBinding> scope_;
  std::map<std::string, Function, std::less<>> functions_;
  std::vector<std::string> function_order_;
  std::map<std::uint32_t, Function> local_functions_;  // by unit
  std::map<std::string, std::uint32_t, std::less<>> globals_;
  std::map<std::string, DatumId, std::less<>> defined_;
  std::map<std::string, std::uint32_t, std::less<>> string_ids_;
  std::vector<DatumId> global_forms_;
  std::vector<DatumId> bare_forms_;
  bool failed_ = false;
};

}  // namespace parallax::compiler
