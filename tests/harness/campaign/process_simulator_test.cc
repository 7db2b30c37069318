#include "harness/simulator/process_simulator.h"

#include <doctest/doctest.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <set>
#include <thread>
#include <utility>
#include <vector>

namespace parallax::harness {
namespace {

using Clock = std::chrono::steady_clock;

ProcessOptions options_for(const std::string& mode) {
  ProcessOptions options;
  options.command = {PARALLAX_SCRIPTED_WORKER, mode};
  options.hello_timeout_s = options.reset_timeout_s = options.act_timeout_s = 0.3;
  options.observe_timeout_s = options.close_timeout_s = 0.3;
  if (mode == "answer" || mode == "chatty") {
    // A loaded machine must not make a working child look lost.
    options.hello_timeout_s = options.reset_timeout_s = options.act_timeout_s = 30.0;
    options.observe_timeout_s = options.close_timeout_s = 30.0;
  }
  return options;
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST_CASE("a child that answers is a simulator like any other") {
  ProcessSimulator simulator(options_for("answer"));
  const auto info = simulator.info();
  CHECK(info.name == "scripted");
  CHECK(info.version == "2");
  CHECK(info.timestep_s == 0.01);
  CHECK(simulator.reset({{"robot.x", 0.30000000000000004}}, 17).status == SimStatus::kOk);
  auto state = simulator.observe();
  CHECK(std::get<double>(state.at("robot.x")) == 0.30000000000000004);
  const auto outcome = simulator.act("going", {{"target.x", 1.0}}, 5.0);
  CHECK(outcome.status == SimStatus::kFailed);
  CHECK(outcome.reason == "blocked");
  CHECK(outcome.sim_time_s == 1.5);
  state = simulator.observe();
  CHECK(std::get<double>(state.at("robot.x")) == 0.1);
  // A session of its own: no signal from the terminal, one group to end it by.
  CHECK(state.at("session") == state.at("pid"));
}

/// Result of one action, with the recorded motion if there is any.
struct Moved {
  SimulatorInfo info;
  RecordedMotion motion;
  Outcome outcome;
};
Moved moved(const std::string& mode, double interval_s = 0.1) {
  auto options = options_for("answer");
  options.command[1] = mode;
  ProcessSimulator simulator(options);
  Moved out{simulator.info(), {}, {}};
  simulator.record_motion(interval_s);
  const auto start = simulator.reset({{"robot.x", 0.0}}, 1);
  CHECK(start.status == SimStatus::kOk);
  out.outcome = simulator.act("going", {}, 5.0);
  CHECK(out.outcome.status == SimStatus::kFailed);
  CHECK(out.outcome.reason == "blocked");
  out.motion.frames = start.motion.frames + out.outcome.motion.frames;
  out.motion.fault = start.motion.fault + out.outcome.motion.fault;
  return out;
}

TEST_CASE("poses of an external simulator: frames of what it says") {
  const auto out = moved("poses");
  REQUIRE(out.info.scene);
  CHECK(out.info.scene->bodies.size() == 3);
  CHECK(out.info.scene->moving() == std::vector<std::size_t>{1, 2});
  CHECK(out.motion.fault == "");
  MotionCursor cursor(out.motion.frames, {2, 1});
  for (int i = 0; i <= 15; ++i) {
    CAPTURE(i);
    REQUIRE(cursor.next());
    CHECK(cursor.time_s() == doctest::Approx(0.1 * i));
    CHECK(cursor.poses()[0].p[0] == doctest::Approx(0.1 * i).epsilon(1e-3));
    CHECK(cursor.poses()[1].p[0] == doctest::Approx(i < 5 ? 0.5 : 0.1 * i).epsilon(1e-3));
    CHECK(cursor.poses()[1].p[2] == doctest::Approx(1.0));
    CHECK(cursor.grips()[1] == (i < 5 ? 0 : kGripHeld));
  }
  CHECK_FALSE(cursor.next());
  CHECK(cursor.fault() == "");
}

TEST_CASE("poses of an external simulator: asked for or not there") {
  const auto unasked = moved("poses", 0.0);
  CHECK(unasked.motion == RecordedMotion());
  const auto unable = moved("answer");
  CHECK_FALSE(unable.info.scene);
  CHECK(unable.motion == RecordedMotion());
  const auto wrong = moved("poses-wrong-scene");
  CHECK_FALSE(wrong.info.scene);
  CHECK(wrong.motion == RecordedMotion());
}

TEST_CASE("poses of an external simulator: more frames than were asked for are thinned out") {
  const auto fast = moved("poses-fast");
  CHECK(fast.motion.fault == "");
  MotionCursor cursor(fast.motion.frames, {2, 1});
  int frames = 0;
  while (cursor.next()) ++frames;
  CHECK(frames >= 15);
  CHECK(frames <= 32);
  CHECK(cursor.poses()[0].p[0] == doctest::Approx(1.5).epsilon(1e-3));  // the last one stays
}

TEST_CASE("poses of an external simulator: nonsense costs the motion, not the outcome") {
  const std::vector<std::pair<std::string, std::string>> faults = {
      {"poses-unknown", "no moving body `ghost` was announced"},
      {"poses-static", "no moving body `table` was announced"},
      {"poses-far", "`cup` has a place that is not finite, or beyond 1e6 m"},
      {"poses-unturned", "`cup` has a turn that is no unit quaternion w-x-y-z"},
      {"poses-short", "the pose of `cup` is no list of 3 or 7 numbers"},
      {"poses-words", "the pose of `cup` is no list of 3 or 7 numbers"},
      {"poses-back", "a frame at 0.01 s follows one at 0.6 s"},
      {"poses-late", "a frame at 1e+300 s follows one at 0.6 s"},
      {"poses-hand", "no gripper `foot` was announced"},
      {"poses-no-time", "`t` of a frame is missing or no number"},
      {"poses-no-list", "`poses` is no list of frames"},
      {"poses-no-base64", "`motion` is no text in base64"},
      {"poses-both", "it sends `poses` and `motion`"},
      {"poses-partial", "the first frame does not say where `cup` is"}};
  for (const auto& [mode, fault] : faults) {
    CAPTURE(mode);
    const auto out = moved(mode);
    CHECK(out.motion.fault == fault);
    // The frames before the fault are kept.
    MotionCursor cursor(out.motion.frames, {2, 1});
    while (cursor.next()) CHECK(cursor.time_s() < 0.75);
    CHECK(cursor.fault() == "");
  }
}

TEST_CASE("an invalid start and a refusal are answers, not losses") {
  ProcessSimulator invalid(options_for("invalid"));
  const auto start = invalid.reset({}, 1);
  CHECK(start.status == SimStatus::kInvalidStart);
  CHECK(start.reason == "box overlaps counter");
  ProcessSimulator refusing(options_for("refuse"));
  CHECK(refusing.reset({}, 1).status == SimStatus::kOk);
  const auto act = refusing.act("fly", {}, 1.0);
  CHECK(act.status == SimStatus::kUnsupported);
  CHECK(act.reason == "no action `fly`");
  CHECK(refusing.observe().contains("pid"));  // still the same child
}

TEST_CASE("a crash is a loss with the signal and the last lines of standard error") {
  ProcessSimulator simulator(options_for("act-crash"));
  REQUIRE(simulator.reset({}, 1).status == SimStatus::kOk);
  const auto outcome = simulator.act("going", {}, 1.0);
  CHECK(outcome.status == SimStatus::kLost);
  CHECK(contains(outcome.reason, "signal 9"));
  CHECK(contains(outcome.reason, "assertion failed: x < y"));
  CHECK(simulator.act("going", {}, 1.0).status == SimStatus::kLost);
  const auto observed = simulator.observe();
  CHECK(observed.size() == 1);
  CHECK(observed.contains(kLostVariable));
}

TEST_CASE("an exit is a loss with the exit status") {
  ProcessSimulator simulator(options_for("reset-exit"));
  const auto outcome = simulator.reset({}, 1);
  CHECK(outcome.status == SimStatus::kLost);
  CHECK(contains(outcome.reason, "exit status 7"));
  CHECK(contains(outcome.reason, "`reset`"));
}

TEST_CASE("a child that hangs is ended in time, whichever request it was") {
  for (const std::string method : {"hello", "reset", "act", "observe"}) {
    CAPTURE(method);
    ProcessSimulator simulator(options_for(method + "-hang"));
    auto outcome = simulator.reset({}, 1);
    if (outcome.status == SimStatus::kOk) outcome = simulator.act("going", {}, 1.0);
    if (method == "observe") {
      CHECK(simulator.observe().contains(kLostVariable));
    } else {
      CHECK(outcome.status == SimStatus::kLost);
      CHECK(contains(outcome.reason, "no reply to `" + method + "` within 0.3 s"));
    }
  }
}

TEST_CASE("a child that ignores TERM is killed") {
  ProcessSimulator simulator(options_for("act-stubborn"));
  REQUIRE(simulator.reset({}, 1).status == SimStatus::kOk);
  const auto pid = static_cast<pid_t>(std::get<std::int64_t>(simulator.observe().at("pid")));
  const auto outcome = simulator.act("going", {}, 1.0);
  CHECK(outcome.status == SimStatus::kLost);
  CHECK(contains(outcome.reason, "signal 9"));
  CHECK(::kill(pid, 0) == -1);
  CHECK(errno == ESRCH);
}

TEST_CASE("a child that takes too much memory, by itself or by what it starts, is lost") {
  for (const std::string mode : {"act-hog", "act-hog-child"}) {
    CAPTURE(mode);
    auto options = options_for(mode);
    options.act_timeout_s = 60.0;
    options.memory_mb = 64;
    ProcessSimulator simulator(options);
    REQUIRE(simulator.reset({}, 1).status == SimStatus::kOk);
    const auto outcome = simulator.act("going", {}, 1.0);
    CHECK(outcome.status == SimStatus::kLost);
    CHECK(contains(outcome.reason, "more than 64 MiB of memory during `act`"));
  }
}

TEST_CASE("lines that are not the protocol lose the child") {
  for (const std::string mode : {"act-garbage", "act-wrong-id", "act-endless"}) {
    CAPTURE(mode);
    ProcessSimulator simulator(options_for(mode));
    REQUIRE(simulator.reset({}, 1).status == SimStatus::kOk);
    const auto outcome = simulator.act("going", {}, 1.0);
    CHECK(outcome.status == SimStatus::kLost);
    CHECK((contains(outcome.reason, "malformed reply to `act`") ||
           contains(outcome.reason, "is longer than")));
  }
}

TEST_CASE("an observation that cannot be said is a loss") {
  ProcessSimulator simulator(options_for("nan"));
  REQUIRE(simulator.reset({}, 1).status == SimStatus::kOk);
  const auto observed = simulator.observe();
  REQUIRE(observed.contains(kLostVariable));
  CHECK(contains(std::get<std::string>(observed.at("lost")), "`box.x` is not finite"));
}

TEST_CASE("the reset after a loss starts a new child") {
  ProcessSimulator simulator(options_for("third-act-crash"));
  REQUIRE(simulator.reset({}, 1).status == SimStatus::kOk);
  const auto first = simulator.observe().at("pid");
  CHECK(simulator.act("going", {}, 60.0).status == SimStatus::kFailed);
  CHECK(simulator.act("going", {}, 60.0).status == SimStatus::kFailed);
  CHECK(simulator.act("going", {}, 1.0).status == SimStatus::kLost);
  REQUIRE(simulator.reset({}, 1).status == SimStatus::kOk);
  CHECK(simulator.observe().at("pid") != first);
  CHECK(simulator.act("going", {}, 60.0).status == SimStatus::kFailed);
}

TEST_CASE("a child is replaced after so many resets") {
  auto options = options_for("answer");
  options.recycle_after = 3;
  ProcessSimulator simulator(options);
  std::set<std::int64_t> children;
  for (int i = 0; i < 7; ++i) {
    REQUIRE(simulator.reset({}, 1).status == SimStatus::kOk);
    children.insert(std::get<std::int64_t>(simulator.observe().at("pid")));
  }
  CHECK(children.size() == 3);
}

TEST_CASE("what does not start says why") {
  ProcessOptions options;
  options.command = {"/nonexistent/simulator"};
  ProcessSimulator missing(options);
  CHECK(missing.info().name.empty());
  CHECK(contains(missing.info().version, "cannot start `/nonexistent/simulator`"));
  CHECK(missing.reset({}, 1).status == SimStatus::kLost);
  ProcessSimulator dying(options_for("dies"));
  const auto info = dying.info();
  CHECK(info.name.empty());
  CHECK(contains(info.version, "exit status 3"));
  CHECK(contains(info.version, "no licence"));
}

TEST_CASE("a child that writes much to standard error is not stopped by it") {
  ProcessSimulator simulator(options_for("chatty"));
  REQUIRE(simulator.reset({}, 1).status == SimStatus::kOk);
  CHECK(simulator.act("going", {}, 60.0).status == SimStatus::kFailed);
}

TEST_CASE("the stop flag ends the waiting") {
  std::atomic<bool> stop = false;
  auto options = options_for("act-hang");
  options.act_timeout_s = 600.0;
  options.stop = &stop;
  ProcessSimulator simulator(options);
  REQUIRE(simulator.reset({}, 1).status == SimStatus::kOk);
  std::thread raise([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    stop = true;
  });
  const auto outcome = simulator.act("going", {}, 600.0);
  raise.join();
  CHECK(outcome.status == SimStatus::kLost);
  CHECK(contains(outcome.reason, "interrupted"));
}

TEST_CASE("a child inherits nothing but its three standard descriptors") {
  // Without O_CLOEXEC, as a careless library would; far above the shell's own for its pipe.
  const int leaked = ::fcntl(STDERR_FILENO, F_DUPFD, 100);
  REQUIRE(leaked >= 100);
  ProcessOptions options;
  options.command = {"/bin/sh", "-c", "ls /proc/$$/fd | tr '\\n' ' ' >&2"};
  options.hello_timeout_s = 30.0;
  ProcessSimulator simulator(options);
  const auto reason = simulator.info().version;
  ::close(leaked);
  CHECK(contains(reason, "standard error:\n| 0 1 2"));
  CHECK_FALSE(contains(reason, " " + std::to_string(leaked) + " "));
}

/// Runs in a separate process: starts a child that will never look at its input again, reports its
/// number, and is killed. None of its destructors run.
[[noreturn]] void leave_child_behind(int report) {
  ChildProcess child({PARALLAX_SCRIPTED_WORKER, "act-hang"}, 0, nullptr);
  const auto deadline = Clock::now() + std::chrono::seconds(30);
  constexpr std::size_t kMaxBytes = 4096;
  std::string line;
  child.write_line(R"({"id":1,"method":"reset","params":{"state":{},"seed":1}})", deadline);
  child.read_line(line, deadline, kMaxBytes);
  child.write_line(R"({"id":2,"method":"observe"})", deadline);
  child.read_line(line, deadline, kMaxBytes);
  child.write_line(R"({"id":3,"method":"act"})", deadline);
  const auto written = ::write(report, line.data(), line.size());
  ::raise(SIGKILL);
  ::_exit(written > 0 ? 0 : 1);
}

TEST_CASE("a child is killed when the program that started it is") {
  REQUIRE(::prctl(PR_SET_CHILD_SUBREAPER, 1) == 0);  // so that the orphan comes to us
  int report[2];
  REQUIRE(::pipe2(report, O_CLOEXEC) == 0);
  const pid_t program = ::fork();
  if (program == 0) leave_child_behind(report[1]);
  ::close(report[1]);
  REQUIRE(program > 0);
  int status = 0;
  REQUIRE(::waitpid(program, &status, 0) == program);
  CHECK(WTERMSIG(status) == SIGKILL);
  char text[4096] = {};
  REQUIRE(::read(report[0], text, sizeof text - 1) > 0);
  ::close(report[0]);
  const auto* at = std::strstr(text, "\"pid\":");
  REQUIRE(at != nullptr);
  const auto orphan = static_cast<pid_t>(std::strtol(at + 6, nullptr, 10));
  REQUIRE(orphan > 1);
  const auto deadline = Clock::now() + std::chrono::seconds(10);
  pid_t ended = 0;
  while ((ended = ::waitpid(orphan, &status, WNOHANG)) == 0 && Clock::now() < deadline) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  CHECK(ended == orphan);
  CHECK(WTERMSIG(status) == SIGKILL);
  if (ended == 0) {
    ::kill(orphan, SIGKILL);
    ::waitpid(orphan, nullptr, 0);
  }
  ::prctl(PR_SET_CHILD_SUBREAPER, 0);
}

}  // namespace
}  // namespace parallax::harness
