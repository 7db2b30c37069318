#include "compiler/base/file_io.h"

#include <doctest/doctest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>

namespace parallax::base {
namespace {

namespace fs = std::filesystem;

class FileIo {
 public:
  FileIo() {
    std::string pattern = (fs::temp_directory_path() / "parallax-XXXXXX").string();
    REQUIRE(::mkdtemp(pattern.data()) != nullptr);
    folder_ = pattern;
  }
  FileIo(const FileIo&) = delete;
  FileIo& operator=(const FileIo&) = delete;
  ~FileIo() { fs::remove_all(folder_); }

 protected:
  fs::path write(const char* name, std::string_view text) {
    const auto path = folder_ / name;
    std::ofstream(path, std::ios::binary) << text;
    return path;
  }
  std::string_view only_code() const {
    const auto sorted = sink_.sorted();
    return sorted.size() == 1 ? info(sorted[0].code).id : std::string_view("not one");
  }
  fs::path folder_;
  DiagnosticSink sink_;
  SourceFiles files_;
};

TEST_CASE_FIXTURE(FileIo, "a file is read whole, byte by byte, also a large one") {
  const std::string text(300'000, 'x');
  CHECK(*read_file(write("a", text + '\0' + "end"), sink_) == text + '\0' + "end");
  CHECK(*read_file(write("empty", ""), sink_) == "");
}

TEST_CASE_FIXTURE(FileIo, "a missing file, a folder and a FIFO each have their message") {
  CHECK_FALSE(read_file(folder_ / "none", sink_));
  CHECK(only_code() == "E0001");
  sink_ = DiagnosticSink();
  CHECK_FALSE(read_file(folder_, sink_));
  CHECK(only_code() == "E0003");
  sink_ = DiagnosticSink();
  REQUIRE(::mkfifo((folder_ / "fifo").c_str(), 0600) == 0);
  CHECK_FALSE(read_file(folder_ / "fifo", sink_));
  CHECK(only_code() == "E0003");
  sink_ = DiagnosticSink();
  CHECK_FALSE(read_file("/dev/zero", sink_));
  CHECK(only_code() == "E0003");
}

TEST_CASE_FIXTURE(FileIo, "a file beyond the limit is refused, one at the limit is not") {
  const auto path = write("a", "12345");
  CHECK(read_file(path, sink_, 5));
  CHECK_FALSE(read_file(path, sink_, 4));
  CHECK(only_code() == "E0004");
}

TEST_CASE_FIXTURE(FileIo, "load_text drops a byte order mark and refuses what is no UTF-8") {
  const auto id = load_text(write("a", "\xEF\xBB\xBFsort a"), files_, sink_);
  REQUIRE(id);
  CHECK(files_[*id].text() == "sort a");
  for (const std::string& bad :
       {std::string("a\0b", 3), std::string("a\xFF"), std::string("a\xC3"),
        std::string("a\xE2\x82 b"), std::string("a\xE0\x80\x80"), std::string("a\xED\xA0\x80"),
        std::string("a\xF0\x8F\xBF\xBF"), std::string("a\xF4\x90\x80\x80")}) {
    sink_ = DiagnosticSink();
    CHECK_FALSE(load_text(write("bad", bad), files_, sink_));
    REQUIRE(only_code() == "E0006");
    CHECK(sink_.sorted()[0].range->begin == 1);
  }
}

TEST_CASE_FIXTURE(FileIo, "writing replaces the file at once and leaves no temporary one") {
  const auto path = write("a", "old");
  CHECK(write_file_atomically(path, "new", sink_));
  CHECK(*read_file(path, sink_) == "new");
  CHECK(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()) == 1);
  CHECK_FALSE(write_file_atomically(folder_ / "none" / "a", "x", sink_));
  CHECK(only_code() == "E0005");
}

TEST_CASE_FIXTURE(FileIo, "a link to what is open, as /dev/stdout is, stays one") {
  const auto log = write("log", "so far\n");
  std::FILE* open = std::fopen(log.c_str(), "a");
  REQUIRE(open != nullptr);
  fs::create_symlink("/proc/self/fd/" + std::to_string(::fileno(open)), folder_ / "first");
  fs::create_symlink("first", folder_ / "second");
  for (const auto* name : {"first", "second"}) {
    sink_ = DiagnosticSink();
    CHECK_FALSE(write_file_atomically(folder_ / name, "x", sink_));
    CHECK(only_code() == "E0003");
    CHECK(fs::is_symlink(folder_ / name));
  }
  std::fclose(open);
  CHECK(*read_file(log, sink_) == "so far\n");
  // Other links are replaced.
  fs::create_symlink("log", folder_ / "third");
  CHECK(write_file_atomically(folder_ / "third", "x", sink_));
  CHECK(*read_file(log, sink_) == "so far\n");
}

}  // namespace
}  // namespace parallax::base
