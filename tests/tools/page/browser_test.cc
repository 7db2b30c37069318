// Pages in headless Chromium: no message on the console, no request to a network, use with keyboard
// and mouse, contrast; with axe-core where `tools/setup --browser` got it.

#include "tests/tools/page/browser.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "harness/recording/recording_file.h"
#include "tests/tools/cli_fixture.h"
#include "tests/tools/page/proof_file.h"
#include "tools/page/csp_hash.h"

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

/// The page with scripts of the test, which its policy allows.
std::string with_scripts(std::string page, const std::vector<std::string>& scripts) {
  const std::string policy = "script-src '";
  for (const auto& script : scripts) {
    page.insert(page.find(policy) + policy.size() - 1, "'" + tools::csp_hash(script) + "' ");
    page.insert(page.rfind("</body>"), "<script>" + script + "</script>");
  }
  return page;
}

/// Mark of requests by a page from a file, in a log of the network.
constexpr const char* kAskedByPage = "\"initiator\":\"null\"";

ProcessResult browse(const CliFixture& cli, const std::string& name, bool dark,
                     bool with_gl = false) {
  std::vector<std::string> words = {
      browser(),
      "--headless",
      "--no-sandbox",
      "--disable-dev-shm-usage",
      "--no-first-run",
      "--disable-background-networking",
      "--disable-component-update",
      "--disable-sync",
      "--user-data-dir=" + (cli.folder() / "profile").string(),
      "--enable-logging=stderr",
      "--log-net-log=" + (cli.folder() / "net.json").string(),
      "--window-size=1280,900",
      std::string("--blink-settings=preferredColorScheme=") + (dark ? "0" : "1"),
      "--virtual-time-budget=20000"};
  // Drawn by the processor, as there may be nothing else.
  const std::vector<std::string> drawing =
      with_gl ? std::vector<std::string>{"--use-gl=angle", "--use-angle=swiftshader",
                                         "--enable-unsafe-swiftshader"}
              : std::vector<std::string>{"--disable-gpu", "--disable-3d-apis"};
  words.insert(words.end(), drawing.begin(), drawing.end());
  words.insert(words.end(), {"--dump-dom", "file://" + (cli.folder() / name).string()});
  return run_process(words);
}

/// Options of `probe`.
struct ProbeOptions {
  bool dark = false, with_axe = true, with_gl = false;
  int width = 0;  // of a frame that the page is put into; windows have a least width
};
/// Findings of the probe in the page. Checks that the page sent no request to a network and wrote
/// nothing to the console.
Json probe(const CliFixture& cli, const std::string& name, const ProbeOptions& options = {}) {
  CAPTURE(name);
  CAPTURE(options.dark);
  CAPTURE(options.width);
  const auto axe =
      content_of(fs::path(PARALLAX_SOURCE_DIR) / "build/browser/node_modules/axe-core/axe.min.js");
  const auto probing =
      content_of(fs::path(PARALLAX_SOURCE_DIR) / "tests/tools/page/browser_probe.js");
  REQUIRE_FALSE(probing.empty());
  std::vector<std::string> scripts;
  if (options.with_axe && !axe.empty()) scripts.push_back(axe);
  scripts.push_back(probing);
  cli.write("probed.html", with_scripts(cli.read(name), scripts));
  if (options.width > 0) {
    cli.write("frame.html",
              "<!DOCTYPE html><body><iframe src=\"probed.html\" height=\"900\" width=\"" +
                  std::to_string(options.width) +
                  "\"></iframe><script>addEventListener('message', (event) => { "
                  "document.body.dataset.probe = event.data; });</script>");
  }
  const auto* shown = options.width > 0 ? "frame.html" : "probed.html";
  const auto result = browse(cli, shown, options.dark, options.with_gl);
  CHECK(result.code == 0);
  std::istringstream lines(result.err);
  for (std::string line; std::getline(lines, line);) {
    if (line.find("CONSOLE") != std::string::npos) FAIL_CHECK(line);
  }
  const auto net = cli.read("net.json");
  CHECK_FALSE(net.empty());
  // Requests that the browser itself makes have no initiator.
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
  if (!has_browser()) return;
  const CliFixture cli;
  cli.write("asks.html",
            "<!DOCTYPE html><img "
            "src=\"http://127.0.0.1:9/x.png\"><script>console.error('told')</script>");
  const auto result = browse(cli, "asks.html", false);
  CHECK(cli.read("net.json").find(kAskedByPage) != std::string::npos);
  CHECK(result.err.find("CONSOLE") != std::string::npos);
}

TEST_CASE("a page works in a browser, by light and by night") {
  if (!has_browser()) return;
  const CliFixture cli;
  REQUIRE(cli.parallax({"run", "edge.yaml", "--execution", "closed-loop", "--keep-going",
                        "--max-runs", "30", "--out", "loop"})
              .code <= 4);
  REQUIRE(cli.parallax({"run", "edge.yaml", "--out", "edge"}).code == 1);
  cli.write("edge/one.proof.json", edge_proof(cli, "edge").dump());
  REQUIRE(cli.parallax({"report", "loop", "-o", "loop.html"}).code == 0);
  REQUIRE(cli.parallax({"report", "edge", "-o", "edge.html", "--explain"}).code == 0);
  REQUIRE(cli.parallax({"report", "edge", "loop", "-o", "both.html"}).code == 0);
  for (const bool dark : {false, true}) {
    const auto loop = probe(cli, "loop.html", {.dark = dark});
    CHECK(loop["rows"] == 30);
    CHECK(loop["discrepancies"] > 2);
    CHECK(loop["says"].get<std::string>().find("discrepancy") != std::string::npos);
    const auto edge = probe(cli, "edge.html", {.dark = dark});
    CHECK(edge["rows"] == 1);
    CHECK(edge["focusable"] > 10);
  }
  probe(cli, "both.html");
  // On a telephone: nothing is cut; parts wider than the window can be moved in it.
  for (const auto* name : {"loop.html", "edge.html", "both.html"}) {
    probe(cli, name, {.width = 360});
  }
  REQUIRE(cli.parallax({"draw", "edge"}).code == 0);
  REQUIRE(
      cli.parallax({"rates", "wrong_model.yaml", "--runs", "40", "--plot", "rates.html"}).code ==
      0);
  for (const bool dark : {false, true}) {
    probe(cli, "edge/pictures/index.html", {.dark = dark});
    probe(cli, "rates.html", {.dark = dark});
  }
}

/// Every text in it behind a hostile one.
void make_hostile(Json& value, const std::string& with) {
  if (value.is_string()) value = with + value.get<std::string>();
  for (auto& part : value.is_structured() ? value : Json::array()) make_hostile(part, with);
}

const std::string kHostile =
    "<script>window.hostile = 1</script></style><img src=x onerror='window.hostile = 2'>\"' "
    "\xE2\x80\xAE"
    "\xD9\x85";

/// A run folder as a stranger may have left it: names that are markup, that turn the direction of
/// writing, one of a megabyte, and very many simulations.
void write_hostile_folder(const CliFixture& cli, const std::string& from, int samples) {
  fs::create_directories(cli.folder() / "hostile");
  std::istringstream lines(cli.read(from + "/journal.ndjson"));
  std::string out, line;
  Json sample;
  while (std::getline(lines, line)) {
    auto entry = Json::parse(line);
    if (entry.contains("journal")) {
      entry["scenario"] = kHostile + ".yaml";
      entry["simulator"]["name"] = kHostile + std::string(1 << 20, 'n');
    } else if (entry.contains("events")) {
      make_hostile(entry["holds"], kHostile);
      for (auto& event : entry["events"]) {
        event["event"] = kHostile + event["event"].get<std::string>();
        event["source"] = kHostile;
      }
    } else if (entry["phase"] == "certify") {
      sample = entry;
      continue;
    } else {
      continue;
    }
    out += entry.dump() + '\n';
  }
  REQUIRE_FALSE(sample.is_null());
  sample["initial"][kHostile + ".mass"] = 1.5;
  sample["initial"][kHostile + ".x"] = 0.5;
  for (int i = 1; i <= samples; ++i) {
    sample["sample"] = i;
    sample["initial"][kHostile + ".mass"] = 0.001 * i;
    out += sample.dump() + '\n';
  }
  cli.write("hostile/journal.ndjson", out);
  auto report = Json::parse(cli.read(from + "/report.json"));
  for (auto& trace : report["traces"]) {
    for (const auto* part : {"events", "sources", "claim", "caveats"}) {
      make_hostile(trace[part], kHostile);
    }
    trace["simulations"] = samples;
    trace["clean"] = samples - 1;
  }
  for (auto& found : report["discrepancies"]) {
    for (const auto* part : {"cause", "first", "fluents", "words", "start"}) {
      make_hostile(found[part], kHostile);
    }
    found["start"][kHostile + std::string(1 << 20, 'v')] = kHostile;
  }
  report["scenario"] = kHostile;
  report["verdict"] = "discrepancy";
  cli.write("hostile/report.json", report.dump());
}

TEST_CASE("recorded motion is played, and drawn where the recording has it") {
  if (!has_browser()) return;
  const CliFixture cli;
  REQUIRE(cli.parallax({"run", "edge.yaml", "--execution", "closed-loop", "--keep-going",
                        "--max-runs", "8", "--out", "loop"})
              .code <= 4);
  REQUIRE(cli.parallax({"report", "loop", "-o", "loop.html"}).code == 0);
  CHECK(cli.read("loop.html").size() < 4'000'000);
  // Without WebGL a sentence says so.
  const auto flat = probe(cli, "loop.html");
  CHECK(flat["needs"].get<std::string>().find("WebGL") != std::string::npos);
  for (const bool dark : {false, true}) {
    const auto seen = probe(cli, "loop.html", {.dark = dark, .with_axe = dark, .with_gl = true});
    REQUIRE(seen.contains("motion"));
    CHECK(seen["needs"] == "");
    const auto& motion = seen["motion"];
    std::set<std::int64_t> pictures;
    for (const auto& stats : motion["stats"]) {
      CHECK(stats["spread"] > 10.0);
      pictures.insert(stats["mark"].get<std::int64_t>());
    }
    CHECK(pictures.size() == 3);
    CHECK(motion["shown"] == motion["row"]);
    // The discrepancy beside a clean one.
    REQUIRE(motion["names"].size() == 2);
    const auto id = harness::recording_id(motion["names"][0].get<std::string>() + ".rec");
    REQUIRE(id);
    std::string why;
    const auto recording =
        harness::find_recording(cli.folder() / "loop", id->first, id->second, why);
    REQUIRE_MESSAGE(recording, why);
    REQUIRE(motion["poses"].size() == recording->events.size());
    for (std::size_t i = 0; i < recording->events.size(); ++i) {
      CAPTURE(i);
      const auto& drawn = motion["poses"][i]["places"];
      std::map<std::string, harness::Pose> expected;
      for (harness::Playback at(*recording);
           at.next() && at.time_s() <= recording->events[i].end_s + 1e-6;) {
        for (std::size_t body = 0; body < recording->scene.bodies.size(); ++body) {
          expected[recording->scene.bodies[body].name] = at.pose_of(body);
        }
      }
      CHECK(drawn.size() > 1);
      for (const auto& [name, place] : drawn.items()) {
        CAPTURE(name);
        for (std::size_t k = 0; k < 3; ++k) {
          CHECK(place[k].get<double>() == doctest::Approx(expected.at(name).p[k]).epsilon(0.002));
        }
      }
      // And where the log says that it is.
      const auto& seen_x = recording->observations[i + 1].find("box.x");
      REQUIRE(seen_x != recording->observations[i + 1].end());
      CHECK(std::abs(drawn["box"][0].get<double>() - std::get<double>(seen_x->second)) < 0.003);
    }
  }
}

TEST_CASE("a hostile run folder is inert on the page, with ten thousand simulations") {
  if (!has_browser()) return;
  const CliFixture cli;
  REQUIRE(cli.parallax({"run", "edge.yaml", "--out", "edge"}).code == 1);
  write_hostile_folder(cli, "edge", 10'000);
  const auto made = cli.parallax({"report", "hostile", "-o", "hostile.html"});
  CHECK_MESSAGE(made.code == 0, made.err);
  CHECK(cli.read("hostile.html").size() < 24'000'000);
  const auto seen = probe(cli, "hostile.html", {.with_axe = false});
  CHECK(seen["rows"] == 10'000);
  CHECK(seen["canvases"] > 0);
  CHECK(seen["hostile"] == 0);
  CHECK(seen["images"] == 0);
  CHECK(seen["turned"] == 0);
}

}  // namespace
}  // namespace parallax::test
