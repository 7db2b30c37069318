#pragma once

#include <cstdlib>

namespace parallax::test {

/// Whether PARALLAX_DEEP=1 asks for every random case, as a step of .ci/run does. By default tests
/// run fewer of them, so that a whole run takes minutes.
inline bool is_deep() {
  const char* text = std::getenv("PARALLAX_DEEP");
  return text != nullptr && text[0] == '1';
}

}  // namespace parallax::test
