#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <vector>

namespace parallax::test {

struct ProcessResult {
  int code = -1;  // exit code, or 128 + signal
  std::string out, err;
};

struct ProcessOptions {
  std::string folder;  // working directory; empty: the caller's
  /// Looked at every few milliseconds while the process runs; a signal number is sent once.
  std::function<int()> signal_when;
  std::chrono::seconds limit{300};  // then the process is killed and the test fails
};

/// Runs a program with its arguments, no shell, and waits for its end.
ProcessResult run_process(const std::vector<std::string>& command,
                          const ProcessOptions& options = {});

}  // namespace parallax::test
