// The memory of a session, against what proc(5) says of every process of the machine.

#include "harness/simulator/process_memory.h"

#include <doctest/doctest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace parallax::harness {
namespace {

/// A shell in a session of its own that does a script's next part with each line.
class Shell {
 public:
  explicit Shell(const std::string& script) {
    int input[2], output[2];
    REQUIRE((::pipe(input) == 0 && ::pipe(output) == 0));
    pid_ = ::fork();
    if (pid_ == 0) {
      ::setsid();
      ::dup2(input[0], STDIN_FILENO);
      ::dup2(output[1], STDOUT_FILENO);
      for (const int end : {input[0], input[1], output[0], output[1]}) ::close(end);
      ::execl("/bin/sh", "sh", "-c", script.c_str(), nullptr);
      ::_exit(127);
    }
    REQUIRE(pid_ > 0);
    // Until it leads a session it belongs to ours, and no signal to its group would reach it.
    while (::getsid(pid_) != pid_) ::usleep(1'000);
    ::close(input[0]);
    ::close(output[1]);
    in_ = input[1];
    out_ = output[0];
  }
  ~Shell() {
    ::kill(-pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
    ::close(in_);
    ::close(out_);
  }
  Shell(const Shell&) = delete;
  Shell& operator=(const Shell&) = delete;

  pid_t pid() const { return pid_; }
  void go_on() const { REQUIRE(::write(in_, "\n", 1) == 1); }
  std::string line() const {
    std::string out;
    for (char c = 0; ::read(out_, &c, 1) == 1 && c != '\n';) out += c;
    return out;
  }

 private:
  pid_t pid_ = -1;
  int in_ = -1, out_ = -1;
};

struct Held {
  std::uint64_t bytes = 0;
  int processes = 0;
};

Held held_by(pid_t session) {
  Held out;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    std::ifstream stat(entry.path() / "stat");
    std::string text;
    if (!std::getline(stat, text)) continue;
    // Behind the name in parentheses: state, parent, group, session.
    const auto rest = text.substr(text.rfind(')') + 2);
    char state = 0;
    int parent = 0, group = 0, own = 0;
    REQUIRE(std::sscanf(rest.c_str(), "%c %d %d %d", &state, &parent, &group, &own) == 4);
    if (own != session) continue;
    std::ifstream statm(entry.path() / "statm");
    std::uint64_t size = 0, resident = 0;
    statm >> size >> resident;
    out.bytes += resident * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
    ++out.processes;
  }
  return out;
}

/// Once what was started does nothing but sleep.
void check_settled(SessionMemory& memory, pid_t session, int processes) {
  Held held;
  std::uint64_t bytes = 0;
  for (int i = 0; i < 500; ++i) {
    held = held_by(session);
    bytes = memory.bytes();
    if (held.processes == processes && held.bytes > 0 && bytes == held.bytes &&
        held_by(session).bytes == bytes)
      break;
    ::usleep(10'000);
  }
  CHECK(held.processes == processes);
  CHECK(bytes == held.bytes);
}

TEST_CASE("children of children, those whose parent has ended and later ones are counted") {
  const Shell shell(
      "sh -c 'sleep 100 & sleep 100 & wait' & (sleep 100 & sh -c 'sleep 100; :' &)\n"
      "setsid sleep 100 & echo $!; read line; sleep 100 & sh -c 'sleep 100; :' & echo; read line");
  const auto other = std::atoi(shell.line().c_str());
  REQUIRE(other > 0);
  SessionMemory memory(shell.pid());
  // The shell, two and one below it, and three without a parent; not the one that left.
  check_settled(memory, shell.pid(), 7);
  shell.go_on();
  shell.line();
  check_settled(memory, shell.pid(), 10);
  ::kill(other, SIGKILL);
}

TEST_CASE("a session that has ended holds nothing") {
  pid_t ended = -1;
  {
    const Shell shell("read line");
    ended = shell.pid();
    SessionMemory memory(ended);
    CHECK(memory.bytes() > 0);
  }
  CHECK(SessionMemory(ended).bytes() == 0);
}

}  // namespace
}  // namespace parallax::harness
