#include "tools/bench/families/object_names.h"

#include <fmt/core.h>

namespace parallax::tools {

std::string numbered_names(std::string_view prefix, int count) {
  std::string names;
  for (int i = 1; i <= count; ++i) {
    names += fmt::format("{}{}{}", i == 1 ? "" : ", ", prefix, i);
  }
  return names;
}

}  // namespace parallax::tools
