#pragma once

#include <vector>

#include "compiler/lisp/lisp_data.h"

namespace parallax::compiler {

/// The functions and macros of Common Lisp that are written in Lisp themselves: those that call
/// functions they are given. Appends them to the data of a plan, if it names one of them, and
/// returns the definitions.
std::vector<DatumId> add_lisp_library(LispData& data);

}  // namespace parallax::compiler
