// Pages in headless Chromium: no message on the console, no request to a network, what a person
// does with keyboard and mouse, contrast; with axe-core where `tools/setup --browser` got it.

#include <doctest/doctest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/tools/cli_fixture.h"
#include "tools/page/sha256.h"

namespace parallax::test {
namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

std::string content_of(const fs::path& path) {
  std::ifstream in(path);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

/// Empty where there is none.
std::string browser() {
  for (const auto* path : {"/usr/bin/chromium", "/usr/bin/chromium-browser"}) {
    if (fs::exists(path)) return path;
  }
  return {};
}

std::string decoded(const std::string& base64) {
  std::string out;
  unsigned bits = 0, count = 0;
  for (const char c : base64) {
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const auto value = digits.find(c);
    if (value == std::string::npos) break;
    bits = bits << 6U | static_cast<unsigned>(value);
    count += 6;
    if (count < 8) continue;
    count -= 8;
    out += static_cast<char>(bits >> count & 0xffU);
  }
  return out;
}

/// The page with scripts of the test, which its policy is told of.
std::string with_scripts(std::string page, const std::vector<std::string>& scripts) {
  const std::string policy = "script-src '";
  for (const auto& script : scripts) {
    page.insert(page.find(policy) + policy.size() - 1, "'" + tools::csp_hash(script) + "' ");
    page.insert(page.rfind("</body>"), "<script>" + script + "</script>");
  }
  return page;
}

/// In a log of the network, of requests that a page from a file makes.
constexpr const char* kAskedByPage = "\"initiator\":\"null\"";

ProcessResult browse(const CliFixture& cli, const std::string& name, bool dark) {
  return run_process(
      {browser(), "--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
       "--no-first-run", "--disable-background-networking", "--disable-component-update",
       "--disable-sync", "--user-data-dir=" + (cli.folder() / "profile").string(),
       "--enable-logging=stderr", "--log-net-log=" + (cli.folder() / "net.json").string(),
       "--window-size=1280,900",
       std::string("--blink-settings=preferredColorScheme=") + (dark ? "0" : "1"),
       "--virtual-time-budget=20000", "--dump-dom", "file://" + (cli.folder() / name).string()});
}

/// What the probe found in the page; checks that nothing was asked of a network or told on the
/// console.
Json probe(const CliFixture& cli, const std::string& name, bool dark) {
  CAPTURE(name);
  CAPTURE(dark);
  const auto axe =
      content_of(fs::path(PARALLAX_SOURCE_DIR) / "build/browser/node_modules/axe-core/axe.min.js");
  const auto probing =
      content_of(fs::path(PARALLAX_SOURCE_DIR) / "tests/tools/page/browser_probe.js");
  REQUIRE_FALSE(probing.empty());
  std::vector<std::string> scripts;
  if (!axe.empty()) scripts.push_back(axe);
  scripts.push_back(probing);
  cli.write("probed.html", with_scripts(cli.read(name), scripts));
  const auto result = browse(cli, "probed.html", dark);
  CHECK(result.code == 0);
  std::istringstream lines(result.err);
  for (std::string line; std::getline(lines, line);) {
    if (line.find("CONSOLE") != std::string::npos) FAIL_CHECK(line);
  }
  const auto net = cli.read("net.json");
  CHECK_FALSE(net.empty());
  // What the browser itself may look for has no initiator.
  CHECK(net.find(kAskedByPage) == std::string::npos);
  const std::string mark = "data-probe=\"";
  const auto at = result.out.find(mark);
  REQUIRE_MESSAGE(at != std::string::npos, result.out.substr(0, 500));
  const auto found = Json::parse(decoded(result.out.substr(at + mark.size())));
  for (const auto& fault : found["faults"]) FAIL_CHECK(fault.get<std::string>());
  CHECK(found["seen"]["contrast"] >= 3.0);
  return found["seen"];
}

TEST_CASE("a page that asks for something would be seen") {
  if (browser().empty()) return;
  const CliFixture cli;
  cli.write("asks.html",
            "<!DOCTYPE html><img "
            "src=\"http://127.0.0.1:9/x.png\"><script>console.error('told')</script>");
  const auto result = browse(cli, "asks.html", false);
  CHECK(cli.read("net.json").find(kAskedByPage) != std::string::npos);
  CHECK(result.err.find("CONSOLE") != std::string::npos);
}

TEST_CASE("a page works in a browser, by light and by night") {
  if (browser().empty()) {
    std::puts("SKIPPED: no Chromium; `tools/setup --browser` installs it");
    return;
  }
  const CliFixture cli;
  REQUIRE(cli.parallax({"run", "edge.yaml", "--execution", "closed-loop", "--keep-going",
                        "--max-runs", "30", "--out", "loop"})
              .code <= 4);
  REQUIRE(cli.parallax({"run", "edge.yaml", "--out", "edge"}).code == 1);
  REQUIRE(cli.parallax({"report", "loop", "-o", "loop.html"}).code == 0);
  REQUIRE(cli.parallax({"report", "edge", "-o", "edge.html", "--explain"}).code == 0);
  REQUIRE(cli.parallax({"report", "edge", "loop", "-o", "both.html"}).code == 0);
  for (const bool dark : {false, true}) {
    const auto loop = probe(cli, "loop.html", dark);
    CHECK(loop["rows"] == 30);
    CHECK(loop["discrepancies"] > 2);
    CHECK(loop["says"].get<std::string>().find("discrepancy") != std::string::npos);
    const auto edge = probe(cli, "edge.html", dark);
    CHECK(edge["rows"] == 1);
    CHECK(edge["focusable"] > 10);
  }
  probe(cli, "both.html", false);
}

}  // namespace
}  // namespace parallax::test
