// Sobol's sequence (1967), scrambled, without tables.
//
// Each dimension has direction numbers from a primitive polynomial over GF(2); point n is the
// exclusive or of those for the bits of n, and in the order of Gray codes each point differs
// from the one before by one of them (Antonov and Saleev 1979). The polynomials are found by
// search: x must have order 2^degree - 1 modulo the polynomial, which is tested at the prime
// divisors of that number. The first direction numbers are random, but fixed for every sequence,
// and for up to 32 dimensions are drawn again until the first bits are independent over the
// dimensions so far (Property A). Random lower triangular matrices and a shift scramble each
// dimension (Matousek 1998), so that a single point is uniform and every prefix of a power of
// two keeps its even spread.
//
// Cost: dimensions for each point.

#include "harness/search/sobol.h"

#include <algorithm>
#include <bit>

#include "harness/search/search_rng.h"

namespace parallax::harness {
namespace {

constexpr std::uint64_t kDirectionSeed = 0x646972656374ULL;  // the same for every sequence

unsigned degree_of(std::uint64_t polynomial) {
  return static_cast<unsigned>(std::bit_width(polynomial)) - 1U;
}

std::uint64_t product_modulo(std::uint64_t a, std::uint64_t b, std::uint64_t modulus) {
  const unsigned degree = degree_of(modulus);
  std::uint64_t out = 0;
  for (; b != 0; b >>= 1U) {
    if ((b & 1U) != 0) out ^= a;
    a <<= 1U;
    if (((a >> degree) & 1U) != 0) a ^= modulus;
  }
  return out;
}

std::uint64_t power_of_x(std::uint64_t exponent, std::uint64_t modulus) {
  std::uint64_t out = 1, base = 2;
  for (; exponent != 0; exponent >>= 1U) {
    if ((exponent & 1U) != 0) out = product_modulo(out, base, modulus);
    base = product_modulo(base, base, modulus);
  }
  return out;
}

/// The first `count` ones of degree 1 and more, by value.
std::vector<std::uint64_t> primitive_polynomials(std::size_t count) {
  std::vector<std::uint64_t> out;
  for (std::uint64_t one = 3; out.size() < count; one += 2) {
    if (is_primitive(one)) out.push_back(one);
  }
  return out;
}

/// Is the row independent of those in `echelon`? Then it joins them. Rows over GF(2), bit by bit.
bool join_if_independent(std::vector<std::vector<bool>>& echelon, std::vector<bool> row) {
  for (const auto& known : echelon) {
    const auto lead = std::find(known.begin(), known.end(), true) - known.begin();
    if (!row[static_cast<std::size_t>(lead)]) continue;
    for (std::size_t i = 0; i < row.size(); ++i) row[i] = row[i] != known[i];
  }
  if (std::find(row.begin(), row.end(), true) == row.end()) return false;
  echelon.push_back(std::move(row));
  return true;
}

/// The direction numbers of one dimension, left-aligned, from its first ones (odd, m_k < 2^k).
std::vector<std::uint32_t> extended(std::uint64_t polynomial, std::vector<std::uint32_t> first,
                                    std::size_t bits) {
  const unsigned degree = degree_of(polynomial);
  std::vector<std::uint32_t> v(bits);
  for (std::size_t k = 0; k < bits; ++k) {
    if (k < degree) {
      v[k] = first[k] << (bits - 1 - k);
      continue;
    }
    v[k] = v[k - degree] ^ (v[k - degree] >> degree);
    for (unsigned i = 1; i < degree; ++i) {
      if (((polynomial >> (degree - i)) & 1U) != 0) v[k] ^= v[k - i];
    }
  }
  return v;
}

/// The first bit of every direction number, as far as dimensions go.
std::vector<bool> first_bits(const std::vector<std::uint32_t>& directions, std::size_t count) {
  std::vector<bool> row(count);
  for (std::size_t k = 0; k < count && k < directions.size(); ++k) {
    row[k] = (directions[k] >> 31U) != 0;
  }
  return row;
}

std::uint32_t lower_triangular(SearchRng& rng, std::size_t row) {
  // Bit of the diagonal is set; those of more significant bits are random.
  const auto random = static_cast<std::uint32_t>(rng.bits() >> 32U);
  const std::uint32_t diagonal = 0x80000000U >> row;
  return (random & ~(diagonal | (diagonal - 1U))) | diagonal;
}

}  // namespace

bool is_primitive(std::uint64_t polynomial) {
  if (polynomial < 3 || (polynomial & 1U) == 0) return false;
  const unsigned degree = degree_of(polynomial);
  if (degree == 1) return true;
  if (degree > 31) return false;
  const std::uint64_t order = (std::uint64_t{1} << degree) - 1U;
  if (power_of_x(order, polynomial) != 1) return false;
  // The order of x is `order` itself unless it divides order / q for a prime q.
  std::uint64_t rest = order;
  for (std::uint64_t q = 3; rest > 1; q += 2) {
    if (q * q > rest) q = rest;
    if (rest % q != 0) continue;
    if (power_of_x(order / q, polynomial) == 1) return false;
    while (rest % q == 0) rest /= q;
  }
  return true;
}

SobolSequence::SobolSequence(std::size_t dimensions, std::uint64_t seed)
    : directions_(dimensions * kBits), state_(dimensions), shift_(dimensions) {
  const auto polynomials = primitive_polynomials(dimensions);
  SearchRng choice(kDirectionSeed, 0);
  SearchRng scramble(seed, 6);
  std::vector<std::vector<bool>> independent;
  for (std::size_t d = 0; d < dimensions; ++d) {
    std::vector<std::uint32_t> v(kBits);
    if (d == 0) {
      for (std::size_t k = 0; k < kBits; ++k) v[k] = 0x80000000U >> k;
      join_if_independent(independent, first_bits(v, dimensions));
    } else {
      // Half of all choices have the property or more; it is not insisted on for ever.
      for (int attempt = 0; attempt < 1000; ++attempt) {
        std::vector<std::uint32_t> first(degree_of(polynomials[d - 1]));
        for (std::size_t k = 0; k < first.size(); ++k) {
          const auto random = static_cast<std::uint32_t>(choice.bits() >> 32U);
          first[k] = (random & ((std::uint32_t{2} << k) - 1U)) | 1U;
        }
        v = extended(polynomials[d - 1], std::move(first), kBits);
        if (dimensions > kBits) break;
        if (join_if_independent(independent, first_bits(v, dimensions))) break;
      }
    }
    std::vector<std::uint32_t> rows(kBits);
    for (std::size_t row = 0; row < kBits; ++row) rows[row] = lower_triangular(scramble, row);
    for (std::size_t k = 0; k < kBits; ++k) {
      std::uint32_t image = 0;
      for (std::size_t row = 0; row < kBits; ++row) {
        if ((std::popcount(rows[row] & v[k]) & 1) != 0) image |= 0x80000000U >> row;
      }
      directions_[d * kBits + k] = image;
    }
    shift_[d] = static_cast<std::uint32_t>(scramble.bits() >> 32U);
  }
}

std::vector<double> SobolSequence::next() {
  std::vector<double> point(state_.size());
  for (std::size_t d = 0; d < point.size(); ++d) {
    // The middle of the finest cell.
    point[d] = (static_cast<double>(state_[d] ^ shift_[d]) + 0.5) * 0x1.0p-32;
  }
  ++index_;
  const auto bit = static_cast<std::size_t>(std::countr_zero(index_));
  for (std::size_t d = 0; d < point.size() && bit < kBits; ++d) {
    state_[d] ^= directions_[d * kBits + bit];
  }
  return point;
}

}  // namespace parallax::harness
