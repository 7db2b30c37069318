#include "harness/monitor/line_source.h"

#include <doctest/doctest.h>
#include <unistd.h>

#include <csignal>
#include <string>
#include <thread>
#include <vector>

#include "compiler/base/descriptor.h"
#include "compiler/base/file_io.h"

namespace parallax::test {
namespace {

using harness::LineSource;
using Status = LineSource::Status;

struct Read {
  std::vector<std::string> lines;
  Status last = Status::kLine;
};

/// Lines read from a pipe that is written in pieces.
Read read_all(const std::vector<std::string>& pieces, std::size_t max_line) {
  base::Pipe pipe;
  REQUIRE(pipe.valid());
  ::signal(SIGPIPE, SIG_IGN);  // the reader may have seen enough
  std::thread writer([&] {
    for (const auto& piece : pieces) {
      if (!base::write_all(pipe.write.get(), piece)) break;
    }
    pipe.write.close();
  });
  const std::atomic<bool> stop = false;
  LineSource source(pipe.read.get(), stop, max_line);
  Read out;
  std::string_view line;
  while (true) {
    out.last = source.next(line);
    if (out.last != Status::kLine && out.last != Status::kCut) break;
    out.lines.emplace_back(line);
    if (out.last == Status::kCut) break;
  }
  pipe.read.close();
  writer.join();
  return out;
}

TEST_CASE("lines are whole however they arrive, and the last one says whether it is") {
  const auto whole = read_all({"a", "b\nc\r", "\n", "\n", "d\n"}, 100);
  CHECK(whole.lines == std::vector<std::string>{"ab", "c", "", "d"});
  CHECK(whole.last == Status::kEnd);
  const auto cut = read_all({"ab\ncd"}, 100);
  CHECK(cut.lines == std::vector<std::string>{"ab", "cd"});
  CHECK(cut.last == Status::kCut);
  CHECK(read_all({}, 100).last == Status::kEnd);
}

TEST_CASE("a line that is too long ends it, whether it has an end or not") {
  const std::string longer(300'000, 'x');
  CHECK(read_all({"a\n", longer + "\nb\n"}, 100'000).last == Status::kTooLong);
  CHECK(read_all({"a\n", longer}, 100'000).last == Status::kTooLong);
  const auto fits = read_all({longer + "\n"}, longer.size());
  CHECK(fits.lines == std::vector<std::string>{longer});
}

TEST_CASE("a raised flag ends waiting for more") {
  base::Pipe pipe;
  REQUIRE(pipe.valid());
  const std::atomic<bool> stop = true;
  LineSource source(pipe.read.get(), stop);
  std::string_view line;
  CHECK(source.next(line) == Status::kStopped);
}

TEST_CASE("what cannot be read is said") {
  const std::atomic<bool> stop = false;
  base::Descriptor folder(::open("/", O_RDONLY | O_DIRECTORY));
  LineSource source(folder.get(), stop);
  std::string_view line;
  CHECK(source.next(line) == Status::kFailed);
  CHECK(source.error() == EISDIR);
}

}  // namespace
}  // namespace parallax::test
