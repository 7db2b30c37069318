#include "harness/simulator/child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/close_range.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <thread>

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

void close_fd(int& fd) {
  if (fd >= 0) ::close(fd);
  fd = -1;
}

struct Pipe {
  int read = -1, write = -1;
  Pipe() {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) == 0) read = ends[0], write = ends[1];
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  ~Pipe() {
    close_fd(read);
    close_fd(write);
  }
  bool valid() const { return read >= 0; }
};

int take(int& fd) {
  const int out = fd;
  fd = -1;
  return out;
}

std::string ending_text(const siginfo_t& info) {
  if (info.si_code == CLD_EXITED) return fmt::format("exit status {}", info.si_status);
  return fmt::format("signal {} ({})", info.si_status, ::strsignal(info.si_status));
}

/// What the child needs to become the command; made before the fork, as only calls that are safe in
/// a signal handler may follow it.
struct ChildPlan {
  std::vector<char*> arguments;
  int input, output, errors, report;
  pid_t parent;
};

/// Every other descriptor is closed by the exec.
void close_on_exec_from(int first) {
  if (::close_range(static_cast<unsigned>(first), ~0U, CLOSE_RANGE_CLOEXEC) == 0) return;
  const long limit = ::sysconf(_SC_OPEN_MAX);  // a kernel before 5.11
  for (int fd = first; fd < limit; ++fd) ::fcntl(fd, F_SETFD, FD_CLOEXEC);
}

/// In the child. Comes back, with errno, only when the command could not be started.
void become(const ChildPlan& plan) {
  // No spawn attribute offers this. The parent may have gone before it was asked for.
  if (::prctl(PR_SET_PDEATHSIG, SIGKILL) != 0) return;
  if (::getppid() != plan.parent) ::_exit(EXIT_FAILURE);
  if (::setsid() < 0) return;
  if (::dup2(plan.input, STDIN_FILENO) < 0 || ::dup2(plan.output, STDOUT_FILENO) < 0 ||
      ::dup2(plan.errors, STDERR_FILENO) < 0) {
    return;
  }
  close_on_exec_from(STDERR_FILENO + 1);
  // Default signals: what this program ignores or handles is its own affair.
  for (const int signal : {SIGPIPE, SIGINT, SIGTERM, SIGHUP}) ::signal(signal, SIG_DFL);
  sigset_t none;
  sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  ::execvp(plan.arguments[0], plan.arguments.data());  // glibc's does not allocate
}

/// The child's number, or -1. A handler of ours must not run in the child, so signals wait.
pid_t fork_child(const ChildPlan& plan) {
  sigset_t all, before;
  sigfillset(&all);
  ::pthread_sigmask(SIG_SETMASK, &all, &before);
  const pid_t pid = ::fork();
  if (pid == 0) {
    become(plan);
    const int why = errno;
    const auto written = ::write(plan.report, &why, sizeof why);
    ::_exit(written == sizeof why ? EXIT_FAILURE : EXIT_FAILURE + 1);
  }
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  return pid;
}

/// What the child says of its start: 0 once the exec has closed the pipe's other end.
int start_failure(int report) {
  int why = 0;
  ssize_t count = 0;
  do {
    count = ::read(report, &why, sizeof why);
  } while (count < 0 && errno == EINTR);
  return count == sizeof why ? why : 0;
}

}  // namespace

ChildProcess::ChildProcess(const std::vector<std::string>& command, const std::atomic<bool>* stop)
    : stop_(stop) {
  ignore_sigpipe();
  start(command);
}

ChildProcess::~ChildProcess() { end(Clock::now()); }

void ChildProcess::start(const std::vector<std::string>& command) {
  Pipe input, output, errors, report;
  if (!input.valid() || !output.valid() || !errors.valid() || !report.valid()) {
    start_error_ = fmt::format("no pipe: {}", std::strerror(errno));
    return;
  }
  ChildPlan plan{{}, input.read, output.write, errors.write, report.write, ::getpid()};
  for (const auto& word : command) plan.arguments.push_back(const_cast<char*>(word.c_str()));
  plan.arguments.push_back(nullptr);
  pid_ = fork_child(plan);
  int failure = pid_ < 0 ? errno : 0;
  if (pid_ > 0) {
    close_fd(report.write);
    failure = start_failure(report.read);
    if (failure != 0) ::waitpid(pid_, nullptr, 0);
  }
  if (failure != 0) {
    pid_ = -1;
    start_error_ = fmt::format("cannot start `{}`: {}", command[0], std::strerror(failure));
    return;
  }
  input_ = take(input.write);
  output_ = take(output.read);
  errors_ = take(errors.read);
  for (const int fd : {input_, output_, errors_}) ::fcntl(fd, F_SETFL, O_NONBLOCK);
}

void ChildProcess::drain_errors() {
  char chunk[4096];
  while (errors_ >= 0) {
    const auto count = ::read(errors_, chunk, sizeof chunk);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return;  // nothing there now
    if (count == 0) return close_fd(errors_);
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
  pollfd fds[2] = {{output_events == POLLOUT ? input_ : output_, output_events, 0},
                   {errors_, POLLIN, 0}};  // poll skips negative descriptors
  const int ready = ::poll(fds, 2, static_cast<int>(slice.count()));
  if (ready > 0 && fds[1].revents != 0) drain_errors();
  return ready > 0 && fds[0].revents != 0;
}

bool ChildProcess::write_line(std::string_view line, Clock::time_point deadline) {
  std::string text(line);
  text += '\n';
  std::string_view rest = text;
  while (!rest.empty()) {
    const auto count = ::write(input_, rest.data(), rest.size());
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
    const auto count = ::read(output_, chunk, sizeof chunk);
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
    if (errors_ >= 0) drain_errors();
    if (has_ended()) return true;
    if (Clock::now() >= deadline) return false;
    std::this_thread::sleep_for(kReapSlice);
  }
}

std::string ChildProcess::end(Clock::time_point deadline) {
  if (pid_ < 0) return ending_;
  close_fd(input_);
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
  close_fd(output_);
  close_fd(errors_);
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
