#pragma once

#include <optional>
#include <span>
#include <string_view>

namespace parallax::compiler {

struct Foundation {
  std::string_view path;  // "foundations/EC.e"
  std::string_view text;
};

/// The texts inside the program, by path.
std::span<const Foundation> foundations();
std::optional<Foundation> find_foundation(std::string_view path);

}  // namespace parallax::compiler
