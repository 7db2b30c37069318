#pragma once

#include <cstdint>
#include <cstdlib>

namespace parallax::runtime::proof_literal {

/// A literal as binary DRAT writes it: 2v for the variable v, 2v + 1 for its negation. The checker
/// has a type of its own, because it shares nothing with what it checks.
using Code = std::uint32_t;

inline constexpr std::int64_t kMaxVariable = (std::int64_t{1} << 31U) - 1;

inline Code from_dimacs(std::int64_t value) {
  return static_cast<Code>(2 * std::abs(value)) + (value < 0 ? 1U : 0U);
}
inline std::int64_t to_dimacs(Code code) {
  const auto variable = static_cast<std::int64_t>(code >> 1U);
  return (code & 1U) != 0 ? -variable : variable;
}
inline Code negated(Code code) { return code ^ 1U; }
inline std::uint32_t variable(Code code) { return code >> 1U; }

}  // namespace parallax::runtime::proof_literal
