#include "tests/support/process.h"

#include <csignal>
#include <cstdlib>
#include <stdexcept>

#include "compiler/base/subprocess.h"

namespace parallax::test {

ProcessResult run_process(const std::vector<std::string>& command, const ProcessOptions& options) {
  // A test means the same on a desk and under CI; one that is about CI sets it with env(1).
  static const int unset = ::unsetenv("CI");
  (void)unset;
  const auto deadline = std::chrono::steady_clock::now() + options.limit;
  bool signalled = false, late = false;
  base::CaptureOptions capturing;
  capturing.folder = options.folder;
  capturing.without_input = true;
  capturing.signal_when = [&] {
    late = late || std::chrono::steady_clock::now() > deadline;
    if (late) return SIGKILL;
    const int signal = signalled || !options.signal_when ? 0 : options.signal_when();
    signalled = signalled || signal != 0;
    return signal;
  };
  auto result = base::capture(command, capturing);
  if (late) throw std::runtime_error("the process did not end in time");
  if (result.code < 0) result.code = 127;  // no such program, as in shells
  return {result.code, std::move(result.out), std::move(result.err)};
}

}  // namespace parallax::test
