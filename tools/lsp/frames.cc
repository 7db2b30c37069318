#include "tools/lsp/frames.h"

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <charconv>

#include "compiler/base/file_io.h"

namespace parallax::tools::lsp {
namespace {

constexpr std::size_t kMostHeader = 4096;

/// The number behind `Content-Length:`; header names know no case.
std::optional<std::size_t> length_in(std::string_view header) {
  constexpr std::string_view kName = "content-length:";
  for (std::size_t at = 0; at < header.size();) {
    const auto end = std::min(header.find('\n', at), header.size());
    auto line = header.substr(at, end - at);
    at = end + 1;
    const bool is_it = line.size() >= kName.size() &&
                       std::equal(kName.begin(), kName.end(), line.begin(), [](char a, char b) {
                         return a == static_cast<char>(std::tolower(static_cast<unsigned char>(b)));
                       });
    if (!is_it) continue;
    line.remove_prefix(kName.size());
    while (!line.empty() && line.front() == ' ') line.remove_prefix(1);
    std::size_t length = 0;
    const auto read = std::from_chars(line.data(), line.data() + line.size(), length);
    if (read.ec != std::errc()) return std::nullopt;
    return length;
  }
  return std::nullopt;
}

}  // namespace

bool FrameReader::fill() {
  if (used_ > (std::size_t{1} << 16U)) {
    buffer_.erase(0, used_);
    used_ = 0;
  }
  char chunk[1U << 16U];
  for (;;) {
    const auto count = ::read(descriptor_, chunk, sizeof chunk);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    buffer_.append(chunk, static_cast<std::size_t>(count));
    return true;
  }
}

std::optional<std::string> FrameReader::next() {
  if (is_broken_) return std::nullopt;
  std::size_t end = 0;
  while ((end = buffer_.find("\r\n\r\n", used_)) == std::string::npos) {
    if (buffer_.size() - used_ > kMostHeader) {
      is_broken_ = true;
      return std::nullopt;
    }
    if (!fill()) {
      is_broken_ = buffer_.size() > used_;
      return std::nullopt;
    }
  }
  const auto length = length_in(std::string_view(buffer_).substr(used_, end - used_));
  used_ = end + 4;
  if (!length) {
    is_broken_ = true;
    return std::nullopt;
  }
  auto left = *length;
  if (left > kMostBytes) {
    while (left > 0) {
      if (used_ == buffer_.size() && !fill()) {
        is_broken_ = true;
        return std::nullopt;
      }
      const auto now = std::min(left, buffer_.size() - used_);
      used_ += now;
      left -= now;
    }
    return std::string();
  }
  while (buffer_.size() - used_ < left) {
    if (!fill()) {
      is_broken_ = true;
      return std::nullopt;
    }
  }
  auto message = buffer_.substr(used_, left);
  used_ += left;
  return message;
}

bool write_frame(int descriptor, std::string_view message) {
  const auto header = "Content-Length: " + std::to_string(message.size()) + "\r\n\r\n";
  return base::write_all(descriptor, header) && base::write_all(descriptor, message);
}

}  // namespace parallax::tools::lsp
