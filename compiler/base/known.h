#pragma once

#include <cstdint>

namespace parallax::base {

/// The answer to a question that may be undecided because the search for it was stopped. There is
/// no conversion to bool: `answer == Known::kNo` is the only way to a "no".
enum class [[nodiscard]] Known : std::uint8_t{kUndecided, kNo, kYes};

}  // namespace parallax::base
