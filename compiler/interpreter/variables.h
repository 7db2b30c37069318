#pragma once

#include <cstddef>
#include <cstdint>

#include "compiler/interpreter/form_compiler.h"

namespace parallax::compiler {

/// The variable of that name whose value lies at `place` of the open unit, not visible yet. A
/// global is special: whatever binds it binds it for all that runs inside, as in Lisp.
LexicalBinding variable(const FormCompiler& c, DatumId symbol, std::uint32_t place);
/// Visible from here on; a global is rebound, as far as the task goes.
void show_variable(FormCompiler& c, LexicalBinding variable, DatumId source);
/// Both at once.
void bind_variable(FormCompiler& c, DatumId symbol, std::uint32_t place, DatumId source);
/// The same for the value on top.
void bind_top(FormCompiler& c, DatumId symbol, DatumId source);
/// Ends the variables shown since the scope had that size; drops `count` values below the top.
void close_variables(FormCompiler& c, std::size_t scope, std::uint32_t count, DatumId source);

/// The variable that a form may change, lexical or rebound, or a report of why it may not.
const LexicalBinding* assignable(FormCompiler& c, DatumId form, DatumId place);
/// The value on top, which stays, becomes that of the variable.
void assign(FormCompiler& c, const LexicalBinding& place, DatumId form);

}  // namespace parallax::compiler
