#pragma once

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "tools/cli/command.h"

namespace parallax::tools {

/// Enforces --time-limit and --memory-limit over all phases of a command. When the time is over the
/// stop flag is raised; a phase that does not check it within 1.5 s is ended with exit code 4 and a
/// message. Finished output is on disk before that.
class LimitGuard {
 public:
  explicit LimitGuard(const CommonOptions& options);
  ~LimitGuard();
  LimitGuard(const LimitGuard&) = delete;
  LimitGuard& operator=(const LimitGuard&) = delete;
  bool time_is_over() const;

 private:
  void watch(const CommonOptions& options);
  mutable std::mutex mutex_;
  std::condition_variable done_changed_;
  bool done_ = false;
  bool over_ = false;
  std::thread thread_;
};

/// While it lives, a limit that ends the process writes this text to standard output first: the
/// mark that a list was stopped. One at a time.
class StoppedText {
 public:
  explicit StoppedText(std::string text);
  ~StoppedText();
  StoppedText(const StoppedText&) = delete;
  StoppedText& operator=(const StoppedText&) = delete;
};

/// Reports the limit in the form that the options ask for and ends the process with 4.
[[noreturn]] void end_for_limit(const CommonOptions& options, const std::string& limit);

/// Raised by SIGINT, SIGTERM and the time limit; every loop checks it.
std::atomic<bool>& stop_flag();
/// Installs the handlers. A second signal ends the program at once.
void install_signal_handlers();
/// 130 or 143 after a signal, else 0.
int signal_exit_code();

}  // namespace parallax::tools
