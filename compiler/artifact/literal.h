#pragma once

#include <cstdint>
#include <cstdlib>

#include "compiler/base/contract.h"

namespace parallax::compiler {

/// A discrete timepoint, 0 .. horizon. Never a number of seconds.
using Timepoint = std::int32_t;

/// A SAT literal in DIMACS convention: +v or -v with v >= 1.
class Literal {
 public:
  static Literal positive(std::int32_t variable) { return Literal(variable); }
  static Literal from_dimacs(std::int32_t value) { return Literal(value); }
  std::int32_t var() const { return std::abs(value_); }
  bool is_positive() const { return value_ > 0; }
  std::int32_t dimacs() const { return value_; }
  Literal operator~() const { return Literal(-value_); }
  friend bool operator==(Literal, Literal) = default;

 private:
  explicit Literal(std::int32_t value) : value_(value) { PARALLAX_ASSERT(value != 0); }
  std::int32_t value_;
};

}  // namespace parallax::compiler
