#include "harness/monitor/line_source.h"

#include <poll.h>
#include <unistd.h>

#include <cerrno>

namespace parallax::harness {
namespace {

constexpr std::size_t kChunk = std::size_t{1} << 16U;
constexpr int kPollMs = 100;

}  // namespace

LineSource::LineSource(int fd, const std::atomic<bool>& stop, std::size_t max_line)
    : fd_(fd), stop_(&stop), max_line_(max_line) {}

LineSource::Status LineSource::next(std::string_view& line) {
  while (true) {
    const auto end = buffer_.find('\n', seen_);
    const bool is_whole = end != std::string::npos;
    const auto length = (is_whole ? end : buffer_.size()) - begin_;
    if (is_whole || (at_end_ && length > 0) || length > max_line_) {
      ++number_;
      if (length > max_line_) return Status::kTooLong;
      line = std::string_view(buffer_).substr(begin_, length);
      if (is_whole && line.ends_with('\r')) line.remove_suffix(1);
      begin_ = seen_ = is_whole ? end + 1 : buffer_.size();
      return is_whole ? Status::kLine : Status::kCut;
    }
    if (at_end_) return Status::kEnd;
    seen_ = buffer_.size();
    const auto filled = fill();
    if (filled != Status::kLine) return filled;
  }
}

LineSource::Status LineSource::fill() {
  if (begin_ > 0) {
    buffer_.erase(0, begin_);
    seen_ -= begin_;
    begin_ = 0;
  }
  while (true) {
    if (stop_->load()) return Status::kStopped;
    pollfd ready{fd_, POLLIN, 0};
    const int polled = ::poll(&ready, 1, kPollMs);
    if (polled == 0 || (polled < 0 && errno == EINTR)) continue;
    const auto size = buffer_.size();
    buffer_.resize(size + kChunk);
    const auto count = ::read(fd_, buffer_.data() + size, kChunk);
    buffer_.resize(size + (count > 0 ? static_cast<std::size_t>(count) : 0));
    if (count < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (count < 0) {
      error_ = errno;
      return Status::kFailed;
    }
    bytes_ += count;
    at_end_ = count == 0;
    return Status::kLine;
  }
}

}  // namespace parallax::harness
