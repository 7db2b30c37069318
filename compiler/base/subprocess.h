#pragma once

#include <sys/types.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace parallax::base {

/// How a program is started. Descriptors stay the caller's; -1 leaves the child ours.
struct SpawnOptions {
  std::string program = {};  // the file to run; empty: the first word of the command
  std::string folder = {};   // working directory; empty: ours
  int input = -1;
  int output = -1;
  int errors = -1;
  /// In a session of its own, so that it can be ended together with everything it has started, and
  /// with default signals.
  bool own_session = false;
  /// The system kills it when the thread that started it ends; implied by `own_session`.
  bool ends_with_us = false;
  std::optional<std::uint64_t> cpu_limit_s = {};  // then SIGXCPU, a second later SIGKILL; no core
};

struct Spawned {
  pid_t pid = -1;
  int error = 0;  // an `errno`, if there is no process
};

/// Starts a program with its arguments, looked up in PATH, without a shell; the caller waits for
/// its end. The program inherits no other descriptors. Safe from several threads.
Spawned spawn(const std::vector<std::string>& command, const SpawnOptions& options);

/// A command for people to read: words with blanks stand in quotes.
std::string command_text(const std::vector<std::string>& command);

/// Exit code in a status that wait() returned: the child's own, or 128 + signal.
int exit_code(int status);

/// Waits for the end of a child: its exit code, or 128 + signal.
int wait_for(pid_t child);

struct CaptureOptions {
  std::string program = {};  // as in SpawnOptions
  std::string folder = {};
  bool ends_with_us = false;                   // as in SpawnOptions
  bool without_input = false;                  // reads /dev/null instead of our standard input
  std::size_t max_errors = std::string::npos;  // bytes of standard error that are kept: the first
  std::optional<std::uint64_t> cpu_limit_s = {};  // as in SpawnOptions
  /// Asked many times a second while the program runs; a signal that it names is sent.
  std::function<int()> signal_when = {};
};

struct Captured {
  int code = -1;  // exit code, 128 + signal, or -1 if it could not be started
  int error = 0;  // why not, an `errno`
  std::string out;
  std::string err;
};

/// Runs a program to its end and keeps its output.
Captured capture(const std::vector<std::string>& command, const CaptureOptions& options = {});

}  // namespace parallax::base
