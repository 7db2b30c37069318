#pragma once

#include <sys/types.h>

#include <atomic>
#include <chrono>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/base/descriptor.h"

namespace parallax::harness {

/// One child process with pipes on its three standard descriptors, in a session of its own, so
/// that it can be ended together with everything it has started. Its other descriptors are closed.
/// The system kills it when the thread that made this object ends, however that comes about, so
/// that no child is left behind by a program that was killed; what the child has started itself
/// has to notice the end of its input.
class ChildProcess {
 public:
  using Clock = std::chrono::steady_clock;

  /// Starts `command` (first word looked up in PATH, no shell). When that fails `start_error` says
  /// why and nothing else may be called.
  ChildProcess(const std::vector<std::string>& command, const std::atomic<bool>* stop);
  ~ChildProcess();  // ends the process group
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  const std::string& start_error() const { return start_error_; }

  enum class Wait { kLine, kTimeout, kEnd, kTooLong, kStopped };
  /// Writes `line` and a newline. False when the child does not take it before `deadline`.
  bool write_line(std::string_view line, Clock::time_point deadline);
  /// Waits for one line of standard output; `line` is set for kLine only, without its newline.
  Wait read_line(std::string& line, Clock::time_point deadline, std::size_t max_bytes);

  /// Closes the child's input, waits until it ends or `deadline`, then ends the group: TERM, two
  /// seconds, KILL. Returns how it ended: "exit status 3", "signal 9 (Killed)". Idempotent.
  std::string end(Clock::time_point deadline);
  /// The last lines of its standard error, at most 50, without the final newline.
  std::string error_tail() const;

 private:
  void start(const std::vector<std::string>& command);
  bool has_ended() const;
  bool wait_until_ended(Clock::time_point deadline);
  void drain_errors();
  bool poll_once(short output_events, Clock::time_point deadline);
  bool stopped() const { return stop_ != nullptr && stop_->load(); }

  pid_t pid_ = -1;  // also the process group
  base::Descriptor input_, output_, errors_;
  const std::atomic<bool>* stop_;
  std::string start_error_;
  std::string buffer_;      // read from standard output, not yet returned
  std::string error_text_;  // the end of standard error
  std::string ending_;
};

}  // namespace parallax::harness
