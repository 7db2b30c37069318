// A file that looks like a case is a case or an error, never passed over.

#include "tools/suite/suite_case.h"

#include <doctest/doctest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "compiler/base/codes/campaigns.h"
#include "compiler/base/codes/texts.h"

namespace parallax::tools {
namespace {

namespace fs = std::filesystem;

class Folder {
 public:
  Folder() {
    auto pattern = (fs::temp_directory_path() / "parallax-XXXXXX").string();
    REQUIRE(::mkdtemp(pattern.data()) != nullptr);
    path_ = pattern;
    ::chmod(path_.c_str(), 0755);
    write("s/lamp.e", "range time 0 1\n");
    write("s/good.yaml", "cases: [{id: one, model: lamp.e, expect: {traces: 1}}]\n");
  }
  ~Folder() {
    fs::permissions(path_ / "s", fs::perms::owner_all, fs::perm_options::add, ignored_);
    fs::remove_all(path_, ignored_);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  void write(const fs::path& name, const std::string& text) const {
    fs::create_directories((path_ / name).parent_path());
    std::ofstream(path_ / name, std::ios::binary) << text;
  }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
  std::error_code ignored_;
};

struct Found {
  std::vector<SuiteCase> cases;
  std::vector<base::Diagnostic> reports;
  int code = 0;
};

Found find_in(const fs::path& path, bool allow_outside = false) {
  base::SourceFiles files;
  base::DiagnosticSink sink;
  Found out;
  auto cases = find_cases({path.string()}, allow_outside, files, sink);
  CHECK(cases.has_value() == !sink.has_errors());
  if (cases) out.cases = *std::move(cases);
  out.reports = sink.sorted();
  out.code = sink.exit_code();
  return out;
}

void check_one_error(const Found& found, base::DiagnosticCode code, const fs::path& place) {
  REQUIRE(found.reports.size() == 1);
  CHECK(found.reports.front().code == code);
  CHECK(found.reports.front().subject == place.string());
  CHECK(found.code == 3);
}

TEST_CASE("a readable folder gives its cases") {
  const Folder folder;
  folder.write("s/deep/er/more.yml", "cases: [{id: two, model: m.e, expect: {traces: 1}}]\n");
  folder.write("s/deep/er/m.e", "");
  folder.write("s/other.yaml", "just: words\n");
  folder.write("s/fragment.yaml", "horizon: 3\n");
  const auto found = find_in(folder.path() / "s");
  CHECK(found.code == 0);
  CHECK(found.cases.size() == 2);
}

TEST_CASE("a case is found however its file is written and called") {
  const Folder folder;
  constexpr const char* kList = "[{id: two, model: lamp.e, expect: {traces: 1}}]";
  const auto list = std::string(kList);
  folder.write("s/quoted.yaml", "\"cases\": " + list + '\n');
  folder.write("s/flow.yaml", "{cases: " + list + "}\n");
  folder.write("s/mark.yaml",
               "\xEF\xBB\xBF"
               "cases: " +
                   list + '\n');
  folder.write("s/start.yml", "%YAML 1.2\n---\ncases: " + list + '\n');
  folder.write("s/shout.YAML", "cases: " + list + '\n');
  folder.write("s/returns.yaml", "defaults: {}\r\ncases: " + list + "\r\n");
  folder.write("s/by_include.yaml", "include: good.yaml\n");
  folder.write("s/expects.yaml", "{\"expect\": {verdict: discrepancy}}\n");
  const auto found = find_in(folder.path() / "s");
  CHECK(found.code == 0);
  CHECK(found.cases.size() == 9);
}

TEST_CASE("a YAML file that cannot be read is an error at its place") {
  const Folder folder;
  const auto bad = folder.path() / "s" / "bad.yaml";
  SUBCASE("a link that leads nowhere") { fs::create_symlink("nowhere.yaml", bad); }
  SUBCASE("a link to itself") { fs::create_symlink("bad.yaml", bad); }
  SUBCASE("a FIFO") { REQUIRE(::mkfifo(bad.c_str(), 0600) == 0); }
  SUBCASE("a scenario that is too large") {
    folder.write("s/bad.yaml", "expect: {verdict: discrepancy}\n#" + std::string(1 << 20, 'x'));
  }
  SUBCASE("UTF-16") {
    std::string text = "\xFF\xFE";
    for (const char c : std::string("cases: [{id: x, model: lamp.e, expect: {traces: 9}}]\n")) {
      text += c;
      text += '\0';
    }
    folder.write("s/bad.yaml", text);
  }
  SUBCASE("no UTF-8") {
    folder.write("s/bad.yaml",
                 "title: Stra\xDF"
                 "e\n");
  }
  SUBCASE("a large one that a parser may find cases in") {
    folder.write("s/bad.yaml", "{\"cases\": []}\n#" + std::string(1 << 20, 'x'));
  }
  SUBCASE("a manifest that is too large") {
    folder.write("s/bad.yaml", "cases: []\n#" + std::string(1 << 20, 'x'));
  }
  check_one_error(find_in(folder.path() / "s"), codes::kCaseUnreadable, bad);
}

TEST_CASE("a large file that is no case is none") {
  const Folder folder;
  folder.write("s/data.yaml", "points: " + std::string(2 << 20, '1') + "\n");
  CHECK(find_in(folder.path() / "s").cases.size() == 1);
}

TEST_CASE("without permission a file and a folder are errors at their place") {
  const Folder folder;
  const auto& top = folder.path();
  folder.write("s/sub/hidden.yaml", "cases: []\n");
  const auto look = [&] {
    // Root may read everything.
    const bool is_root = ::geteuid() == 0;
    if (is_root) REQUIRE(::seteuid(65534) == 0);
    auto found = find_in(top / "s");
    if (is_root) REQUIRE(::seteuid(0) == 0);
    return found;
  };
  SUBCASE("file") {
    fs::remove_all(top / "s/sub");
    folder.write("s/bad.yaml", "cases: []\n");
    fs::permissions(top / "s/bad.yaml", fs::perms::none);
    check_one_error(look(), codes::kCaseUnreadable, top / "s/bad.yaml");
  }
  SUBCASE("folder") {
    fs::permissions(top / "s/sub", fs::perms::none);
    check_one_error(look(), codes::kCaseUnreadable, top / "s/sub");
    fs::permissions(top / "s/sub", fs::perms::owner_all);
  }
}

TEST_CASE("a link that leads out of the suite is refused, unless that is permitted") {
  const Folder folder;
  folder.write("outside.yaml", "name: not ours\n");
  const auto link = folder.path() / "s" / "link.yaml";
  fs::create_symlink("../outside.yaml", link);
  check_one_error(find_in(folder.path() / "s"), codes::kLoadOutside, link);
  CHECK(find_in(folder.path() / "s", true).code == 0);
  CHECK(find_in(link).code == 0);  // named on the command line
}

TEST_CASE("a broken variant of a case is a case, whose process says what is wrong") {
  const Folder folder;
  folder.write("s/base.yaml", "expect: {verdict: discrepancy}\n");
  folder.write("s/variant.yaml", "include: base.yaml\nhorizn: 3\n");
  folder.write("s/lost.yaml", "include: gone.yaml\n");
  folder.write("s/slip.yaml", "name: x\n  expect: {verdict: discrepancy}\n");
  folder.write("s/junk.yaml", "junk: [1\n");
  folder.write("s/typo.yaml", "model: [m.e]\nexpct: {verdict: discrepancy}\n");
  folder.write("s/world.yaml", "bodies: {}\n");
  folder.write("s/taken_back.yaml", "include: base.yaml\nexpect:\n");
  const auto found = find_in(folder.path() / "s");
  CHECK(found.code == 0);
  std::vector<std::string> names;
  for (const auto& one : found.cases) names.push_back(fs::path(one.file).filename().string());
  for (const auto* broken : {"variant.yaml", "slip.yaml", "junk.yaml", "typo.yaml"}) {
    CAPTURE(broken);
    CHECK(std::count(names.begin(), names.end(), broken) == 1);
    const auto is_this = [&](const SuiteCase& one) {
      return fs::path(one.file).filename() == broken;
    };
    CHECK(std::find_if(found.cases.begin(), found.cases.end(), is_this)->is_broken);
  }
  CHECK(std::count(names.begin(), names.end(), "world.yaml") == 0);
  CHECK(std::count(names.begin(), names.end(), "lost.yaml") == 1);
  CHECK(std::count(names.begin(), names.end(), "base.yaml") == 1);
}

TEST_CASE("a path that is not there is a usage error") {
  const Folder folder;
  CHECK(find_in(folder.path() / "nowhere").code == 2);
}

}  // namespace
}  // namespace parallax::tools
