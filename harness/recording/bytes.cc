#include "harness/recording/bytes.h"

#include <array>

namespace parallax::harness {
namespace {

constexpr std::array<std::uint32_t, 256> crc_table() {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t i = 0; i < 256; ++i) {
    std::uint32_t c = i;
    for (int bit = 0; bit < 8; ++bit) c = (c & 1U) != 0 ? 0xedb88320U ^ (c >> 1U) : c >> 1U;
    table[i] = c;
  }
  return table;
}
constexpr auto kCrcTable = crc_table();

constexpr std::string_view kDigits =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

constexpr std::array<std::int8_t, 256> digit_table() {
  std::array<std::int8_t, 256> table{};
  for (auto& value : table) value = -1;
  for (std::size_t i = 0; i < kDigits.size(); ++i) {
    table[static_cast<unsigned char>(kDigits[i])] = static_cast<std::int8_t>(i);
  }
  return table;
}
constexpr auto kDigitTable = digit_table();

std::uint32_t byte_at(std::string_view bytes, std::size_t at) {
  return static_cast<unsigned char>(bytes[at]);
}

void put_little(std::string& out, std::uint64_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) out.push_back(static_cast<char>(value >> (8 * i) & 0xffU));
}

}  // namespace

std::uint32_t crc32(std::string_view bytes, std::uint32_t before) {
  std::uint32_t c = ~before;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    c = kCrcTable[(c ^ byte_at(bytes, i)) & 0xffU] ^ (c >> 8U);
  }
  return ~c;
}

std::string base64(std::string_view bytes) {
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto left = bytes.size() - i;
    std::uint32_t word = byte_at(bytes, i) << 16U;
    if (left > 1) word |= byte_at(bytes, i + 1) << 8U;
    if (left > 2) word |= byte_at(bytes, i + 2);
    out.push_back(kDigits[word >> 18U & 63U]);
    out.push_back(kDigits[word >> 12U & 63U]);
    out.push_back(left > 1 ? kDigits[word >> 6U & 63U] : '=');
    out.push_back(left > 2 ? kDigits[word & 63U] : '=');
  }
  return out;
}

std::optional<std::string> from_base64(std::string_view text) {
  if (text.size() % 4 != 0) return std::nullopt;
  std::string out;
  out.reserve(text.size() / 4 * 3);
  for (std::size_t i = 0; i < text.size(); i += 4) {
    const bool last = i + 4 == text.size();
    const std::size_t padding = !last || text[i + 3] != '=' ? 0 : text[i + 2] != '=' ? 1 : 2;
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      const auto digit = k < 4 - padding ? kDigitTable[byte_at(text, i + k)] : std::int8_t{0};
      if (digit < 0) return std::nullopt;
      word = word << 6U | static_cast<std::uint32_t>(digit);
    }
    for (std::size_t k = 0; k < 3 - padding; ++k) {
      out.push_back(static_cast<char>(word >> (16 - 8 * k) & 0xffU));
    }
  }
  return out;
}

void put_u16(std::string& out, std::uint16_t value) { put_little(out, value, 2); }
void put_u32(std::string& out, std::uint32_t value) { put_little(out, value, 4); }
void put_u64(std::string& out, std::uint64_t value) { put_little(out, value, 8); }

std::uint32_t u32_at(std::string_view bytes, std::size_t at) {
  std::uint32_t out = 0;
  for (std::size_t i = 0; i < 4; ++i) out |= byte_at(bytes, at + i) << (8 * i);
  return out;
}

}  // namespace parallax::harness
