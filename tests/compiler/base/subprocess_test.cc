#include "compiler/base/subprocess.h"

#include <doctest/doctest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <thread>

#include "compiler/base/descriptor.h"

namespace parallax::base {
namespace {

std::vector<std::string> shell(const std::string& script) { return {"sh", "-c", script}; }

TEST_CASE("a program's streams and its exit code are captured, each by itself") {
  const auto result = capture(shell("echo out; echo err >&2; exit 3"));
  CHECK(result.code == 3);
  CHECK(result.error == 0);
  CHECK(result.out == "out\n");
  CHECK(result.err == "err\n");
}

TEST_CASE("arguments arrive as they are: no shell looks at them") {
  CHECK(capture({"printf", "%s|%s", "a b", "$HOME;*"}).out == "a b|$HOME;*");
}

TEST_CASE("more output than a pipe holds is read, of errors only as much as is wanted") {
  CaptureOptions options;
  options.max_errors = 10;
  const auto result =
      capture(shell("head -c 300000 /dev/zero; head -c 300000 /dev/zero >&2"), options);
  CHECK(result.code == 0);
  CHECK(result.out.size() == 300'000);
  CHECK(result.err.size() == 10);
}

TEST_CASE("what cannot be started says why") {
  const auto missing = capture({"/nowhere/no-such-program"});
  CHECK(missing.code == -1);
  CHECK(missing.error == ENOENT);
  CaptureOptions options;
  options.folder = "/nowhere";
  CHECK(capture({"true"}, options).error == ENOENT);
  CHECK(spawn({"/"}, {}).error == EACCES);
}

TEST_CASE("the end by a signal is 128 and its number") {
  CHECK(capture(shell("kill -TERM $$")).code == 128 + SIGTERM);
}

TEST_CASE("a signal is sent while the program runs") {
  int asked = 0;
  CaptureOptions options;
  options.signal_when = [&] { return ++asked == 3 ? SIGTERM : 0; };
  const auto result =
      capture(shell("trap 'echo told; exit 5' TERM; while :; do sleep 0.01; done"), options);
  CHECK((result.code == 5 || result.code == 128 + SIGTERM));  // before the trap was set
  CHECK(asked >= 3);
}

TEST_CASE("program, folder and input are the caller's to choose") {
  CaptureOptions options;
  options.program = "sh";
  options.folder = "/";
  options.without_input = true;
  CHECK(capture({"other name", "-c", "pwd; echo $0; cat"}, options).out == "/\nother name\n");
}

TEST_CASE("descriptors of ours are closed in the program") {
  int ends[2];
  REQUIRE(::pipe(ends) == 0);  // inheritable
  const Descriptor read(ends[0]), write(ends[1]);
  const auto result = capture({"test", "-e", "/proc/self/fd/" + std::to_string(ends[1])});
  CHECK(result.code == 1);
}

TEST_CASE("ignored signals are default again in a session of its own, there alone") {
  const auto before = ::signal(SIGHUP, SIG_IGN);
  for (const bool own : {false, true}) {
    CAPTURE(own);
    Pipe out;
    SpawnOptions options;
    options.output = out.write.get();
    options.own_session = own;
    const auto child = spawn(shell("kill -HUP $$; echo alive"), options);
    REQUIRE(child.pid > 0);
    CHECK(wait_for(child.pid) == (own ? 128 + SIGHUP : 0));
  }
  ::signal(SIGHUP, before);
}

TEST_CASE("a session of its own is a process group") {
  Pipe in;
  SpawnOptions options;
  options.input = in.read.get();
  options.own_session = true;
  const auto child = spawn({"cat"}, options);
  REQUIRE(child.pid > 0);
  CHECK(::getpgid(child.pid) == child.pid);
  CHECK(::getsid(child.pid) == child.pid);
  CHECK(::kill(-child.pid, SIGKILL) == 0);
  CHECK(wait_for(child.pid) == 128 + SIGKILL);
}

TEST_CASE("descriptors and pipes close at the end of their scope, and move") {
  int number = -1;
  {
    Pipe pipe;
    REQUIRE(pipe.valid());
    number = pipe.read.get();
    Descriptor moved = std::move(pipe.read);
    CHECK_FALSE(pipe.read.valid());
    CHECK(moved.get() == number);
    CHECK(::fcntl(number, F_GETFD) == FD_CLOEXEC);
  }
  CHECK(::fcntl(number, F_GETFD) == -1);
}

}  // namespace
}  // namespace parallax::base
