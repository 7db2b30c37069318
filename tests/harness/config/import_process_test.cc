// The separate process that reads files of unknown origin, and its answers.

#include <doctest/doctest.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <vector>

#include "harness/import/edited_text.h"
#include "harness/import/limited_child.h"
#include "harness/import/mjcf_model.h"

namespace parallax::harness::test {
namespace {

TEST_CASE("a process with limits answers, and how it ends otherwise is told") {
  constexpr std::size_t kMost = 1000;
  const auto answer = answer_of_child([] { return std::string("a\0b", 3); }, kMost, true);
  CHECK(answer.end == ChildEnd::kAnswered);
  CHECK(answer.bytes == std::string("a\0b", 3));
  CHECK(answer_of_child([] { return std::string(); }, kMost, true).end == ChildEnd::kAnswered);
  CHECK(answer_of_child([]() -> std::string { std::abort(); }, kMost, true).end ==
        ChildEnd::kCrashed);
  CHECK(answer_of_child([]() -> std::string { throw std::runtime_error("x"); }, kMost, true).end ==
        ChildEnd::kCrashed);
  CHECK(answer_of_child([]() -> std::string { ::_exit(0); }, kMost, true).bytes.empty());
  CHECK(answer_of_child([] { return std::string(100'000'000, 'x'); }, kMost, true).end ==
        ChildEnd::kTooLong);
}

TEST_CASE("it ends with whoever asked, and when it is to stop") {
  // A process asks, says the number of the process that works for it, and is killed.
  int ends[2];
  REQUIRE(::pipe2(ends, O_CLOEXEC) == 0);
  const pid_t asking = ::fork();
  REQUIRE(asking >= 0);
  if (asking == 0) {
    const auto working = [&]() -> std::string {
      const pid_t self = ::getpid();
      if (::write(ends[1], &self, sizeof(self)) != sizeof(self)) ::_exit(1);
      for (;;) ::pause();
    };
    (void)answer_of_child(working, 100, true);
    ::_exit(0);
  }
  pid_t worker = 0;
  REQUIRE(::read(ends[0], &worker, sizeof(worker)) == sizeof(worker));
  ::close(ends[1]);
  CHECK(::kill(worker, 0) == 0);
  ::kill(asking, SIGKILL);
  ::waitpid(asking, nullptr, 0);
  // Its end of the pipe is the last one: that closes when it has ended.
  char none = 0;
  CHECK(::read(ends[0], &none, 1) == 0);
  ::close(ends[0]);

  std::atomic<bool> stop{true};
  const auto waiting = []() -> std::string {
    for (;;) ::pause();
  };
  CHECK(answer_of_child(waiting, 100, true, &stop).end == ChildEnd::kStopped);
  stop = false;
  CHECK(answer_of_child([] { return std::string("fine"); }, 100, true, &stop).bytes == "fine");
}

TEST_CASE("it opens no file where it may not, and writes to none") {
  const auto opening = [] {
    return std::string(::open("/dev/null", O_RDONLY | O_CLOEXEC) < 0 ? "none" : "open");
  };
  CHECK(answer_of_child(opening, 100, true).bytes == "open");
  CHECK(answer_of_child(opening, 100, false).bytes == "none");
  // In the folder in which it would leave a log.
  const auto writing = []() -> std::string {
    const int fd = ::open(".", O_TMPFILE | O_RDWR, 0600);
    if (fd < 0) return "no such files here";
    return ::write(fd, "x", 1) == 1 ? "written" : "refused";
  };
  CHECK(answer_of_child(writing, 100, true).bytes != "written");
}

TEST_CASE("a text that is put together knows where its pieces came from") {
  EditedText text;
  CHECK(text.origin_of(5).source == 0);
  text.copy("first ", 1, 10);
  text.put("put", 1, 16);
  text.copy("", 3, 3);
  text.copy(" last", 2, 40);
  CHECK(text.text() == "first put last");
  for (const auto& [offset, source, from] : std::vector<std::array<std::size_t, 3>>{
           {0, 1, 10}, {5, 1, 15}, {6, 1, 16}, {8, 1, 16}, {9, 2, 40}, {13, 2, 44}}) {
    CHECK(text.origin_of(offset).source == source);
    CHECK(text.origin_of(offset).offset == from);
  }
}

/// A model with something of everything.
MjcfModel some_model() {
  MjcfModel model;
  model.bodies.resize(2);
  model.bodies[1].name = "crate";
  model.bodies[1].mass_kg = 2.5;
  model.joints.resize(1);
  model.joints[0].body = 1;
  model.joints[0].type = MjcfJointType::kHinge;
  model.geoms.resize(2);
  model.geoms[1].body = 1;
  model.geoms[1].form = MjcfForm::kMesh;
  model.meshes.resize(1);
  model.meshes[0].points = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  model.meshes[0].faces = {0, 1, 2};
  model.excluded = {{0, 1}};
  model.rest = {{"sensors", "sensor", 3, "eye"}};
  return model;
}

TEST_CASE("what comes back of the process that reads is taken over whole, or not at all") {
  const std::string bytes = bytes_of(some_model());
  const auto model = model_of(bytes);
  REQUIRE(model.has_value());
  CHECK(bytes_of(*model) == bytes);
  CHECK(model->bodies[1].name == "crate");
  CHECK(model->rest[0].first == "eye");
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    CHECK_FALSE(model_of(bytes.substr(0, length)).has_value());
  }
  CHECK_FALSE(model_of(bytes + "x").has_value());
  // Whatever a byte becomes, the model that is read names no body that is not there.
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    for (const int value : {0, 1, 2, 127, 255}) {
      std::string other = bytes;
      other[i] = static_cast<char>(value);
      const auto read = model_of(other);
      if (!read || read->fault) continue;
      for (const MjcfGeom& geom : read->geoms) CHECK(geom.body < read->bodies.size());
      for (const MjcfMesh& mesh : read->meshes) {
        for (const auto corner : mesh.faces) CHECK(3 * corner + 2 < mesh.points.size());
      }
    }
  }
  for (const auto& spoil : std::vector<void (*)(MjcfModel&)>{
           [](MjcfModel& m) { m.bodies[1].parent = 1; }, [](MjcfModel& m) { m.joints[0].body = 2; },
           [](MjcfModel& m) { m.geoms[1].mesh = 1; },
           [](MjcfModel& m) { m.meshes[0].faces[2] = 3; },
           [](MjcfModel& m) { m.excluded[0].second = 7; },
           [](MjcfModel& m) { m.bodies.clear(); }}) {
    MjcfModel bad = some_model();
    spoil(bad);
    CHECK_FALSE(model_of(bytes_of(bad)).has_value());
  }
}

}  // namespace
}  // namespace parallax::harness::test
