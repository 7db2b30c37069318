#include "tests/support/process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <stdexcept>

namespace parallax::test {
namespace {

struct Pipe {
  std::array<int, 2> ends{};
  Pipe() {
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("pipe");
  }
  ~Pipe() {
    close(0);
    close(1);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  void close(std::size_t end) {
    if (ends[end] >= 0) ::close(ends[end]);
    ends[end] = -1;
  }
};

/// Appends what is there; closes the pipe at its end. False when it is closed.
bool drain(Pipe& pipe, std::string& out) {
  std::array<char, 65536> buffer{};
  const auto count = ::read(pipe.ends[0], buffer.data(), buffer.size());
  if (count > 0) out.append(buffer.data(), static_cast<std::size_t>(count));
  if (count == 0) pipe.close(0);
  return count > 0;
}

[[noreturn]] void become(const std::vector<std::string>& command, const std::string& folder,
                         Pipe& out, Pipe& err) {
  std::vector<char*> argv;
  for (const auto& word : command) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  const int null = ::open("/dev/null", O_RDONLY);
  ::dup2(null, STDIN_FILENO);
  ::dup2(out.ends[1], STDOUT_FILENO);
  ::dup2(err.ends[1], STDERR_FILENO);
  if (!folder.empty() && ::chdir(folder.c_str()) != 0) _exit(126);
  ::execvp(argv[0], argv.data());
  _exit(127);
}

}  // namespace

ProcessResult run_process(const std::vector<std::string>& command, const ProcessOptions& options) {
  Pipe out, err;
  const auto child = ::fork();
  if (child < 0) throw std::runtime_error("fork");
  if (child == 0) become(command, options.folder, out, err);
  out.close(1);
  err.close(1);
  ProcessResult result;
  const auto deadline = std::chrono::steady_clock::now() + options.limit;
  bool signalled = false;
  while (out.ends[0] >= 0 || err.ends[0] >= 0) {
    std::array<pollfd, 2> waits = {pollfd{out.ends[0], POLLIN, 0}, pollfd{err.ends[0], POLLIN, 0}};
    ::poll(waits.data(), waits.size(), 5);
    if (waits[0].revents != 0) drain(out, result.out);
    if (waits[1].revents != 0) drain(err, result.err);
    if (!signalled && options.signal_when) {
      const int signal = options.signal_when();
      if (signal != 0) {
        ::kill(child, signal);
        signalled = true;
      }
    }
    if (std::chrono::steady_clock::now() > deadline) {
      ::kill(child, SIGKILL);
      ::waitpid(child, nullptr, 0);
      throw std::runtime_error("the process did not end in time");
    }
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  result.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return result;
}

}  // namespace parallax::test
