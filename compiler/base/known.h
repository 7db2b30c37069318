#pragma once

#include <cstdint>

namespace parallax::base {

/// The answer to a question that may be undecided because the search for it was stopped. There is
/// no conversion to bool: `answer == Known::kNo` is the only way to a "no".
enum class [[nodiscard]] Known : std::uint8_t{kUndecided, kNo, kYes};

/// The value of a formula in Kleene's strong three-valued logic.
enum class Truth : std::uint8_t { kFalse, kTrue, kUnknown };

}  // namespace parallax::base
