#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace parallax::tools {

/// SHA-256 (FIPS 180-4).
std::array<std::uint8_t, 32> sha256(std::string_view bytes);

/// As a Content-Security-Policy names an inline script or style: "sha256-47DEQpj8...=".
std::string csp_hash(std::string_view text);

}  // namespace parallax::tools
