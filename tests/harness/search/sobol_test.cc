#include "harness/search/sobol.h"

#include <doctest/doctest.h>

#include <array>
#include <set>

namespace parallax::harness {
namespace {

TEST_CASE("sobol: as many primitive polynomials are found as there are") {
  // Euler's phi(2^n - 1) / n for n = 1 to 10.
  const std::array<int, 10> known = {1, 1, 2, 2, 6, 6, 18, 16, 48, 60};
  for (unsigned degree = 1; degree <= known.size(); ++degree) {
    int count = 0;
    for (std::uint64_t p = std::uint64_t{1} << degree; p < std::uint64_t{2} << degree; ++p) {
      count += is_primitive(p) ? 1 : 0;
    }
    CHECK(count == known[degree - 1]);
  }
}

TEST_CASE("sobol: of the first 2^k points each dyadic interval of each coordinate has one") {
  for (const std::uint64_t seed : {0U, 1U, 77U}) {
    SobolSequence sequence(12, seed);
    std::vector<std::set<int>> cells(12);
    for (int i = 0; i < 256; ++i) {
      const auto point = sequence.next();
      for (std::size_t d = 0; d < point.size(); ++d) {
        REQUIRE(point[d] > 0.0);
        REQUIRE(point[d] < 1.0);
        cells[d].insert(static_cast<int>(256.0 * point[d]));
      }
    }
    for (const auto& cell : cells) CHECK(cell.size() == 256);
  }
}

TEST_CASE("sobol: of the first 2^d points each orthant of the cube has one") {
  for (const std::size_t dimensions : {2U, 3U, 6U, 10U}) {
    SobolSequence sequence(dimensions, 5);
    std::set<std::vector<bool>> orthants;
    const std::size_t count = std::size_t{1} << dimensions;
    for (std::size_t i = 0; i < count; ++i) {
      std::vector<bool> orthant;
      for (const double value : sequence.next()) orthant.push_back(value >= 0.5);
      orthants.insert(orthant);
    }
    CHECK(orthants.size() == count);
  }
}

TEST_CASE("sobol: the seed scrambles, and nothing else does") {
  SobolSequence a(3, 1), b(3, 1), c(3, 2);
  bool same = true;
  for (int i = 0; i < 50; ++i) {
    const auto point = a.next();
    CHECK(point == b.next());
    same = same && point == c.next();
  }
  CHECK_FALSE(same);
}

}  // namespace
}  // namespace parallax::harness
