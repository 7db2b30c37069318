#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace parallax::harness {

/// Sobol's sequence (1967) in the order of Gray codes (Antonov and Saleev 1979), scrambled by
/// random lower triangular matrices and digital shifts (Matousek 1998): every prefix of a power of
/// two keeps its even spread, and each point by itself is uniform. The primitive polynomials are
/// found by search; the first direction numbers are random, under Sobol's Property A: in the first
/// 2^d points of d dimensions each orthant of the cube has exactly one.
class SobolSequence {
 public:
  SobolSequence(std::size_t dimensions, std::uint64_t seed);
  /// The next point; 2^32 of them differ.
  std::vector<double> next();

 private:
  static constexpr std::size_t kBits = 32;
  std::vector<std::uint32_t> directions_;  // kBits for each dimension
  std::vector<std::uint32_t> state_;       // by dimension
  std::vector<std::uint32_t> shift_;
  std::uint32_t index_ = 0;
};

/// Is the polynomial over GF(2) primitive? Bit i is the coefficient of x^i.
bool is_primitive(std::uint64_t polynomial);

}  // namespace parallax::harness
