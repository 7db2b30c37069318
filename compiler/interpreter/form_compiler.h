#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "compiler/builtins/plan_value.h"
#include "compiler/interpreter/plan_assembler.h"
#include "compiler/lisp/lisp_reader.h"

namespace parallax::compiler {

using FormItems = std::span<const DatumId>;

class MacroExpander;

struct PlanParameter {
  std::string name;
  DatumId symbol;
  std::string keyword;  // not empty: passed by `:keyword`
  bool optional = false;
  bool rest = false;  // the list of all further arguments
  std::optional<DatumId> default_value;
  // The default is no constant: the function computes it where nothing was passed.
  bool computed = false;
  std::optional<DatumId> supplied;  // a variable that says whether something was passed
};

/// A function of the plan, or a local one: its code is a unit.
struct PlanFunction {
  std::uint32_t unit = 0;
  std::vector<PlanParameter> parameters;
  DatumId source;
  std::vector<PlanParameter> variables = {};  // &aux: bound behind the parameters
  bool other_keys = false;                    // &allow-other-keys
  bool task = false;                          // its body is a task of its own: def-cram-function
  bool top_level = false;  // def-top-level-cram-function: nothing in a plan may call it
};

/// A macro: a unit that takes the whole call and returns its expansion.
struct PlanMacro {
  std::string name;
  std::uint32_t unit = 0;
  std::uint32_t driver = 0;  // a unit that calls it
  DatumId source;
  DatumId parameters;
  std::size_t position = 0;  // in the text
};

/// A function or a macro of the text whose code is written when somebody needs it, or at the end.
struct PlanUnitSource {
  PlanFunction function;
  std::optional<PlanMacro> macro;
  std::string block;
  FormItems body;
  std::size_t position = 0;
};

/// A counter of `with-retry-counters`: the form that binds it, and the form of its number.
struct RetryCounter {
  DatumId form;
  DatumId number;
};

/// A slot of a condition that some function of the plan reads.
struct ConditionSlot {
  std::vector<std::string> initargs;  // without colon
  std::optional<DatumId> initial;
};

/// The plan's definitions at top level, and the local functions met so far.
struct PlanDefinitions {
  std::map<std::string, PlanFunction, std::less<>> functions;
  std::vector<std::string> function_order;
  std::map<std::uint32_t, PlanFunction> local_functions;  // by unit
  std::map<std::string, PlanMacro, std::less<>> macros;
  std::map<std::uint32_t, PlanMacro> local_macros;    // by unit
  std::map<std::uint32_t, PlanUnitSource> unwritten;  // by unit
  std::map<std::string, std::uint32_t, std::less<>> globals;
  std::map<std::string, std::string, std::less<>> accessors;  // of structures: their slots
  std::map<std::uint32_t, LexicalBinding> set_globals;        // those that the plan sets
  std::map<std::string, ConditionSlot, std::less<>> readers;  // of conditions, by key
  std::set<std::string, std::less<>> read_initargs;           // of all their slots
  std::map<std::uint32_t, RetryCounter> counters;  // those met so far, by the name's serial
};

/// State shared by the compilers of the single forms: the data, the code being written, the names,
/// and `compile` for the forms inside. Each form has a function of its own, grouped by subject in
/// <subject>_forms.cc, calls in function_calls.cc. Each function writes code that leaves one more
/// value on the stack. Errors are reported wherever they are met, also on paths that no execution
/// takes, and the compiler goes on.
class FormCompiler {
 public:
  FormCompiler(LispText& text, ValueStore& store, base::DiagnosticSink& sink, bool par_by_turns);
  ~FormCompiler();

  void compile(DatumId form);
  /// The forms in order; the value is the last one's, nil without forms.
  void compile_body(FormItems body);
  void nil(DatumId source) { code.constant(values.nil(), source); }
  /// Closes a body, whose value is on the stack: where one of the jumps led past it, it is nil.
  void otherwise_nil(const std::vector<std::size_t>& to_else, DatumId source);
  /// Quoted data as a value.
  ValueId datum_value(DatumId datum);
  /// The same; in the text of a macro it remembers its place.
  ValueId quoted_value(DatumId datum);
  /// The failure class that a symbol, perhaps quoted, names; CPL041 if there is none.
  std::optional<std::string> failure_class(DatumId datum);
  /// The class of a handler; CPL013 if it hears what is no failure as well, unless it is `idle`:
  /// then it makes no difference what it hears.
  std::optional<std::string> handled_class(DatumId datum, bool idle = false);
  /// Writes the code of a function or macro of the text, if that was not done; false: it is being
  /// written, or was refused.
  bool complete(std::uint32_t unit);
  /// The macro that the symbol at the head of a form means.
  const PlanMacro* find_macro(DatumId symbol) const;
  /// Expansion of a call of the macro; none: reported.
  std::optional<DatumId> expand(const PlanMacro& macro, DatumId call);
  /// A dotted list is data: as code it would be read as if the dot were not there.
  void check_dots(DatumId form);
  /// A body behind its declarations: a variable that has another type than declared is a Lisp
  /// error.
  void compile_declared(FormItems body);
  /// Drops docstrings and declarations at the head of a body.
  FormItems skip_declarations(FormItems body) const;

  // --- messages
  template <typename... Args>
  base::DiagnosticBuilder error(base::DiagnosticCode code_of_error, DatumId at,
                                const Args&... args) {
    failed_ = true;
    return note_calls(sink_.error(code_of_error, data.source(at), args...), at);
  }
  template <typename... Args>
  void warning(base::DiagnosticCode code_of_warning, DatumId at, const Args&... args) {
    sink_.warning(code_of_warning, data.source(at), args...);
  }
  void malformed(DatumId form, std::string_view text);
  /// malformed, and nil in the form's place.
  void refuse(DatumId form, std::string_view text);
  /// Warns, and signals an error in the form's place.
  void always_fails(DatumId form, std::string_view why);
  void unsupported(DatumId form, std::string_view text);
  void unknown_form(DatumId form, DatumId symbol);
  /// Refuses a perform inside a form that is not evaluated: the plan would silently lose an action.
  void check_no_perform(DatumId form);
  std::string form_name(DatumId form) const;
  bool failed() const { return failed_; }

  LispData& data;
  ValueStore& values;
  const bool interleave;  // the branches of `par` take turns
  PlanAssembler code;
  PlanDefinitions defined;
  int tags = 0;              // how many `with-tags` are around
  bool in_function = false;  // not among the bare forms at top level
  bool in_macro = false;     // in the text of a macro: lists remember where they were written
  std::size_t position = 0;  // of the form at top level that is compiled
  bool resetting = false;    // in the number of a counter that is reset
  std::size_t repeated = 0;  // data compiled again, for counters that are reset
  std::optional<base::FileId> entry_file;  // what the plan begins with: its variables are inputs

 private:
  base::DiagnosticBuilder note_calls(base::DiagnosticBuilder report, DatumId at) const;
  /// A definition of that name in a package from which the plan does not see it.
  void note_other_package(base::DiagnosticBuilder& report, DatumId symbol) const;
  void compile_datum(DatumId form);
  void compile_symbol(DatumId symbol);
  std::optional<DatumId> literal_of(std::uint32_t global) const;
  bool is_input(DatumId symbol) const;
  void compile_input(DatumId symbol);
  void compile_list(DatumId form);

  void compile_expansion(DatumId form, const PlanMacro& macro);

  LispText& text_;
  base::DiagnosticSink& sink_;
  std::unique_ptr<MacroExpander> expander_;
  std::size_t depth_ = 0;
  bool failed_ = false;
  friend class MacroExpander;
};

/// Compiles one form; `items` are its parts, the head first.
using FormFunction = void (*)(FormCompiler& c, DatumId form, FormItems items);
struct FormEntry {
  std::string_view name;
  FormFunction compile;
};

// The special forms of the subset, by subject.
std::span<const FormEntry> binding_forms();     // variables, assignment
std::span<const FormEntry> quotation_forms();   // quoted data, templates
std::span<const FormEntry> value_forms();       // several values, functions as values
std::span<const FormEntry> control_forms();     // order, choice, blocks, questions to the model
std::span<const FormEntry> loop_forms();        // dolist, dotimes
std::span<const FormEntry> loop_form();         // loop
std::span<const FormEntry> mapping_forms();     // mapcar and its like
std::span<const FormEntry> failure_forms();     // handlers, retries, clean-ups, the next branch
std::span<const FormEntry> type_forms();        // typecase, assertions, handler-bind
std::span<const FormEntry> designator_forms();  // designators and their perform
std::span<const FormEntry> prolog_forms();      // solutions of `prolog`
std::span<const FormEntry> call_forms();        // funcall, apply
std::span<const FormEntry> local_forms();       // local functions and macros
std::span<const FormEntry> world_forms();       // logging, belief, markers: nothing is done

/// The value of a condition's slot.
void compile_reader(FormCompiler& c, DatumId form, const ConditionSlot& slot, DatumId condition);

/// All of them, by name.
const std::map<std::string_view, FormFunction>& plan_forms();

/// A loop over a list that is known: two variables on the stack, the rest of the list and its
/// current element.
struct ListLoop {
  std::uint32_t list = 0;  // place of the rest
  std::uint32_t item = 0;  // place of the element
  std::uint32_t top = 0;
  std::size_t end_jump = 0;
  std::size_t scope = 0;  // before the variable: close_variables ends it and drops both places
};

/// Opens the loop over the list on top. The body follows and leaves one value, which end_list_loop
/// drops.
ListLoop begin_list_loop(FormCompiler& c, DatumId variable, DatumId source);
/// Closes the loop; its two variables are still there, the second one nil.
void end_list_loop(FormCompiler& c, const ListLoop& loop, DatumId source);

}  // namespace parallax::compiler
