#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "compiler/plan/form_compiler.h"

namespace parallax::compiler {

/// A loop over a list that is known: two variables on the stack, the rest of the list and its
/// current element.
struct ListLoop {
  std::uint32_t list = 0;  // place of the rest
  std::uint32_t item = 0;  // place of the element
  std::uint32_t top = 0;
  std::size_t end_jump = 0;
};

/// Opens the loop over the list on top. The body follows and leaves one value, which end_list_loop
/// drops.
ListLoop begin_list_loop(FormCompiler& c, std::string_view variable, DatumId source);
/// Closes the loop; its two variables are still there, the second one nil.
void end_list_loop(FormCompiler& c, const ListLoop& loop, DatumId source);

}  // namespace parallax::compiler
