#pragma once

#include <cstdint>

#include "compiler/interpreter/form_compiler.h"

namespace parallax::compiler {

/// Binds the names of a pattern to the parts of the list at `place`: names and patterns, &optional,
/// &rest or &body, &key, &allow-other-keys, &aux, and a name behind a dot. The new variables stay
/// on the stack; `place` is used up. Errors of the list are those of `form`.
void destructure(FormCompiler& c, DatumId form, DatumId pattern, std::uint32_t place);

/// The same for the parameters of a macro, whose whole call is variable 0 of the unit; &whole and
/// &environment too. Errors of the call arise at `parameters`.
void compile_macro_parameters(FormCompiler& c, DatumId parameters);

}  // namespace parallax::compiler
