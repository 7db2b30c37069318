#include "harness/simulator/child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <mutex>
#include <thread>

#include "compiler/base/subprocess.h"

namespace parallax::harness {
namespace {

using std::chrono::milliseconds;

constexpr auto kTermGrace = std::chrono::seconds(2);
constexpr auto kPollSlice = milliseconds(100);  // how late the stop flag may be seen
constexpr auto kReapSlice = milliseconds(5);
constexpr std::size_t kErrorBytes = std::size_t{1} << 14U;
constexpr std::size_t kErrorLines = 50;

/// A child that has gone must be an error of write(), not a signal that ends the program.
void ignore_sigpipe() {
  static std::once_flag once;
  std::call_once(once, [] { ::signal(SIGPIPE, SIG_IGN); });
}

std::string ending_text(const siginfo_t& info) {
  if (info.si_code == CLD_EXITED) return fmt::format("exit status {}", info.si_status);
  return fmt::format("signal {} ({})", info.si_status, ::strsignal(info.si_status));
}

}  // namespace

ChildProcess::ChildProcess(const std::vector<std::string>& command, const std::atomic<bool>* stop)
    : stop_(stop) {
  ignore_sigpipe();
  start(command);
}

ChildProcess::~ChildProcess() { end(Clock::now()); }

void ChildProcess::start(const std::vector<std::string>& command) {
  base::Pipe input, output, errors;
  if (!input.valid() || !output.valid() || !errors.valid()) {
    start_error_ = fmt::format("no pipe: {}", std::strerror(errno));
    return;
  }
  base::SpawnOptions options;
  options.input = input.read.get();
  options.output = output.write.get();
  options.errors = errors.write.get();
  options.own_session = true;
  const auto child = base::spawn(command, options);
  if (child.pid < 0) {
    start_error_ = fmt::format("cannot start `{}`: {}", command[0], std::strerror(child.error));
    return;
  }
  pid_ = child.pid;
  input_ = std::move(input.write);
  output_ = std::move(output.read);
  errors_ = std::move(errors.read);
  for (const auto* end : {&input_, &output_, &errors_}) ::fcntl(end->get(), F_SETFL, O_NONBLOCK);
}

void ChildProcess::drain_errors() {
  char chunk[4096];
  while (errors_.valid()) {
    const auto count = ::read(errors_.get(), chunk, sizeof chunk);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return;  // nothing there now
    if (count == 0) return errors_.close();
    error_text_.append(chunk, static_cast<std::size_t>(count));
    if (error_text_.size() > 2 * kErrorBytes) {
      error_text_.erase(0, error_text_.size() - kErrorBytes);
    }
  }
}

/// Waits for the child to be ready in `output_events`' sense, for its errors, or a slice of time.
bool ChildProcess::poll_once(short output_events, Clock::time_point deadline) {
  const auto left = std::chrono::duration_cast<milliseconds>(deadline - Clock::now());
  const auto slice = std::clamp(left + milliseconds(1), milliseconds(0), milliseconds(kPollSlice));
  pollfd fds[2] = {{output_events == POLLOUT ? input_.get() : output_.get(), output_events, 0},
                   {errors_.get(), POLLIN, 0}};  // poll skips negative descriptors
  const int ready = ::poll(fds, 2, static_cast<int>(slice.count()));
  if (ready > 0 && fds[1].revents != 0) drain_errors();
  return ready > 0 && fds[0].revents != 0;
}

bool ChildProcess::write_line(std::string_view line, Clock::time_point deadline) {
  std::string text(line);
  text += '\n';
  std::string_view rest = text;
  while (!rest.empty()) {
    const auto count = ::write(input_.get(), rest.data(), rest.size());
    if (count > 0) {
      rest.remove_prefix(static_cast<std::size_t>(count));
    } else if (errno == EAGAIN) {
      if (stopped() || Clock::now() >= deadline) return false;
      poll_once(POLLOUT, deadline);
    } else if (errno != EINTR) {
      return false;
    }
  }
  return true;
}

ChildProcess::Wait ChildProcess::read_line(std::string& line, Clock::time_point deadline,
                                           std::size_t max_bytes) {
  std::size_t scanned = 0;
  for (;;) {
    const auto newline = buffer_.find('\n', scanned);
    if (newline != std::string::npos && newline <= max_bytes) {
      line = buffer_.substr(0, newline);
      buffer_.erase(0, newline + 1);
      return Wait::kLine;
    }
    if (buffer_.size() > max_bytes) return Wait::kTooLong;
    scanned = buffer_.size();
    if (stopped()) return Wait::kStopped;
    if (Clock::now() >= deadline) return Wait::kTimeout;
    if (!poll_once(POLLIN, deadline)) continue;
    char chunk[1 << 14];
    const auto count = ::read(output_.get(), chunk, sizeof chunk);
    if (count == 0) return Wait::kEnd;
    if (count > 0) buffer_.append(chunk, static_cast<std::size_t>(count));
  }
}

bool ChildProcess::has_ended() const {
  siginfo_t info{};
  // Not reaped yet: as long as the leader is a zombie its group's number cannot be taken over.
  return ::waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
         info.si_pid != 0;
}

bool ChildProcess::wait_until_ended(Clock::time_point deadline) {
  for (;;) {
    if (errors_.valid()) drain_errors();
    if (has_ended()) return true;
    if (Clock::now() >= deadline) return false;
    std::this_thread::sleep_for(kReapSlice);
  }
}

std::string ChildProcess::end(Clock::time_point deadline) {
  if (pid_ < 0) return ending_;
  input_.close();
  if (!wait_until_ended(deadline)) {
    ::kill(-pid_, SIGTERM);
    wait_until_ended(Clock::now() + kTermGrace);
  }
  // Also when the leader has ended: what it has started may still run.
  ::kill(-pid_, SIGKILL);
  siginfo_t info{};
  while (::waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED) != 0 && errno == EINTR) {
  }
  ending_ = ending_text(info);
  drain_errors();
  output_.close();
  errors_.close();
  pid_ = -1;
  return ending_;
}

std::string ChildProcess::error_tail() const {
  std::string_view text = error_text_;
  while (!text.empty() && text.back() == '\n') text.remove_suffix(1);
  std::size_t begin = text.size();
  for (std::size_t lines = 0; lines < kErrorLines && begin != std::string_view::npos; ++lines) {
    begin = begin == 0 ? std::string_view::npos : text.rfind('\n', begin - 1);
  }
  return std::string(begin == std::string_view::npos ? text : text.substr(begin + 1));
}

}  // namespace parallax::harness
