#include "compiler/base/subprocess.h"

#include <fcntl.h>
#include <linux/close_range.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>

#include "compiler/base/descriptor.h"
#include "compiler/base/diagnostic_printer.h"

namespace parallax::base {
namespace {

constexpr int kPollMs = 20;  // how late `signal_when` may be asked

/// Data that the child needs to become the program. Prepared before the child is there, which may
/// make only async-signal-safe calls.
struct ChildPlan {
  std::vector<char*> arguments;
  const char* program;
  const SpawnOptions& options;
  int report;
  pid_t parent;
};

/// Every other descriptor is closed by the exec.
void close_on_exec_from(int first) {
  if (::close_range(static_cast<unsigned>(first), ~0U, CLOSE_RANGE_CLOEXEC) == 0) return;
  const long limit = ::sysconf(_SC_OPEN_MAX);  // a kernel before 5.11
  for (int fd = first; fd < limit; ++fd) ::fcntl(fd, F_SETFD, FD_CLOEXEC);
}

/// Resets signal handlers to the default in the child, where this program's handlers must not run.
void default_handlers(bool also_ignored) {
  for (int number = 1; number < NSIG; ++number) {
    struct sigaction action {};
    if (::sigaction(number, nullptr, &action) != 0 || action.sa_handler == SIG_DFL) continue;
    if (action.sa_handler == SIG_IGN && !also_ignored) continue;
    ::signal(number, SIG_DFL);
  }
}

bool redirect(int from, int to) {
  if (from < 0) return true;
  // dup2 would leave it to be closed by the exec.
  if (from == to) return ::fcntl(to, F_SETFD, 0) == 0;
  return ::dup2(from, to) >= 0;
}

/// In the child, which blocks `signals` when the program starts. Comes back, with errno, only when
/// the program could not be started.
void become(const ChildPlan& plan, const sigset_t& signals) {
  const auto& options = plan.options;
  if (options.own_session || options.ends_with_us) {
    // No spawn attribute offers this. The parent may have gone before it was asked for.
    if (::prctl(PR_SET_PDEATHSIG, SIGKILL) != 0) return;
    if (::getppid() != plan.parent) ::_exit(EXIT_FAILURE);
  }
  if (options.own_session && ::setsid() < 0) return;
  if (options.cpu_limit_s) {
    const rlimit no_core{0, 0}, cpu{*options.cpu_limit_s, *options.cpu_limit_s + 1};
    if (::setrlimit(RLIMIT_CORE, &no_core) != 0 || ::setrlimit(RLIMIT_CPU, &cpu) != 0) return;
  }
  if (!redirect(options.input, STDIN_FILENO) || !redirect(options.output, STDOUT_FILENO) ||
      !redirect(options.errors, STDERR_FILENO)) {
    return;
  }
  if (!options.folder.empty() && ::chdir(options.folder.c_str()) != 0) return;
  close_on_exec_from(STDERR_FILENO + 1);
  default_handlers(options.own_session);
  ::sigprocmask(SIG_SETMASK, &signals, nullptr);
  ::execvp(plan.program, plan.arguments.data());  // glibc's does not allocate
}

/// The child's number, or -1. Signals wait meanwhile.
///
/// The child borrows our memory until it is the program (`vfork`), so it must not change any of
/// it. A copy of a process with a thousand threads took longer than the start of most programs.
pid_t fork_child(const ChildPlan& plan) {
  sigset_t all, before;
  sigfillset(&all);
  ::pthread_sigmask(SIG_SETMASK, &all, &before);
  auto signals = before;
  if (plan.options.own_session) sigemptyset(&signals);
  const pid_t pid = ::vfork();
  if (pid == 0) {
    become(plan, signals);
    const int why = errno;
    const auto written = ::write(plan.report, &why, sizeof why);
    ::_exit(written == sizeof why ? EXIT_FAILURE : EXIT_FAILURE + 1);
  }
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  return pid;
}

/// Error number that the child reports from its start; 0 once the exec has closed the pipe's other
/// end.
int start_failure(int report) {
  int why = 0;
  ssize_t count = 0;
  do {
    count = ::read(report, &why, sizeof why);
  } while (count < 0 && errno == EINTR);
  return count == sizeof why ? why : 0;
}

/// Reads the available text; closes the descriptor at the end. Text beyond `limit` is dropped.
void drain(Descriptor& from, std::string& text, std::size_t limit) {
  std::array<char, 1 << 16> buffer;
  const auto count = ::read(from.get(), buffer.data(), buffer.size());
  if (count < 0 && errno == EINTR) return;
  if (count <= 0) return from.close();
  text.append(buffer.data(),
              std::min(static_cast<std::size_t>(count), limit - std::min(limit, text.size())));
}

}  // namespace

Spawned spawn(const std::vector<std::string>& command, const SpawnOptions& options) {
  Pipe report;
  if (!report.valid()) return {-1, errno};
  ChildPlan plan{{}, command.front().c_str(), options, report.write.get(), ::getpid()};
  if (!options.program.empty()) plan.program = options.program.c_str();
  for (const auto& word : command) plan.arguments.push_back(const_cast<char*>(word.c_str()));
  plan.arguments.push_back(nullptr);
  const pid_t pid = fork_child(plan);
  if (pid < 0) return {-1, errno};
  report.write.close();
  const int failure = start_failure(report.read.get());
  if (failure == 0) return {pid, 0};
  wait_for(pid);
  return {-1, failure};
}

std::string command_text(const std::vector<std::string>& command) {
  std::string text;
  for (const auto& word : command) {
    const bool plain = !word.empty() && word.find_first_of(" \t\n\"'") == std::string::npos;
    if (!text.empty()) text += ' ';
    text += plain ? printable(word) : '"' + printable(word) + '"';
  }
  return text;
}

int exit_code(int status) {
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

int wait_for(pid_t child) {
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return exit_code(status);
}

Captured capture(const std::vector<std::string>& command, const CaptureOptions& options) {
  Captured result;
  Pipe out, err;
  const Descriptor null(options.without_input ? ::open("/dev/null", O_RDONLY | O_CLOEXEC) : -1);
  if (!out.valid() || !err.valid() || null.valid() != options.without_input) {
    result.error = errno;
    return result;
  }
  SpawnOptions spawning{options.program, options.folder};
  spawning.input = null.get();
  spawning.output = out.write.get();
  spawning.errors = err.write.get();
  spawning.ends_with_us = options.ends_with_us;
  spawning.cpu_limit_s = options.cpu_limit_s;
  const auto child = spawn(command, spawning);
  out.write.close();
  err.write.close();
  result.error = child.error;
  if (child.pid < 0) return result;
  while (out.read.valid() || err.read.valid()) {
    const int signal = options.signal_when ? options.signal_when() : 0;
    if (signal != 0) ::kill(child.pid, signal);
    // poll skips negative descriptors.
    std::array<pollfd, 2> ready{{{out.read.get(), POLLIN, 0}, {err.read.get(), POLLIN, 0}}};
    if (::poll(ready.data(), ready.size(), kPollMs) <= 0) continue;
    if (ready[0].revents != 0) drain(out.read, result.out, std::string::npos);
    if (ready[1].revents != 0) drain(err.read, result.err, options.max_errors);
  }
  result.code = wait_for(child.pid);
  return result;
}

}  // namespace parallax::base
