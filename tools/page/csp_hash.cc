#include "tools/page/csp_hash.h"

#include "compiler/base/sha256.h"

namespace parallax::tools {

std::string csp_hash(std::string_view text) {
  static constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const auto hash = base::sha256(text);
  std::string out = "sha256-";
  for (std::size_t i = 0; i < hash.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      bits = bits << 8U | (i + k < hash.size() ? hash[i + k] : std::uint32_t{0});
    }
    for (std::size_t k = 0; k < 4; ++k) {
      const bool is_padding = i + k > hash.size();
      out += is_padding ? '=' : kDigits[bits >> (18U - 6U * k) & 63U];
    }
  }
  return out;
}

}  // namespace parallax::tools
