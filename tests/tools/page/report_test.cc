// `parallax report` as users run it: whole folders, damaged ones, several.

#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "harness/confidence/rounding.h"
#include "tests/tools/cli_json.h"
#include "tests/tools/page/html_check.h"
#include "tests/tools/page/proof_file.h"
#include "tools/page/markup.h"

namespace parallax::test {
namespace {

using Json = nlohmann::json;

const std::string kSource = PARALLAX_SOURCE_DIR;

std::string read_whole(const std::filesystem::path& path) {
  std::ifstream in(path);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

/// Runs in the repository, so that names are as short as users see them.
ProcessResult at_source(const CliFixture& cli, std::vector<std::string> arguments) {
  ProcessOptions options;
  options.folder = kSource;
  return cli.parallax(std::move(arguments), options);
}

/// A run of a world that is a model: the same on every machine.
std::string exact_run(const CliFixture& cli, const std::string& name = "sticks") {
  auto folder = (cli.folder() / name).string();
  const auto run =
      at_source(cli, {"run", "scenarios/two_models/" + name + ".yaml", "--out", folder});
  REQUIRE_MESSAGE(run.code <= 1, run.err);
  return folder;
}

HtmlPage page_of(const CliFixture& cli, const std::string& name) {
  auto page = check_html(cli.read(name));
  for (const auto& fault : page.faults) FAIL_CHECK(fault);
  return page;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

TEST_CASE("a report with a value nested without end does not end the program") {
  const CliFixture cli;
  const auto folder = exact_run(cli);
  auto report = cli.read("sticks/report.json");
  const auto at = report.find("\"start\": {");
  REQUIRE(at != std::string::npos);
  report.insert(at + 10,
                "\"deep\":" + std::string(2'000'000, '[') + std::string(2'000'000, ']') + ",");
  cli.write("sticks/report.json", report);
  const auto made = at_source(cli, {"report", folder});
  CHECK(made.code <= 3);
}

TEST_CASE("the page counts lost simulations by reason, in its head and with each trace") {
  const CliFixture cli;
  const auto folder = exact_run(cli);
  auto report = Json::parse(cli.read("sticks/report.json"));
  auto& trace = report.at("traces").at(0);
  trace["lost"] = 3;
  trace["losses"] = {{{"reason", "of the solver"}, {"count", 2}, {"example", 4}},
                     {{"reason", "<b>it ended"}, {"count", 1}, {"example", 6}}};
  cli.write("sticks/report.json", report.dump());
  REQUIRE(at_source(cli, {"report", folder}).code == 0);
  const auto html = cli.read("sticks/report.html");
  const std::string counts = "of the solver (2), &lt;b&gt;it ended (1)";
  CHECK(html.find("<dt>Lost</dt><dd>" + counts + "</dd>") != std::string::npos);
  CHECK(html.find(", 3 lost</summary>") != std::string::npos);
  CHECK(html.find("Lost: " + counts + ".") != std::string::npos);
}

TEST_CASE("a page replaces an earlier page, and nothing else") {
  const CliFixture cli;
  const auto folder = exact_run(cli);
  cli.write("notes.txt", "mine");
  for (const auto& name : {std::string("notes.txt"), std::string("sticks/journal.ndjson")}) {
    CAPTURE(name);
    const auto before = cli.read(name);
    for (const std::string watch : {"", "--watch"}) {
      std::vector<std::string> words = {"report", folder, "-o", (cli.folder() / name).string()};
      if (!watch.empty()) words.push_back(watch);
      const auto refused = at_source(cli, words);
      CHECK(refused.code == 2);
      CHECK(refused.err.find("no page of this command") != std::string::npos);
      CHECK(cli.read(name) == before);
    }
  }
  const auto page = (cli.folder() / "page.html").string();
  CHECK(at_source(cli, {"report", folder, "-o", page}).code == 0);
  CHECK(at_source(cli, {"report", folder, "-o", page}).code == 0);
}

TEST_CASE("without scripts the page of a run says what the golden text says") {
  const CliFixture cli;
  const auto folder = exact_run(cli);
  const auto made = at_source(cli, {"report", folder});
  CHECK(made.code == 0);
  CHECK(made.out == folder + "/report.html\n");
  const auto text = replaced(page_of(cli, "sticks/report.html").text, folder, "RUN");
  const auto golden = kSource + "/tests/tools/page/sticks.txt";
  if (std::getenv("PARALLAX_UPDATE_GOLDEN") != nullptr) std::ofstream(golden) << text;
  CHECK(text == read_whole(golden));
  // The same bytes each time.
  const auto first = cli.read("sticks/report.html");
  CHECK(at_source(cli, {"report", folder}).code == 0);
  CHECK(cli.read("sticks/report.html") == first);
}

TEST_CASE("a run in a world of bodies has a map, and explain's rule once it was made") {
  const CliFixture cli;
  REQUIRE(cli.parallax({"run", "edge.yaml", "--out", "edge"}).code == 1);
  CHECK(cli.parallax({"report", "edge", "-o", "before.html"}).code == 0);
  const auto before = page_of(cli, "before.html");
  CHECK(before.ids.contains("map"));
  CHECK(before.text.find("parallax explain edge") != std::string::npos);
  CHECK(before.text.find("they part here") != std::string::npos);
  REQUIRE(cli.parallax({"explain", "edge"}).code == 1);
  const auto journal = cli.read("edge/journal.ndjson");
  CHECK(cli.parallax({"report", "edge", "-o", "after.html", "--repair"}).code == 0);
  const auto after = page_of(cli, "after.html");
  CHECK(after.ids.contains("starts"));
  CHECK(after.text.find("Simulations fail where box.x > 1.7") != std::string::npos);
  CHECK(after.text.find("made afterwards") != std::string::npos);
  CHECK(after.text.find("with half its step it happens in 5 of 5 runs") != std::string::npos);
  CHECK(after.text.find("Proposed repairs") != std::string::npos);
  const auto data = Json::parse(after.data);
  CHECK(data["samples"].size() > 20);
  CHECK(data["bodies"] == Json({"box", "robot"}));
  CHECK(cli.read("edge/journal.ndjson") == journal);
}

TEST_CASE("damaged and foreign folders give a page with a banner") {
  const CliFixture cli;
  const auto folder = exact_run(cli);
  const auto journal = cli.read("sticks/journal.ndjson"), report = cli.read("sticks/report.json");
  const auto banner_of = [&](const char* what) {
    CAPTURE(what);
    const auto made = at_source(cli, {"report", folder});
    CHECK(made.code == 0);
    CHECK_FALSE(made.err.empty());
    const auto page = page_of(cli, "sticks/report.html");
    CHECK_MESSAGE(page.text.find(what) != std::string::npos, page.text.substr(0, 1500));
    return page;
  };
  cli.write("sticks/report.json", report.substr(0, report.size() / 2));
  CHECK(banner_of("only half of one").ids.contains("samples"));
  std::filesystem::remove(cli.folder() / "sticks/report.json");
  CHECK(banner_of("There is no report.json yet").text.find("Not finished") != std::string::npos);
  cli.write("sticks/report.json", report);
  cli.write("sticks/journal.ndjson", journal.substr(0, journal.size() - 20));
  banner_of("last line is incomplete");
  cli.write("sticks/journal.ndjson", "{\"journal\":99}\n");
  CHECK(banner_of("The journal cannot be read").text.find("Open(top)") != std::string::npos);
  cli.write("sticks/journal.ndjson", "");
  banner_of("before its first line is complete");
  std::filesystem::remove(cli.folder() / "sticks/journal.ndjson");
  banner_of("The folder has no journal");
  // If the scenario has changed, none of its sources is quoted.
  cli.write("sticks/journal.ndjson",
            replaced(journal, "\"scenario_hash\":\"", "\"scenario_hash\":\"00"));
  const auto changed = banner_of("cannot be read any more as it was");
  CHECK_FALSE(changed.ids.contains("sources"));
  CHECK(changed.ids.contains("timeline"));
}

TEST_CASE("a folder that is none, and an output that would replace a run, are refused") {
  const CliFixture cli;
  const auto folder = exact_run(cli);
  const auto nothing = cli.parallax({"report", "nowhere"});
  CHECK(nothing.code == 2);
  CHECK(nothing.err.find("E7111") != std::string::npos);
  const auto over = at_source(cli, {"report", folder, "-o", folder + "/journal.ndjson"});
  CHECK(over.code == 2);
  CHECK(over.err.find("no page of this command") != std::string::npos);
  const auto document = json_of(cli, {"report", folder, "-o", "x.html"});
  CHECK(document["page"] == "x.html");
  CHECK(document["bytes"] == cli.read("x.html").size());
}

TEST_CASE("a page that is watched loads itself until the run is over") {
  const CliFixture cli;
  const auto folder = exact_run(cli);
  REQUIRE(at_source(cli, {"report", folder}).code == 0);
  const auto whole = cli.read("sticks/report.html"), report = cli.read("sticks/report.json");
  std::filesystem::remove(cli.folder() / "sticks/report.json");
  std::filesystem::remove(cli.folder() / "sticks/report.html");
  ProcessOptions options;
  options.folder = kSource;
  bool was_seen = false;
  options.signal_when = [&] {
    if (was_seen || !std::filesystem::exists(cli.folder() / "sticks/report.html")) return 0;
    const auto page = cli.read("sticks/report.html");
    was_seen = true;
    CHECK(page.find("http-equiv=\"refresh\"") != std::string::npos);
    CHECK(page.find("Not finished") != std::string::npos);
    cli.write("sticks/report.json", report);
    return 0;
  };
  const auto watched = cli.parallax({"report", folder, "--watch"}, options);
  CHECK(watched.code == 0);
  CHECK(was_seen);
  CHECK(cli.read("sticks/report.html") == whole);
  CHECK(cli.parallax({"report", folder, folder, "--watch"}).code == 2);
}

TEST_CASE("a folder that is removed while it is watched ends the watch") {
  const CliFixture cli;
  const auto folder = exact_run(cli);
  std::filesystem::rename(cli.folder() / "sticks", cli.folder() / "my sticks");
  std::filesystem::remove(cli.folder() / "my sticks/report.json");
  ProcessOptions options;
  options.folder = kSource;
  options.signal_when = [&] {
    if (std::filesystem::exists(cli.folder() / "page.html")) {
      std::filesystem::remove_all(cli.folder() / "my sticks");
    }
    return 0;
  };
  const auto page = (cli.folder() / "page.html").string();
  const auto ran = (cli.folder() / "my sticks").string();
  const auto made = cli.parallax({"report", ran, "-o", page});
  CHECK(made.err.find("--out '" + ran + "' --resume") != std::string::npos);
  std::filesystem::remove(page);
  const auto watched = cli.parallax({"report", ran, "-o", page, "--watch"}, options);
  CHECK(watched.code == 2);
  CHECK(watched.err.find("E7111") != std::string::npos);
}

TEST_CASE("a missing recording comes with the command that makes it, and a broken one is said") {
  const CliFixture cli;
  REQUIRE(cli.parallax({"run", "edge.yaml", "--record", "none", "--out", "edge"}).code == 1);
  CHECK(cli.parallax({"report", "edge", "-o", "page.html"}).code == 0);
  const auto before = page_of(cli, "page.html");
  CHECK(before.motion.empty());
  CHECK(before.text.find("parallax replay edge --sample 1.1 --record") != std::string::npos);
  REQUIRE(cli.parallax({"replay", "edge", "--sample", "1.1", "--record"}).code == 0);
  CHECK(cli.parallax({"report", "edge", "-o", "page.html"}).code == 0);
  const auto after = page_of(cli, "page.html");
  CHECK(Json::parse(after.motion)["runs"][0]["name"] == "1.1");
  CHECK(after.text.find("--record") == std::string::npos);
  const auto recording = cli.read("edge/recordings/1.1.rec");
  cli.write("edge/recordings/1.1.rec", recording.substr(0, recording.size() / 2));
  const auto made = cli.parallax({"report", "edge", "-o", "page.html"});
  CHECK(made.code == 0);
  CHECK(made.err.find("The recording of simulation 1.1 cannot be shown") != std::string::npos);
  CHECK(page_of(cli, "page.html").motion.empty());
  // One of another run, whole, of the same number.
  cli.parallax({"run", "edge.yaml", "--seed", "7", "--record", "all", "--out", "other"});
  cli.write("edge/recordings/1.1.rec", cli.read("other/recordings/1.1.rec"));
  const auto mixed = cli.parallax({"report", "edge", "-o", "page.html"});
  CHECK(mixed.code == 0);
  CHECK(mixed.err.find("it is that of another run") != std::string::npos);
  CHECK(page_of(cli, "page.html").motion.empty());
}

TEST_CASE("a certificate that lies in the folder is shown with its shares, or said why it is not") {
  const CliFixture cli;
  REQUIRE(cli.parallax({"run", "scenario.yaml", "--max-runs", "8", "--out", "edge"}).code == 4);
  const auto proof = edge_proof(cli, "edge");
  const auto page_with = [&](const Json& certificate) {
    cli.write("edge/one.proof.json", certificate.dump());
    const auto made = cli.parallax({"report", "edge", "-o", "page.html"});
    CHECK(made.code == 0);
    return std::pair{page_of(cli, "page.html"), made.err};
  };
  const auto [shown, said] = page_with(proof);
  CHECK(said.empty());
  CHECK(shown.ids.contains("proof"));
  for (const auto* part : {"25 %", "50 %", "is the way free?", "contacts decide",
                           "box stays within 0.002 m", "--check edge/one.proof.json", "box.x"}) {
    CAPTURE(part);
    CHECK(shown.text.find(part) != std::string::npos);
  }
  CHECK(shown.text.find("Dots are simulations of drawn starts: ") != std::string::npos);

  const auto refused = [&](Json certificate, const std::string& why) {
    const auto [page, err] = page_with(certificate);
    CAPTURE(why);
    CHECK(err.find("The proof one.proof.json is not shown: " + why) != std::string::npos);
    CHECK_FALSE(page.ids.contains("proof"));
  };
  auto other = proof;
  other["scenario_hash"] = "fnv1a64:0";
  refused(other, "it is of another scenario");
  other.erase("scenario_hash");
  refused(other, "`scenario_hash` is missing");
  other = proof;
  other["assumptions"]["drift"] = -1;
  refused(other, "its assumption `drift` is no number from 0 to 10");
  other = proof;
  other["actions"][0]["tests"][0]["safe"] = 1.0;
  refused(other, "`safe` of `Drive::is_blocked` is 1, and its boxes have 0.25");
  other = proof;
  other["actions"][0]["event"] = "Go(r1)";
  refused(other, "its trace 1 is not that of the run");
  other = proof;
  other["actions"][0]["tests"][0]["boxes"].erase(1);
  other["actions"][0]["tests"][0].update({{"refuted", 0.0}, {"examined", 3}});
  refused(other, "the boxes of Go(r2) do not fill the start region");
  other = proof;
  other["region"][0] = {1.0, 1.0};
  refused(other, "a variable of its region has no width");
  refused(Json{{"mine", 1}}, "it is no geometry proof");
  std::filesystem::remove(cli.folder() / "edge/one.proof.json");
  std::filesystem::create_symlink("/etc/hostname", cli.folder() / "edge/one.proof.json");
  const auto made = cli.parallax({"report", "edge", "-o", "page.html"});
  CHECK(made.code == 0);
  CHECK(made.err.find("The proof one.proof.json is not shown: it cannot be read") !=
        std::string::npos);
}

TEST_CASE("a folder that is none is not watched") {
  const CliFixture cli;
  cli.write("empty/other.txt", "");
  for (const auto* folder : {"nowhere", "empty"}) {
    const auto refused = cli.parallax({"report", folder, "--watch"});
    CHECK(refused.code == 2);
    CHECK(refused.err.find("E7111") != std::string::npos);
  }
}

TEST_CASE("further executions of a plan are on the page, judged, and no part of the claim") {
  const CliFixture cli;
  REQUIRE(cli.parallax({"run", "edge.yaml", "--execution", "closed-loop", "--out", "loop"}).code ==
          1);
  REQUIRE(cli.parallax({"explain", "loop"}).code == 1);
  CHECK(cli.parallax({"report", "loop", "-o", "page.html"}).code == 0);
  const auto page = page_of(cli, "page.html");
  const auto data = Json::parse(page.data);
  const auto report = Json::parse(cli.read("loop/report.json"));
  std::int64_t further = 0, failed = 0, drawn = 0;
  for (const auto& sample : data["samples"]) {
    if (sample[4] == 3) {
      ++further;
      failed += sample[1] == 1 ? 1 : 0;
      CHECK(sample[1] != 3);
    } else {
      ++drawn;
    }
  }
  CHECK(drawn == report["simulations"]);
  CHECK(further >= 10);
  CHECK(failed >= 5);
  CHECK(page.text.find("made afterwards") != std::string::npos);
  CHECK(page.text.find("Trace 1") == std::string::npos);
  CHECK(page.text.find("It happens where box.x > 1.8") != std::string::npos);
}

TEST_CASE("the curve of confidence ends at what the report certifies") {
  const CliFixture cli;
  for (const auto& more : {std::vector<std::string>{}, {"--keep-going"}}) {
    std::vector<std::string> words = {"run",        "edge.yaml", "--execution", "closed-loop",
                                      "--max-runs", "30",        "--out",       "r"};
    words.back() += std::to_string(more.size());
    const auto folder = words.back();
    words.insert(words.end(), more.begin(), more.end());
    REQUIRE(cli.parallax(words).code == 1);
    CHECK(cli.parallax({"report", folder, "-o", folder + ".html"}).code == 0);
    const auto trace = Json::parse(cli.read(folder + "/report.json"))["traces"][0];
    const auto page = page_of(cli, folder + ".html");
    const auto bound = harness::percent_up(trace["certified"]["epsilon"]);
    CHECK(page.text.find("stop after " + trace["simulations"].dump() + ": " + bound) !=
          std::string::npos);
    CHECK(page.text.find("Certified with 98 % confidence") != std::string::npos);
  }
}

TEST_CASE("several folders are held against each other") {
  const CliFixture cli;
  const auto first = exact_run(cli, "sticks"), second = exact_run(cli, "agree");
  CHECK(at_source(cli, {"report", first, second, "-o", (cli.folder() / "c.html").string()}).code ==
        0);
  const auto page = page_of(cli, "c.html");
  CHECK(page.text.find("2 runs, different verdicts") != std::string::npos);
  CHECK(page.text.find("1 of 2 (50 %; 0.42 to 99.58 %)") != std::string::npos);
  CHECK(page.text.find("Traces that were simulated:") != std::string::npos);
}

}  // namespace
}  // namespace parallax::test
