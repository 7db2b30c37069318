// Every process that a command has started ends with it, however it ends: cases of a suite,
// simulators, and processes that simulators leave behind in sessions of their own.

#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <thread>

#include "tests/tools/cli_json.h"

namespace parallax::test {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr auto kPatience = std::chrono::seconds(30);

/// A process that can still do something: a zombie cannot.
bool is_alive(pid_t pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/stat");
  std::string text;
  std::getline(file, text);
  const auto end = text.rfind(") ");
  return end != std::string::npos && text[end + 2] != 'Z' && text[end + 2] != 'X';
}

/// A scenario whose simulator never answers, and starts before that a program in a session of its
/// own and one that its parent has left. Each writes its number into a file.
class Leaving : public CliFixture {
 public:
  Leaving() {
    write("simulator.sh",
          "setsid sh -c 'echo $$ > session; exec sleep 1000' &\n"
          "sh -c 'setsid sh -c \"echo \\$\\$ > orphan; exec sleep 1000\" &'\n"
          "echo $$ > simulator\n" +
              std::string(kRest));
    write("s.yaml",
          "include: wrong_model.yaml\n"
          "simulator: {command: [sh, simulator.sh], hello_timeout_s: 100}\n");
  }
  ~Leaving() {  // what a failed test leaves
    for (const auto* name : kNames) {
      if (fs::exists(folder() / name) && is_alive(number(name))) ::kill(number(name), SIGKILL);
    }
  }
  pid_t number(const std::string& name) const { return std::atoi(read(name).c_str()); }
  bool all_started() const {
    for (const auto* name : kNames) {
      if (!fs::exists(folder() / name) || number(name) <= 0) return false;
    }
    return true;
  }
  void check_all_gone() const {
    const auto deadline = Clock::now() + kPatience;
    for (const auto* name : kNames) {
      CAPTURE(name);
      REQUIRE(number(name) > 1);
      while (is_alive(number(name)) && Clock::now() < deadline) {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
      }
      CHECK_FALSE(is_alive(number(name)));
    }
  }
  /// Runs the command and sends the signal when everything has been started.
  ProcessResult interrupted(const std::vector<std::string>& arguments, int signal) const {
    ProcessOptions options;
    options.signal_when = [&] { return all_started() ? signal : 0; };
    return parallax(arguments, options);
  }

 private:
  static constexpr const char* kRest = "while true; do sleep 1; done\n";
  static constexpr const char* kNames[] = {"session", "orphan", "simulator"};
};

TEST_CASE("SIGKILL of a suite ends its cases, their simulators and what these have started") {
  const Leaving cli;
  const auto result =
      cli.interrupted({"suite", "s.yaml", "--allow-commands", "--jobs", "2"}, SIGKILL);
  CHECK(result.code == 128 + SIGKILL);
  cli.check_all_gone();
}

TEST_CASE("SIGKILL of a run ends its simulator and what that has started") {
  const Leaving cli;
  CHECK(cli.interrupted({"run", "s.yaml", "--out", "r"}, SIGKILL).code == 128 + SIGKILL);
  cli.check_all_gone();
}

TEST_CASE("so does SIGTERM") {
  const Leaving cli;
  CHECK(cli.interrupted({"run", "s.yaml", "--out", "r"}, SIGTERM).code == 128 + SIGTERM);
  cli.check_all_gone();
}

TEST_CASE("SIGTERM is heard while a plan is unrolled, and says where that was") {
  const CliFixture cli;
  std::string items = "I0";
  for (int i = 1; i < 18; ++i) items += ",I" + std::to_string(i);
  cli.write("m.e", "range time 0 3\nsort item\nitem " + items +
                       "\nfluent Held(item)\nfluent Done()\nevent Go()\n"
                       "[time] Initiates(Go(),Done(),time).\n!HoldsAt(Done(),0).\n");
  cli.write("p.bind", "motion going -> Go() ok: Done() @t+1\nquery held (?o) ok: Held(?o) @t\n");
  // Every set of items is an answer of its own, and all of them fail.
  cli.write("p.lisp",
            "(def-fact-group none ())\n"
            "(unless (car (prolog '(and (held ?o) (held ?p) (not (held ?p)))))\n"
            "  (perform (a motion (type going))))\n");
  ProcessOptions options;
  int looks = 0;
  options.signal_when = [&] { return ++looks > 100 ? SIGTERM : 0; };
  const auto stopped =
      cli.parallax({"traces", "m.e", "--plan", "p.lisp", "--bind", "p.bind"}, options);
  CAPTURE(stopped.err);
  CHECK(stopped.code == 128 + SIGTERM);
  CHECK(stopped.err.find("p.lisp:2:") != std::string::npos);
  CHECK(stopped.err.find("CPL054") != std::string::npos);
}

TEST_CASE("a simulator that ends by itself leaves nothing behind either") {
  const Leaving cli;
  cli.write("simulator.sh",
            cli.read("simulator.sh").substr(0, cli.read("simulator.sh").find("while true")) +
                "while ! test -s session || ! test -s orphan; do sleep 0.01; done\n"
                "echo no more >&2\nexit 7\n");
  const auto result = cli.parallax({"run", "s.yaml", "--out", "r"});
  CHECK(result.code == 4);
  CHECK(result.err.find("exit status 7") != std::string::npos);
  CHECK(result.err.find("no more") != std::string::npos);
  cli.check_all_gone();
}

TEST_CASE("the end of a simulator by a signal is told as such") {
  const Leaving cli;
  cli.write("simulator.sh", "kill -SEGV $$\n");
  const auto result = cli.parallax({"run", "s.yaml", "--out", "r"});
  CHECK(result.code == 4);
  CHECK(result.err.find("signal 11") != std::string::npos);
}

}  // namespace
}  // namespace parallax::test
