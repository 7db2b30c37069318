#pragma once

#include <cstdint>
#include <string_view>

namespace parallax::base {

/// FNV-1a, 64 bits (Fowler, Noll, Vo): the same on every platform and for ever, so it may stand in
/// files. It finds accidents; it is no protection against forgery.
inline constexpr std::uint64_t kFnvStart = 0xcbf29ce484222325U;
inline constexpr std::uint64_t kFnvPrime = 0x100000001b3U;

/// Hash of bytes. A text hashed in pieces, each starting from the hash of those before it, has the
/// hash of the whole.
constexpr std::uint64_t fnv1a64(std::string_view bytes, std::uint64_t start = kFnvStart) {
  auto hash = start;
  for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * kFnvPrime;
  return hash;
}

/// One step with a whole word instead of a byte, and a shift that carries the high bits down (as in
/// xorshift generators, Marsaglia 2003).
constexpr std::uint64_t fnv1a64_word(std::uint64_t hash, std::uint64_t word) {
  hash = (hash ^ word) * kFnvPrime;
  return hash ^ (hash >> 29U);
}

}  // namespace parallax::base
