// The files that a file may name.

#include "compiler/base/path_gate.h"

#include <doctest/doctest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <optional>
#include <string>

#include "compiler/base/codes/files.h"
#include "compiler/base/codes/texts.h"
#include "compiler/base/file_io.h"

namespace parallax::base {
namespace {

namespace fs = std::filesystem;

/// An empty folder as the current one, and another value of HOME if asked for.
class Place {
 public:
  Place() : before_(fs::current_path()) {
    auto pattern = (fs::temp_directory_path() / "parallax-XXXXXX").string();
    REQUIRE(::mkdtemp(pattern.data()) != nullptr);
    path_ = fs::canonical(pattern);
    fs::current_path(path_);
    if (const char* home = std::getenv("HOME")) home_ = home;
  }
  ~Place() {
    fs::current_path(before_);
    if (home_) {
      ::setenv("HOME", home_->c_str(), 1);
    } else {
      ::unsetenv("HOME");
    }
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  Place(const Place&) = delete;
  Place& operator=(const Place&) = delete;
  void write(const fs::path& name) const {
    fs::create_directories((path_ / name).parent_path());
    std::ofstream(path_ / name) << "x";
  }
  const fs::path& path() const { return path_; }

 private:
  fs::path before_, path_;
  std::optional<std::string> home_;
};

PathGate gate_of(const fs::path& file) {
  PathGate gate;
  gate.admit_beside(file);
  return gate;
}

TEST_CASE("a file names files of its own folder and below, whether they exist or not") {
  const Place place;
  place.write("a/b/s.yaml");
  for (const fs::path& named : {fs::path("a/b/s.yaml"), place.path() / "a/b/s.yaml"}) {
    const auto gate = gate_of(named);
    CHECK(gate.admits("a/b/x"));
    CHECK(gate.admits("a/b/c/d/x"));
    CHECK(gate.admits("a/b/../b/x"));
    CHECK_FALSE(gate.admits("a/x"));
    CHECK_FALSE(gate.admits("a/b/../x"));
    CHECK_FALSE(gate.admits("a/bc/x"));
    CHECK_FALSE(gate.admits("/etc/passwd"));
  }
  CHECK(PathGate(true).admits("/etc/passwd"));
  CHECK_FALSE(PathGate().admits("a/b/x"));
}

TEST_CASE("links are resolved first") {
  const Place place;
  place.write("a/s.yaml");
  place.write("secret");
  fs::create_symlink("../secret", "a/file");
  fs::create_symlink("..", "a/folder");
  fs::create_symlink("s.yaml", "a/inner");
  fs::create_symlink("../nothing", "a/dangling");
  const auto gate = gate_of("a/s.yaml");
  CHECK(gate.admits("a/inner"));
  CHECK_FALSE(gate.admits("a/file"));
  CHECK_FALSE(gate.admits("a/folder/secret"));
  // The folder itself may be reached by a link.
  fs::create_symlink("a", "b");
  CHECK(gate_of("b/s.yaml").admits("a/x"));
  CHECK(gate_of("a/s.yaml").admits("b/x"));
}

TEST_CASE("a marker makes the folder above the root, unless others could have put it there") {
  const Place place;
  place.write("p/q/s.yaml");
  CHECK_FALSE(gate_of("p/q/s.yaml").admits("p/x"));
  place.write("p/.parallax-root");
  CHECK(gate_of("p/q/s.yaml").admits("p/x"));
  CHECK_FALSE(gate_of("p/q/s.yaml").admits("x"));
  SUBCASE("the nearest one counts") {
    place.write(".parallax-root");
    CHECK_FALSE(gate_of("p/q/s.yaml").admits("x"));
  }
  SUBCASE("not where everybody can write") {
    REQUIRE(::chmod("p", 01777) == 0);
    CHECK_FALSE(gate_of("p/q/s.yaml").admits("p/x"));
  }
  SUBCASE("a folder or a link of this name is no marker") {
    fs::remove("p/.parallax-root");
    SUBCASE("folder") { fs::create_directory("p/.parallax-root"); }
    SUBCASE("link") { fs::create_symlink("q/s.yaml", "p/.parallax-root"); }
    CHECK_FALSE(gate_of("p/q/s.yaml").admits("p/x"));
  }
}

TEST_CASE("a home folder is no root as a whole, whatever it holds") {
  const Place place;
  place.write("home/s.yaml");
  place.write("home/.parallax-root");
  place.write("home/sub/s.yaml");
  ::setenv("HOME", (place.path() / "home").c_str(), 1);
  const auto gate = gate_of("home/s.yaml");
  CHECK(gate.admits("home/x.e"));
  CHECK_FALSE(gate.admits("home/.netrc"));
  CHECK_FALSE(gate.admits("home/.ssh/id"));
  CHECK_FALSE(gate.admits("home/sub/x"));
  CHECK(gate_of("home/sub/s.yaml").admits("home/sub/x"));
  CHECK_FALSE(gate_of("home/sub/s.yaml").admits("home/x"));

  PathGate current;
  current.admit_current_folder();
  CHECK(current.admits("home/sub/x"));
  fs::current_path("home");
  PathGate at_home;
  at_home.admit_current_folder();
  CHECK_FALSE(at_home.admits("x"));
  fs::current_path("/");
  PathGate at_root;
  at_root.admit_current_folder();
  CHECK_FALSE(at_root.admits("/etc/passwd"));
  CHECK_FALSE(gate_of("/s.yaml").admits("/etc/passwd"));
}

TEST_CASE("no output replaces a file that was read, by whatever name") {
  const Place place;
  place.write("in.e");
  place.write("other.e");
  fs::create_symlink("in.e", "link.e");
  fs::create_hard_link("in.e", "hard.e");
  SourceFiles files;
  DiagnosticSink sink;
  REQUIRE(load_text("in.e", files, sink).has_value());
  for (const fs::path& name : {fs::path("in.e"), fs::path("./in.e"), place.path() / "in.e",
                               fs::path("link.e"), fs::path("hard.e")}) {
    DiagnosticSink refused;
    CHECK_FALSE(write_output(name, "y", files, refused).has_value());
    CHECK(refused.sorted().front().code == codes::kOutputIsInput);
    CHECK(refused.exit_code() == 2);
  }
  CHECK(write_output("other.e", "y", files, sink).has_value());
  CHECK(write_output("new.e", "y", files, sink).has_value());
  CHECK(*read_file("in.e", sink) == "x");
}

TEST_CASE("what stands beside an output is left alone, also where it has a temporary name") {
  const Place place;
  place.write("out.tmp");
  place.write("victim");
  // The name that this process would take first.
  const auto first = "out." + std::to_string(::getpid()) + "-0.tmp";
  fs::create_symlink("victim", first);
  DiagnosticSink sink;
  CHECK(write_file_atomically("out", "text", sink).has_value());
  CHECK(*read_file("out", sink) == "text");
  CHECK(*read_file("victim", sink) == "x");
  CHECK(*read_file("out.tmp", sink) == "x");
}

TEST_CASE("a file of a folder must really lie there") {
  const Place place;
  place.write("r/journal");
  place.write("secret");
  fs::create_symlink("../secret", "r/report");
  DiagnosticSink sink;
  CHECK(read_file_of("r", "journal", sink).has_value());
  CHECK_FALSE(read_file_of("r", "report", sink).has_value());
  CHECK(sink.sorted().front().code == codes::kLoadOutside);
}

}  // namespace
}  // namespace parallax::base
