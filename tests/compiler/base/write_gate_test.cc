#include "compiler/base/write_gate.h"

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>

#include "compiler/base/codes/files.h"
#include "tests/support/temporary_folder.h"

namespace parallax::base {
namespace {

namespace fs = std::filesystem;

void make(const fs::path& file) {
  fs::create_directories(file.parent_path());
  std::ofstream(file) << "x";
}

/// Two copies of a project beside each other, and the current folder in the second one.
class Copies {
 public:
  Copies() : before_(fs::current_path()) {
    for (const auto* copy : {"first", "second"}) make(top() / copy / "models/m.e");
    fs::current_path(top() / "second/models");
  }
  ~Copies() { fs::current_path(before_); }
  Copies(const Copies&) = delete;
  Copies& operator=(const Copies&) = delete;
  fs::path top() const { return folder_.path(); }

 private:
  test::TemporaryFolder folder_;
  fs::path before_;
};

TEST_CASE("what a file names is changed below the current folder only") {
  const Copies copies;
  make(copies.top() / "second/plan.lisp");
  const WriteGate gate(false);
  CHECK(gate.admits("m.e"));
  CHECK(gate.admits(copies.top() / "second/models/new/x.e"));
  CHECK_FALSE(gate.admits(copies.top() / "first/models/m.e"));
  CHECK_FALSE(gate.admits("../plan.lisp"));
  CHECK(WriteGate(true).admits(copies.top() / "first/models/m.e"));
  fs::create_symlink("../../first/models/m.e", "link.e");
  CHECK_FALSE(gate.admits("link.e"));
  DiagnosticSink sink;
  CHECK_FALSE(gate.check("link.e", sink));
  CHECK(sink.sorted().front().code == codes::kWriteOutside);
}

TEST_CASE("the tree of the current folder begins at a repository or a marked folder") {
  const Copies copies;
  make(copies.top() / "second/plan.lisp");
  SUBCASE("a repository") { fs::create_directory(copies.top() / "second/.git"); }
  SUBCASE("a work tree of one") { make(copies.top() / "second/.git"); }
  SUBCASE("a marked folder") { make(copies.top() / "second/.parallax-root"); }
  const WriteGate gate(false);
  CHECK(gate.admits("../plan.lisp"));
  CHECK_FALSE(gate.admits(copies.top() / "first/models/m.e"));
}

TEST_CASE("a file that the user named admits what lies beside it") {
  const Copies copies;
  WriteGate gate(false);
  gate.admit_beside("../../first/models/m.e");
  CHECK(gate.admits(copies.top() / "first/models/other.e"));
  CHECK_FALSE(gate.admits(copies.top() / "first/other.e"));
}

TEST_CASE("an output that nobody named does not follow links out of its folder") {
  const Copies copies;
  const auto refused = [](const fs::path& path) {
    DiagnosticSink sink;
    if (check_unnamed_output(path, ".", "--out", sink)) return false;
    CHECK(sink.sorted().front().code == codes::kOutputLeadsOut);
    return true;
  };
  CHECK_FALSE(refused("out/run"));
  fs::create_directories("out/run");
  fs::create_symlink("run", "out/again");  // stays within
  CHECK_FALSE(refused("out/run"));
  CHECK_FALSE(refused("out"));
  SUBCASE("the folder") {
    fs::remove_all("out");
    fs::create_symlink("../../first", "out");
    CHECK(refused("out"));
    CHECK(refused("out/run"));
  }
  SUBCASE("a link to nothing") {
    fs::create_symlink("../../first/none", "out/new");
    CHECK(refused("out/new"));
  }
  SUBCASE("below it") {
    fs::create_symlink("../../../../first", "out/run/cache");
    CHECK(refused("out"));
    CHECK(refused("out/run"));
    CHECK_FALSE(refused("out/again2"));
  }
}

}  // namespace
}  // namespace parallax::base
