// A launcher between parallax and a worker that goes wrong: unruly_launcher KINDS PERCENT LOG
// COMMAND... starts the command and hands lines on both ways. Of the simulations that pass through
// it that many of a hundred meet one of the KINDS (die,end,hang,lag), at any of their requests;
// each is written to LOG before. Which ones is as random as the machine can make it. Shares no code
// with the harness.

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <random>
#include <sstream>
#include <string>
#include <vector>

namespace {

constexpr int kRequests = 6;            // the most into a simulation at which it goes wrong
constexpr useconds_t kLag = 1'500'000;  // longer than any silence that the tests permit

void write_all(int fd, const std::string& text) {
  std::size_t done = 0;
  while (done < text.size()) {
    const auto count = ::write(fd, text.data() + done, text.size() - done);
    if (count <= 0) ::_exit(0);
    done += static_cast<std::size_t>(count);
  }
}

class Trouble {
 public:
  Trouble(const std::string& kinds, int percent, const char* log) : percent_(percent), log_(log) {
    std::istringstream in(kinds);
    for (std::string kind; std::getline(in, kind, ',');) kinds_.push_back(kind);
  }

  /// A request is about to be handed on.
  void meet(const std::string& request, pid_t worker) {
    if (request.find("\"method\":\"reset\"") != std::string::npos) {
      in_ = below(100) < percent_ ? below(kRequests) : -1;
    }
    if (in_ < 0 || in_-- > 0) return;
    const auto& kind = kinds_[static_cast<std::size_t>(below(static_cast<int>(kinds_.size())))];
    const int log = ::open(log_, O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0600);
    write_all(log, kind + '\n');
    ::close(log);
    if (kind == "lag") {
      ::usleep(kLag);
      return;
    }
    if (kind == "end") {  // as batch systems do it
      ::kill(worker, SIGTERM);
      return;
    }
    if (kind == "hang") {
      for (;;) ::pause();
    }
    ::kill(worker, SIGKILL);
    ::_exit(9);
  }

 private:
  int below(int limit) { return std::uniform_int_distribution<int>(0, limit - 1)(random_); }

  std::random_device random_;
  std::vector<std::string> kinds_;
  int percent_;
  const char* log_;
  int in_ = -1;  // requests until it goes wrong
};

}  // namespace

int main(int argc, char** argv) {
  if (argc < 5) return 2;
  Trouble trouble(argv[1], std::atoi(argv[2]), argv[3]);
  int to[2], from[2];
  if (::pipe2(to, O_CLOEXEC) != 0 || ::pipe2(from, O_CLOEXEC) != 0) return 2;
  const pid_t worker = ::fork();
  if (worker == 0) {
    ::dup2(to[0], STDIN_FILENO);
    ::dup2(from[1], STDOUT_FILENO);
    ::execvp(argv[4], argv + 4);
    ::_exit(127);
  }
  ::close(to[0]);
  ::close(from[1]);
  std::string requests;
  bool open = true;
  for (char chunk[65536];;) {
    pollfd at[2] = {{open ? STDIN_FILENO : -1, POLLIN, 0}, {from[0], POLLIN, 0}};
    if (::poll(at, 2, -1) < 0) return 3;
    if (at[1].revents != 0) {
      const auto count = ::read(from[0], chunk, sizeof chunk);
      if (count <= 0) break;
      write_all(STDOUT_FILENO, std::string(chunk, static_cast<std::size_t>(count)));
    }
    if (at[0].revents == 0) continue;
    const auto count = ::read(STDIN_FILENO, chunk, sizeof chunk);
    if (count <= 0) {
      open = false;
      ::close(to[1]);
      continue;
    }
    requests.append(chunk, static_cast<std::size_t>(count));
    for (auto end = requests.find('\n'); end != std::string::npos; end = requests.find('\n')) {
      const auto line = requests.substr(0, end + 1);
      requests.erase(0, end + 1);
      trouble.meet(line, worker);
      write_all(to[1], line);
    }
  }
  int status = 0;
  ::waitpid(worker, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}
