#include "tools/bench/child_run.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>

namespace parallax::tools {
namespace {

/// A program on a busy machine gets a part of a processor; one that waits for ever gets none.
constexpr double kWallPerCpu = 10.0;

/// A descriptor that is closed at the end of its scope.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number() const { return number_; }

 private:
  int number_;
};

/// After fork, in the child: only calls that are allowed there.
[[noreturn]] void become(char* const* argv, const char* folder, int output, rlim_t cpu_s) {
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
  const rlimit cpu{cpu_s, cpu_s + 1};
  ::setrlimit(RLIMIT_CPU, &cpu);
  const int null = ::open("/dev/null", O_RDWR);
  ::dup2(null, STDIN_FILENO);
  ::dup2(output, STDOUT_FILENO);
  ::dup2(null, STDERR_FILENO);
  if (*folder != '\0' && ::chdir(folder) != 0) _exit(126);
  ::execvp(argv[0], argv);
  _exit(127);
}

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

/// Waits for the end of the child, or kills it at the limit. True if it was killed.
bool kill_at_limit(pid_t child, double limit_s) {
  // glibc 2.36 declares pidfd_open for C only.
  const Descriptor handle(static_cast<int>(::syscall(SYS_pidfd_open, child, 0)));
  if (handle.number() < 0) return false;  // the caller waits without a limit
  pollfd ended{handle.number(), POLLIN, 0};
  if (::poll(&ended, 1, static_cast<int>(1e3 * limit_s)) > 0) return false;
  ::kill(child, SIGKILL);
  return true;
}

/// Size of the file in `run.cost.output_mb`, its end in `run.tail`.
void read_output(int file, ChildRun& run) {
  struct stat status {};
  if (::fstat(file, &status) != 0) return;
  run.cost.output_mb = 1e-6 * static_cast<double>(status.st_size);
  run.tail.resize(std::min(kTailBytes, static_cast<std::size_t>(status.st_size)));
  const auto from = status.st_size - static_cast<off_t>(run.tail.size());
  const auto count = ::pread(file, run.tail.data(), run.tail.size(), from);
  run.tail.resize(count < 0 ? 0 : static_cast<std::size_t>(count));
}

}  // namespace

std::optional<ChildRun> run_child(const std::vector<std::string>& command,
                                  const ChildOptions& options) {
  const Descriptor output(
      ::open(options.output.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0600));
  if (output.number() < 0) return std::nullopt;
  std::vector<std::string> words = command;
  std::vector<char*> argv;
  for (auto& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);

  const auto begin = std::chrono::steady_clock::now();
  const pid_t child = ::fork();
  if (child < 0) return std::nullopt;
  const auto cpu_s = static_cast<rlim_t>(std::ceil(options.time_limit_s));
  if (child == 0) become(argv.data(), options.folder.c_str(), output.number(), cpu_s);
  ChildRun run;
  run.stopped = kill_at_limit(child, kWallPerCpu * options.time_limit_s);
  int status = 0;
  rusage usage{};
  if (::wait4(child, &status, 0, &usage) != child) return std::nullopt;
  run.cost.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  run.cost.cpu_s = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  run.cost.peak_mb = 1024e-6 * static_cast<double>(usage.ru_maxrss);
  run.stopped = run.stopped || (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU);
  run.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  read_output(output.number(), run);
  return run;
}

}  // namespace parallax::tools
