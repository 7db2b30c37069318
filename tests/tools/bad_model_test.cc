// Hostile model files: one located message each, exit code 3 (or 2), no crash.

#include <doctest/doctest.h>
#include <sys/stat.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/tools/cli_fixture.h"

namespace parallax::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// `parallax check` of the file, within a limit on memory so that a bloat shows.
ProcessResult check(const CliFixture& cli, const std::string& file) {
  return cli.parallax({"check", file, "--json", "--no-lint", "--memory-limit", "1024"});
}

/// The one diagnostic that the check of `file` prints.
json only_diagnostic(const CliFixture& cli, const std::string& file, int code = 3) {
  const auto result = check(cli, file);
  CAPTURE(result.err.substr(0, 2000));
  CHECK(result.code == code);
  CHECK(result.err.size() < 20'000);
  REQUIRE(json::accept(result.out));
  const auto document = json::parse(result.out);
  CHECK(document["status"] == "error");
  REQUIRE(document["diagnostics"].size() == 1);
  return document["diagnostics"][0];
}

void check_located(const json& diagnostic, const std::string& code, const std::string& file,
                   int line) {
  CAPTURE(diagnostic.dump().substr(0, 2000));
  CHECK(diagnostic["code"] == code);
  CHECK(diagnostic["path"] == file);
  CHECK(diagnostic["line"] == line);
}

std::string repeated(const std::string& piece, std::size_t count) {
  std::string out;
  out.reserve(piece.size() * count);
  for (std::size_t i = 0; i < count; ++i) out += piece;
  return out;
}

const std::string kWorld = "range time 0 1\npredicate P()\n";

TEST_CASE("formulas that are too deep, too long or too big") {
  const CliFixture cli;
  SUBCASE("100,000 brackets") {
    cli.write("bad.e", kWorld + repeated("(", 100'000) + "P()" + repeated(")", 100'000) + ".\n");
    check_located(only_diagnostic(cli, "bad.e"), "E1009", "bad.e", 3);
  }
  SUBCASE("100,000 open brackets") {
    cli.write("bad.e", kWorld + repeated("(", 100'000) + "P().\n");
    check_located(only_diagnostic(cli, "bad.e"), "E1009", "bad.e", 3);
  }
  SUBCASE("100,000 negations") {
    cli.write("bad.e", kWorld + repeated("!", 100'000) + "P().\n");
    check_located(only_diagnostic(cli, "bad.e"), "E1009", "bad.e", 3);
  }
  SUBCASE("10 MB on one line") {
    cli.write("bad.e", kWorld + "P()" + repeated(" & P()", 1'750'000) + ".\n");
    check_located(only_diagnostic(cli, "bad.e"), "E2114", "bad.e", 3);
  }
  SUBCASE("an identifier of 1 MB") {
    cli.write("bad.e", kWorld + "A" + repeated("b", 1'000'000) + "().\n");
    check_located(only_diagnostic(cli, "bad.e"), "E2101", "bad.e", 3);
  }
}

TEST_CASE("bytes that are no text") {
  const CliFixture cli;
  SUBCASE("NUL") {
    cli.write("bad.e", kWorld + std::string("P\0().\n", 6));
    check_located(only_diagnostic(cli, "bad.e"), "E0006", "bad.e", 3);
  }
  SUBCASE("invalid UTF-8, even in a comment") {
    cli.write("bad.e", kWorld + "; \xC3\x28\n");
    check_located(only_diagnostic(cli, "bad.e"), "E0006", "bad.e", 3);
  }
  SUBCASE("an overlong form") {
    cli.write("bad.e", kWorld + "; \xC0\xAF\n");
    check_located(only_diagnostic(cli, "bad.e"), "E0006", "bad.e", 3);
  }
  SUBCASE("an overlong form of three bytes, a surrogate, a code point that is too large") {
    for (const auto* bytes : {"\xE0\x80\xAF", "\xED\xA0\x80", "\xF4\x90\x80\x80"}) {
      cli.write("bad.e", kWorld + "; " + bytes + "\n");
      check_located(only_diagnostic(cli, "bad.e"), "E0006", "bad.e", 3);
    }
  }
  SUBCASE("bidirectional controls are shown, not obeyed") {
    cli.write("bad.e", kWorld + "P\xE2\x80\xAE().\n");
    const auto diagnostic = only_diagnostic(cli, "bad.e");
    check_located(diagnostic, "E1001", "bad.e", 3);
    const auto text = cli.parallax({"check", "bad.e"}).err;
    CHECK(text.find("\xE2\x80\xAE") == std::string::npos);
    CHECK(text.find("\\u202e") != std::string::npos);
  }
}

TEST_CASE("a byte order mark and carriage returns are read") {
  const CliFixture cli;
  cli.write("marked.e", "\xEF\xBB\xBFrange time 0 1\r\npredicate P()\r\nP()\r\n&P().\r\n");
  const auto result = check(cli, "marked.e");
  CAPTURE(result.out);
  CHECK(result.code == 0);
  cli.write("marked.e", "\xEF\xBB\xBFrange time 0 1\r\nP().\r\n");
  check_located(only_diagnostic(cli, "marked.e"), "E2101", "marked.e", 2);
}

TEST_CASE("a file that loads itself, or a ring of files, is read once") {
  const CliFixture cli;
  cli.write("self.e", "load self.e\n" + kWorld + "P().\n");
  CHECK(check(cli, "self.e").code == 0);
  cli.write("a.e", "load b.e\n" + kWorld);
  cli.write("b.e", "load c.e\n");
  cli.write("c.e", "load a.e\nP().\n");
  CHECK(check(cli, "a.e").code == 0);
}

TEST_CASE("load reads files of the project and nothing else") {
  const CliFixture cli;
  SUBCASE("a missing file") {
    cli.write("bad.e", kWorld + "load nowhere.e\n");
    check_located(only_diagnostic(cli, "bad.e"), "E1014", "bad.e", 3);
  }
  SUBCASE("a folder") {
    fs::create_directory(cli.folder() / "folder.e");
    cli.write("bad.e", kWorld + "load folder.e\n");
    check_located(only_diagnostic(cli, "bad.e"), "E1015", "bad.e", 3);
  }
  SUBCASE("a FIFO that nobody writes to") {
    REQUIRE(::mkfifo((cli.folder() / "fifo.e").c_str(), 0600) == 0);
    cli.write("bad.e", kWorld + "load fifo.e\n");
    check_located(only_diagnostic(cli, "bad.e"), "E1015", "bad.e", 3);
  }
  SUBCASE("a device") {
    cli.write("bad.e", kWorld + "load /dev/zero\n");
    const auto diagnostic = only_diagnostic(cli, "bad.e");
    CHECK((diagnostic["code"] == "E1015" || diagnostic["code"] == "E1016"));
    CHECK(diagnostic["line"] == 3);
  }
  SUBCASE("a path that climbs out, unless that is permitted") {
    fs::create_directory(cli.folder() / "inner");
    cli.write("inner/bad.e", kWorld + "load ../outside.e\n");
    cli.write("outside.e", "P().\n");
    ProcessOptions options;
    options.folder = (cli.folder() / "inner").string();
    const auto refused = cli.parallax({"check", "bad.e"}, options);
    CHECK(refused.code == 3);
    CHECK(refused.err.find("bad.e:3:") == 0);
    CHECK(refused.err.find("E1016") != std::string::npos);
    CHECK(cli.parallax({"check", "bad.e", "--allow-outside"}, options).code == 0);
  }
  SUBCASE("a link that leads out") {
    fs::create_symlink("/etc/passwd", cli.folder() / "link.e");
    cli.write("bad.e", kWorld + "load link.e\n");
    check_located(only_diagnostic(cli, "bad.e"), "E1016", "bad.e", 3);
  }
  SUBCASE("a link that leads nowhere or to itself") {
    fs::create_symlink("loop.e", cli.folder() / "loop.e");
    cli.write("bad.e", kWorld + "load loop.e\n");
    CHECK(only_diagnostic(cli, "bad.e")["line"] == 3);
  }
}

TEST_CASE("a model that is no file is a usage error") {
  const CliFixture cli;
  fs::create_directory(cli.folder() / "folder.e");
  REQUIRE(::mkfifo((cli.folder() / "fifo.e").c_str(), 0600) == 0);
  for (const auto* name : {"folder.e", "fifo.e", "/dev/zero", "nowhere.e"}) {
    CAPTURE(name);
    const auto diagnostic = only_diagnostic(cli, name, 2);
    CHECK(diagnostic["path"] == name);
  }
}

}  // namespace
}  // namespace parallax::test
