#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace parallax::harness {

/// The lines of a file, a pipe or a device as they come, none longer than `max_line` bytes: memory
/// is bounded however long it goes on.
class LineSource {
 public:
  static constexpr std::size_t kMaxLine = std::size_t{1} << 20U;
  enum class Status : std::uint8_t {
    kLine,     // whole, without its end (LF or CRLF)
    kCut,      // the last one, whose end is missing
    kEnd,      // there are no more
    kTooLong,  // the line is longer than it may be
    kFailed,   // reading failed: `error()`, an errno
    kStopped,  // the stop flag was raised while there was nothing to read
  };

  /// Does not close `fd`. `stop` outlives the source.
  LineSource(int fd, const std::atomic<bool>& stop, std::size_t max_line = kMaxLine);
  /// `line` is valid until the next call.
  Status next(std::string_view& line);
  std::int64_t number() const { return number_; }  // of the last line, from 1
  std::int64_t bytes() const { return bytes_; }    // read so far
  int error() const { return error_; }

 private:
  Status fill();

  int fd_;
  const std::atomic<bool>* stop_;
  std::size_t max_line_;
  std::string buffer_;
  std::size_t begin_ = 0, seen_ = 0;  // start of the bytes not given; end of those searched
  bool at_end_ = false;
  std::int64_t number_ = 0, bytes_ = 0;
  int error_ = 0;
};

}  // namespace parallax::harness
