#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace parallax::tools::lsp {

/// Messages of the base protocol of language servers: a header with `Content-Length`, an empty
/// line, so many bytes.
class FrameReader {
 public:
  static constexpr std::size_t kMostBytes = std::size_t{64} << 20U;

  explicit FrameReader(int descriptor) : descriptor_(descriptor) {}
  /// The next message; empty text for one of more than kMostBytes, which is read and dropped. None
  /// at the end of the input, also in the middle of a message, and after a header that cannot be
  /// read.
  std::optional<std::string> next();
  /// The input ended in the middle of a message, or a header said no length.
  bool broken() const { return is_broken_; }

 private:
  bool fill();

  int descriptor_;
  std::string buffer_;
  std::size_t used_ = 0;  // bytes of the buffer that were given out
  bool is_broken_ = false;
};

/// False if nobody reads any more.
bool write_frame(int descriptor, std::string_view message);

}  // namespace parallax::tools::lsp
