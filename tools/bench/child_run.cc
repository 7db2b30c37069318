#include "tools/bench/child_run.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>

#include "compiler/base/descriptor.h"
#include "compiler/base/subprocess.h"

namespace parallax::tools {
namespace {

/// A program on a busy machine gets a part of a processor; one that waits forever gets none.
constexpr double kWallPerCpu = 10.0;
constexpr int kNoSuchProgram = 127;  // as in shells

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

/// Waits for the end of the child, or kills it at the limit. True if it was killed.
bool kill_at_limit(pid_t child, double limit_s) {
  // glibc 2.36 declares pidfd_open for C only.
  const base::Descriptor handle(static_cast<int>(::syscall(SYS_pidfd_open, child, 0)));
  if (handle.get() < 0) return false;  // the caller waits without a limit
  pollfd ended{handle.get(), POLLIN, 0};
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

constexpr const char* kDigits = "0123456789";

/// The digits after the last `mark` and blanks.
std::string number_after(const std::string& text, const std::string& mark) {
  const auto at = text.rfind(mark);
  if (at == std::string::npos) return "";
  const auto begin = text.find_first_not_of(' ', at + mark.size());
  if (begin == std::string::npos) return "";
  const auto end = text.find_first_not_of(kDigits, begin);
  return text.substr(begin, end == std::string::npos ? end : end - begin);
}

}  // namespace

std::optional<ChildRun> run_child(const std::vector<std::string>& command,
                                  const ChildOptions& options) {
  const base::Descriptor output(
      ::open(options.output.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0600));
  const base::Descriptor null(::open("/dev/null", O_RDWR | O_CLOEXEC));
  if (!output.valid() || !null.valid()) return std::nullopt;
  base::SpawnOptions spawning;
  spawning.folder = options.folder;
  spawning.input = null.get();
  spawning.output = output.get();
  spawning.errors = null.get();
  spawning.cpu_limit_s = static_cast<std::uint64_t>(std::ceil(options.time_limit_s));
  const auto begin = std::chrono::steady_clock::now();
  const auto [child, error] = base::spawn(command, spawning);
  ChildRun run;
  if (error == ENOENT || error == EACCES || error == ENOEXEC || error == ENOTDIR) {
    run.code = kNoSuchProgram;
    return run;
  }
  if (child < 0) return std::nullopt;
  run.stopped = kill_at_limit(child, kWallPerCpu * options.time_limit_s);
  int status = 0;
  rusage usage{};
  if (::wait4(child, &status, 0, &usage) != child) return std::nullopt;
  run.cost.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  run.cost.cpu_s = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  run.cost.peak_mb = 1024e-6 * static_cast<double>(usage.ru_maxrss);
  run.stopped = run.stopped || (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU);
  run.code = base::exit_code(status);
  read_output(output.get(), run);
  return run;
}

std::string clingo_answer(const std::string& tail) {
  const auto at = tail.rfind("\nModels ");
  if (at == std::string::npos) return "";
  return number_after(tail.substr(at, tail.find('\n', at + 1) - at), ":");
}

std::string clingo_optimum(const std::string& tail) {
  const auto at = tail.rfind("\nOptimization ");
  if (at == std::string::npos || tail.find("OPTIMUM FOUND") == std::string::npos) return "";
  return number_after(tail.substr(at, tail.find('\n', at + 1) - at), ":");
}

std::string clingo_consequences(const std::string& tail) {
  const auto at = tail.rfind("\nConsequences ");
  if (at == std::string::npos) return "";
  return number_after(tail.substr(at, tail.find('\n', at + 1) - at), ":");
}

std::string consequences_answer(const std::string& tail, const std::vector<std::string>& extents) {
  const auto at = tail.rfind("\"counts\":{");
  if (at == std::string::npos) return "";
  std::int64_t sum = 0;
  for (const auto& extent : extents) {
    const auto number = number_after(tail.substr(at), "\"" + extent + "\":");
    if (number.empty()) return "";
    sum += std::stoll(number);
  }
  return std::to_string(sum);
}

std::string optimum_answer(const std::string& tail) { return number_after(tail, "\"optimum\":"); }

std::string jsonl_answer(const std::string& tail) {
  const auto at = tail.rfind("{\"summary\":true");
  return at == std::string::npos ? "" : number_after(tail.substr(at), "\"traces\":");
}

std::string count_answer(const std::string& tail) {
  const auto line = tail.substr(0, tail.find('\n'));
  return line.find_first_not_of(kDigits) == std::string::npos ? line : "";
}

}  // namespace parallax::tools
