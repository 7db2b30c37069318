#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cctype>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "compiler/base/descriptor.h"
#include "compiler/base/subprocess.h"
#include "harness/simulator/process_memory.h"
#include "tools/cli/command.h"
#include "tools/cli/limits.h"

namespace parallax::tools {
namespace {

using Clock = std::chrono::steady_clock;

/// Less than what ChildProcess waits between asking and killing, so that there is time to clean up.
constexpr auto kEndGrace = std::chrono::milliseconds(1500);
constexpr auto kCleaning = std::chrono::seconds(5);  // against programs that never stop forking
constexpr int kCannotStart = 127;                    // as shells have it

/// The children of a process among all that there are, for systems without lists of children.
std::vector<pid_t> children_by_search(pid_t parent) {
  std::vector<pid_t> children;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator("/proc", error)) {
    const auto name = entry.path().filename().string();
    if (std::isdigit(static_cast<unsigned char>(name.front())) == 0) continue;
    std::ifstream file(entry.path() / "stat");
    std::string text;
    std::getline(file, text, '\0');
    // "pid (name) state parent ...", where the name may hold anything.
    const auto end = text.rfind(") ");
    if (end == std::string::npos || text.size() < end + 4) continue;
    if (std::atoi(text.c_str() + end + 4) == parent) children.push_back(std::atoi(name.c_str()));
  }
  return children;
}

/// The children of this process, including those that it has taken over.
std::vector<pid_t> own_children() {
  const auto self = ::getpid();
  auto children = harness::children_of(self);
  return children ? std::move(*children) : children_by_search(self);
}

/// Kills what is left below this process: the children of a killed child come to us in turn.
void end_descendants() {
  const auto deadline = Clock::now() + kCleaning;
  while (Clock::now() < deadline) {
    pid_t ended = 0;
    while ((ended = ::waitpid(-1, nullptr, WNOHANG)) > 0) {
    }
    if (ended < 0 && errno == ECHILD) return;
    for (const auto child : own_children()) ::kill(child, SIGKILL);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
}

/// Ends as the program has ended, so that its end can be told from ours.
int end_like(int status) {
  if (WIFEXITED(status)) return WEXITSTATUS(status);
  const int number = WTERMSIG(status);
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
  ::signal(number, SIG_DFL);
  sigset_t one;
  sigemptyset(&one);
  sigaddset(&one, number);
  ::sigprocmask(SIG_UNBLOCK, &one, nullptr);
  ::raise(number);
  return 128 + number;
}

/// Waits for the program and returns its status. Ends earlier if our parent is gone or has asked
/// for the end and the program, which gets the same signal, does not follow.
int wait_for_end(pid_t program, pid_t parent) {
  sigset_t waited;
  sigemptyset(&waited);
  for (const int number : {SIGCHLD, SIGTERM, SIGINT, SIGHUP}) sigaddset(&waited, number);
  ::sigprocmask(SIG_BLOCK, &waited, nullptr);
  bool asked = stop_flag().load();
  auto deadline = Clock::now() + kEndGrace;
  for (;;) {
    int status = 0;
    pid_t ended = 0;
    while ((ended = ::waitpid(-1, &status, WNOHANG)) > 0) {
      if (ended == program) return status;
    }
    if (::getppid() != parent || (asked && Clock::now() >= deadline)) return SIGKILL;
    const timespec slice{0, 100'000'000};
    const int number = ::sigtimedwait(&waited, nullptr, &slice);
    if (asked || number <= 0 || number == SIGCHLD) continue;
    asked = true;
    deadline = Clock::now() + kEndGrace;
  }
}

int supervise(const std::vector<std::string>& command) {
  const auto parent = ::getppid();
  // Processes that the program leaves behind become our children. The end of our parent sends us
  // SIGTERM, so that we can clean up.
  ::prctl(PR_SET_CHILD_SUBREAPER, 1);
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  base::SpawnOptions options;
  options.ends_with_us = true;
  const auto program = base::spawn(command, options);
  if (program.pid < 0) {
    write_error(fmt::format("cannot start `{}`: {}\n", base::command_text(command),
                            std::strerror(program.error)));
    return kCannotStart;
  }
  // Only the program holds the ends of the pipes, so that their closing is noticed.
  const base::Descriptor null(::open("/dev/null", O_RDWR | O_CLOEXEC));
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    ::dup2(null.get(), stream);
  }
  const int status = wait_for_end(program.pid, parent);
  end_descendants();
  return end_like(status);
}

}  // namespace

Command supervise_command() {
  auto command = std::make_shared<std::vector<std::string>>();
  OptionTable table("supervise", "Run a command and end with it everything that it has started");
  table.hide();  // put before the commands of scenarios; not meant to be typed
  table.option("command", *command).required().program();
  return {std::move(table), [command](Invocation&) { return supervise(*command); }};
}

}  // namespace parallax::tools
