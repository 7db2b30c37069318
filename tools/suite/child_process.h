#pragma once

#include <atomic>
#include <string>
#include <vector>

namespace parallax::tools {

/// How a child process ended and what it wrote.
struct ChildResult {
  int code = -1;  // exit code, 128 + signal, or -1 if it could not be started
  std::string out;
  std::string err;  // the first kMaxMessageBytes
};

inline constexpr std::size_t kMaxMessageBytes = std::size_t{64} << 10U;

/// Runs this program again with other arguments, no shell, and waits for its end. When `stop` is
/// raised the child gets SIGTERM and is waited for all the same. Safe from several threads.
ChildResult run_this_program(const std::vector<std::string>& arguments,
                             const std::atomic<bool>& stop);

}  // namespace parallax::tools
