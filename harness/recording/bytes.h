#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace parallax::harness {

/// CRC-32 of ISO 3309, as zip and PNG have it; of a text in pieces, each from that of those before.
std::uint32_t crc32(std::string_view bytes, std::uint32_t before = 0);

/// RFC 4648, section 4, with padding.
std::string base64(std::string_view bytes);
/// None for what `base64` does not write.
std::optional<std::string> from_base64(std::string_view text);

/// Little-endian numbers at the end of a text.
void put_u16(std::string& out, std::uint16_t value);
void put_u32(std::string& out, std::uint32_t value);
void put_u64(std::string& out, std::uint64_t value);
std::uint32_t u32_at(std::string_view bytes, std::size_t at);

}  // namespace parallax::harness
