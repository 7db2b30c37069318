#include "tools/lsp/positions.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

namespace parallax::tools::lsp {
namespace {

/// Bytes of the character that begins here, at most as many as there are.
std::size_t bytes_at(std::string_view text) {
  const auto first = static_cast<unsigned char>(text.front());
  const std::size_t bytes = first < 0xC0 ? 1 : first < 0xE0 ? 2 : first < 0xF0 ? 3 : 4;
  return std::min(bytes, text.size());
}

std::int64_t utf16_units(std::size_t bytes) { return bytes == 4 ? 2 : 1; }

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

}  // namespace

Positions::Positions(std::string_view text, ColumnUnit unit)
    : text_(text), unit_(unit), starts_{0} {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\n') starts_.push_back(i + 1);
  }
}

std::string_view Positions::line(std::size_t number) const {
  const auto begin = starts_[number];
  auto end = number + 1 < starts_.size() ? starts_[number + 1] - 1 : text_.size();
  if (end > begin && text_[end - 1] == '\r' && end < text_.size()) --end;
  return text_.substr(begin, end - begin);
}

std::size_t Positions::offset(const EditorPlace& place) const {
  if (place.line < 0) return 0;
  if (place.line >= static_cast<std::int64_t>(starts_.size())) return text_.size();
  const auto number = static_cast<std::size_t>(place.line);
  const auto whole = line(number);
  std::size_t at = 0;
  if (unit_ == ColumnUnit::kByte) {
    at = std::min(static_cast<std::size_t>(std::max<std::int64_t>(place.column, 0)), whole.size());
  } else {
    for (std::int64_t units = 0; units < place.column && at < whole.size();) {
      const auto bytes = bytes_at(whole.substr(at));
      units += utf16_units(bytes);
      at += bytes;
    }
  }
  return starts_[number] + at;
}

EditorPlace Positions::place(std::size_t offset) const {
  offset = std::min(offset, text_.size());
  const auto after = std::upper_bound(starts_.begin(), starts_.end(), offset);
  const auto number = static_cast<std::size_t>(after - starts_.begin()) - 1;
  EditorPlace out{static_cast<std::int64_t>(number), 0};
  if (unit_ == ColumnUnit::kByte) {
    out.column = static_cast<std::int64_t>(offset - starts_[number]);
    return out;
  }
  for (auto at = starts_[number]; at < offset;) {
    const auto bytes = bytes_at(text_.substr(at));
    out.column += utf16_units(bytes);
    at += bytes;
  }
  return out;
}

std::string path_of_uri(std::string_view uri) {
  constexpr std::string_view kScheme = "file://";
  if (!uri.starts_with(kScheme)) return {};
  uri.remove_prefix(kScheme.size());
  if (uri.starts_with("localhost/")) uri.remove_prefix(9);
  if (!uri.starts_with('/')) return {};
  std::string path;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] == '%' && i + 2 < uri.size() && hex_digit(uri[i + 1]) >= 0 &&
        hex_digit(uri[i + 2]) >= 0) {
      path += static_cast<char>(16 * hex_digit(uri[i + 1]) + hex_digit(uri[i + 2]));
      i += 2;
    } else {
      path += uri[i];
    }
  }
  if (path.find('\0') != std::string::npos) return {};
  return std::filesystem::path(path).lexically_normal().string();
}

std::string uri_of_path(std::string_view path) {
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  std::string uri = "file://";
  for (const char c : path) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) != 0 || std::string_view("/-._~").find(c) != std::string_view::npos) {
      uri += c;
    } else {
      uri += '%';
      uri += kDigits[byte >> 4U];
      uri += kDigits[byte & 15U];
    }
  }
  return uri;
}

}  // namespace parallax::tools::lsp
