#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "compiler/interpreter/form_compiler.h"

namespace parallax::compiler {

/// Target of a call: a unit (global, or local with the distance of its frame) or a built-in.
struct Callee {
  const PlanFunction* function = nullptr;
  std::optional<std::uint32_t> level;
  std::optional<std::uint32_t> builtin;
  std::optional<LexicalBinding> local = {};  // of flet or labels
};

/// A local function, one of the plan, or a built-in, by the symbol's meaning in its package.
std::optional<Callee> find_callee(const FormCompiler& c, DatumId symbol);
/// The same without the local ones: the meaning of a quoted name.
std::optional<Callee> find_global_callee(const FormCompiler& c, DatumId symbol);
/// The function that an argument of funcall and the mapping functions gives: one that is named or
/// written there, or a value, which prepare_function leaves on the stack (else nil lies there).
struct FunctionArgument {
  std::optional<Callee> callee;
  std::uint32_t place = 0;
};
FunctionArgument prepare_function(FormCompiler& c, DatumId form, DatumId function);
/// Pushes the value if it is needed, ahead of the arguments of call_prepared.
void push_prepared(FormCompiler& c, const FunctionArgument& function, DatumId source);
void call_prepared(FormCompiler& c, const FunctionArgument& function, std::uint32_t count,
                   DatumId source);
/// #'f and a written lambda as a value.
void compile_function_value(FormCompiler& c, DatumId form, DatumId function);

/// Writes the code of a call with its arguments.
void compile_call(FormCompiler& c, DatumId form, std::string_view name, const Callee& callee,
                  FormItems arguments);
/// ((lambda (parameter...) form...) argument...)
void compile_lambda_call(FormCompiler& c, DatumId form, FormItems items);
/// Only the call itself: `count` arguments are on the stack.
void emit_call(FormCompiler& c, const Callee& callee, std::uint32_t count, DatumId source);

/// Reads the parameter list of a function and gives it a unit, still empty.
PlanFunction declare_function(FormCompiler& c, DatumId form, std::string_view name,
                              DatumId parameters);
/// Fills the unit; `block_name` is the block that return-from may leave.
void compile_function(FormCompiler& c, const PlanFunction& function, std::string_view block_name,
                      FormItems body);
/// The same for a unit that was entered already.
void compile_function_body(FormCompiler& c, const PlanFunction& function,
                           std::string_view block_name, FormItems body);

}  // namespace parallax::compiler
