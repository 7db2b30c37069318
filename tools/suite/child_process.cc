#include "tools/suite/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>

extern char** environ;

namespace parallax::tools {
namespace {

constexpr int kPollMs = 100;  // how soon a raised stop flag is seen

/// A pipe that no other child inherits.
class Pipe {
 public:
  Pipe() { open_ = ::pipe2(ends_.data(), O_CLOEXEC) == 0; }
  ~Pipe() {
    close_write();
    close_read();
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  bool is_open() const { return open_; }
  int read_end() const { return ends_[0]; }
  int write_end() const { return ends_[1]; }
  void close_read() { close(ends_[0]); }
  void close_write() { close(ends_[1]); }

 private:
  static void close(int& end) {
    if (end >= 0) ::close(end);
    end = -1;
  }
  std::array<int, 2> ends_{-1, -1};
  bool open_ = false;
};

/// Starts the program with both output streams in pipes; 0 if that fails.
pid_t spawn(std::vector<std::string> words, const Pipe& out, const Pipe& err) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, out.write_end(), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, err.write_end(), STDERR_FILENO);
  std::vector<char*> argv;
  for (auto& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  pid_t child = 0;
  const int failed =
      ::posix_spawn(&child, "/proc/self/exe", &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  return failed == 0 ? child : 0;
}

/// Reads what is there; closes the pipe at its end. What is beyond `limit` is dropped.
void drain(Pipe& pipe, std::string& text, std::size_t limit) {
  std::array<char, 4096> buffer{};
  const auto count = ::read(pipe.read_end(), buffer.data(), buffer.size());
  if (count < 0 && errno == EINTR) return;
  if (count <= 0) return pipe.close_read();
  text.append(buffer.data(),
              std::min(static_cast<std::size_t>(count), limit - std::min(limit, text.size())));
}

/// Until the child has closed both streams.
void collect(pid_t child, Pipe& out, Pipe& err, const std::atomic<bool>& stop,
             ChildResult& result) {
  bool told = false;
  while (out.read_end() >= 0 || err.read_end() >= 0) {
    if (stop.load() && !told) {
      ::kill(child, SIGTERM);
      told = true;
    }
    std::array<pollfd, 2> ready{{{out.read_end(), POLLIN, 0}, {err.read_end(), POLLIN, 0}}};
    if (::poll(ready.data(), ready.size(), kPollMs) <= 0) continue;
    if (ready[0].revents != 0) drain(out, result.out, std::string::npos);
    if (ready[1].revents != 0) drain(err, result.err, kMaxMessageBytes);
  }
}

}  // namespace

ChildResult run_this_program(const std::vector<std::string>& arguments,
                             const std::atomic<bool>& stop) {
  ChildResult result;
  Pipe out;
  Pipe err;
  if (!out.is_open() || !err.is_open()) return result;
  std::vector<std::string> words = {"parallax"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  const pid_t child = spawn(std::move(words), out, err);
  out.close_write();
  err.close_write();
  if (child == 0) return result;
  collect(child, out, err, stop, result);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  result.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return result;
}

}  // namespace parallax::tools
