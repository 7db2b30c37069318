#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace parallax::base {

/// SHA-256 (FIPS 180-4).
std::array<std::uint8_t, 32> sha256(std::string_view bytes);

/// Two hexadecimal digits for each byte, in lower case.
std::string hex_digits(std::span<const std::uint8_t> bytes);

/// The 64 hexadecimal digits of SHA-256.
std::string sha256_hex(std::string_view bytes);

}  // namespace parallax::base
