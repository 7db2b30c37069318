#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace parallax::compiler {

/// The text of a binding file, cut into entries.
struct BindingText {
  std::string text;                  // as long as the file; comments and separators are blanks
  std::vector<std::size_t> entries;  // where entries start
};

/// An entry starts with `motion`, `action`, `query` or `object` at the start of a line or behind a
/// separating `;`.
BindingText clean_binding(std::string_view file);

}  // namespace parallax::compiler
