#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "harness/sampling/sampler.h"

namespace parallax::harness {

/// Random numbers of one strategy: splitmix64, a stream of its own for each (seed, stream).
class SearchRng {
 public:
  SearchRng(std::uint64_t seed, std::uint64_t stream) : state_(mix64(seed ^ mix64(stream + 1))) {}

  std::uint64_t bits() {
    state_ += 0x9e3779b97f4a7c15ULL;
    return mix64(state_);
  }
  /// A uniform number in [0, 1) with 53 bits.
  double uniform() { return static_cast<double>(bits() >> 11U) * 0x1.0p-53; }
  /// Standard normal (Box and Muller 1958).
  double normal() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    return radius * std::cos(2.0 * std::numbers::pi * uniform());
  }

 private:
  std::uint64_t state_;
};

}  // namespace parallax::harness
