// Workers of several kinds: refused, or told in journal and report; modules of a scenario, which
// are part of what a worker is; and campaigns that are killed outright.

#include <csignal>
#include <fstream>
#include <regex>
#include <set>

#include "tests/tools/cluster_fixture.h"

namespace parallax::test {
namespace {

using Json = nlohmann::json;

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

const std::vector<std::string> kRun = {"run",      "scenario.yaml", "--epsilon", "0.15",
                                       "--record", "none",          "--out",     "out"};

std::vector<std::string> joined(std::vector<std::string> words,
                                const std::vector<std::string>& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

std::vector<Json> journal_of(const CliFixture& cli, const std::string& run) {
  std::ifstream in(cli.folder() / run / "journal.ndjson");
  std::vector<Json> out;
  for (std::string line; std::getline(in, line);) out.push_back(Json::parse(line));
  return out;
}

/// A launcher whose worker is another build; it calculates as this one does.
std::string other_build(const Cluster& cli) {
  return cli.script(
      "build.sh",
      "\"$@\" | sed -u '/parallax_worker/s/\"build\":\"[^\"]*\"/\"build\":\"0123456789abcdef\"/"
      ";s/\"libm[^\"]*\":\"[^\"]*\"/\"libm.so.6\":\"01234567\"/'");
}

TEST_CASE("with --mixed other kinds take part, and each simulation names its kind") {
  const Cluster cli;
  cli.write("hosts", "1 " + cli.meets("other", "own", other_build(cli)) + "\n1 " +
                         cli.meets("own", "other", "env") + "\n");
  const auto found = cli.parallax(joined(kRun, {"--hosts", "hosts", "--mixed", "--json"}));
  CAPTURE(found.err);
  REQUIRE(found.code == 0);
  CHECK(has(found.err, "sh build.sh` is of another kind: parallax "));
  CHECK(has(found.err, "not the same: libm.so.6"));
  const auto journal = journal_of(cli, "out");
  REQUIRE(journal.size() > 25);
  const auto& header = journal.front();
  CHECK(header.at("mixed") == true);
  CHECK(header.at("simulator").at("determinism") == "tolerance");
  const std::string arithmetic = header.at("arithmetic"), build = header.at("build");
  std::map<std::string, std::int64_t> kinds;
  for (const auto& line : journal) {
    if (line.contains("sample")) ++kinds[line.at("kind").get<std::string>()];
  }
  REQUIRE(kinds.size() == 2);
  CHECK(kinds.contains(build + "/" + arithmetic));
  CHECK(kinds.contains("0123456789abcdef/" + arithmetic));
  const auto report = Json::parse(cli.read("out/report.json"));
  REQUIRE(report.at("kinds").size() == 2);
  for (const auto& one : report.at("kinds")) {
    CHECK(one.at("simulations") == kinds.at(one.at("kind").get<std::string>()));
  }
  CHECK(has(cli.read("out/report.txt"), "of several kinds (--mixed)"));

  const auto resume = joined(kRun, {"--resume", "--max-runs", "200", "--launcher", "env"});
  const auto pure = cli.parallax(resume);
  CHECK(pure.code == 3);
  CHECK_MESSAGE(has(pure.err, "permission for workers of several kinds (--mixed)"), pure.err);
  const auto on = cli.parallax(joined(resume, {"--mixed"}));
  CHECK_MESSAGE(on.code == 0, on.err);
}

TEST_CASE("a simulation that another kind made says so when it is repeated") {
  const Cluster cli;
  REQUIRE(cli.parallax(joined(kRun, {"--launcher", other_build(cli), "--mixed"})).code == 0);
  auto journal = cli.read("out/journal.ndjson");
  // A digit of an observation is another one, as if it were of another library.
  const std::regex observed(R"("box.x":([0-9]+)\.([0-9]+))");
  std::smatch match;
  const auto begin = journal.find("\"observations\"");
  REQUIRE(begin != std::string::npos);
  auto tail = journal.substr(begin);
  REQUIRE(std::regex_search(tail, match, observed));
  auto& digit = tail[static_cast<std::size_t>(match.position() + match.length()) - 2];
  digit = digit == '5' ? '6' : '5';
  cli.write("out/journal.ndjson", journal.substr(0, begin) + tail);
  const auto again = cli.parallax({"replay", "out", "--sample", "1.1"});
  CHECK(again.code == 1);
  CHECK_MESSAGE(has(again.out, "another build of the program"), again.out);
  CHECK_FALSE(has(again.out, "a processor that calculates differently"));
  CHECK(has(cli.parallax({"replay", "out", "--sample", "1.1", "--json"}).out,
            "\"other_build\":true"));
}

TEST_CASE("rates of several kinds are told, too, and nothing is made twice") {
  const Cluster cli;
  cli.coin(0.3, "seeded");
  cli.write("hosts", "2 " + other_build(cli) + "\n2 env\n");
  const auto report =
      json_of(cli, {"rates", "coin.yaml", "--runs", "80", "--hosts", "hosts", "--mixed"});
  std::int64_t all = 0;
  for (const auto& one : report.at("kinds")) all += one.at("simulations").get<std::int64_t>();
  CHECK(all == 80);
  CHECK(cli.lines_of("coin.log") == 80);
  CHECK(has(cli.parallax({"rates", "coin.yaml", "--runs", "8", "--launcher", "env", "--mixed"}).out,
            "workers: of one kind (--mixed)"));
}

TEST_CASE("--mixed is about workers, and lets in no other version") {
  const Cluster cli;
  cli.coin(0.3, "seeded");
  const auto alone = cli.parallax({"rates", "coin.yaml", "--runs", "4", "--mixed"});
  CHECK(alone.code == 2);
  CHECK(has(alone.err, "--mixed"));
  const auto old = cli.script("old.sh",
                              "\"$@\" | sed -u '/parallax_worker/s/\"version\":\"[^\"]*\"/"
                              "\"version\":\"0.0.9\"/'");
  const auto refused =
      cli.parallax({"rates", "coin.yaml", "--runs", "4", "--launcher", old, "--mixed"});
  CHECK(refused.code == 4);
  CHECK_MESSAGE(has(refused.err, "W7132"), refused.err);
}

TEST_CASE("a worker that is refused is told with the files that differ") {
  const Cluster cli;
  cli.coin(0.3, "seeded");
  const auto found =
      cli.parallax({"rates", "coin.yaml", "--runs", "4", "--launcher", other_build(cli)});
  CHECK(found.code == 4);
  CHECK_MESSAGE(has(found.err, "not the same: libm.so.6"), found.err);
}

TEST_CASE("a run that another build began is not continued") {
  const Cluster cli;
  REQUIRE(cli.parallax(joined(kRun, {"--max-runs", "2"})).code == 4);
  auto journal = cli.read("out/journal.ndjson");
  const std::regex digits(R"("build":"[0-9a-f]{16}")");
  REQUIRE(std::regex_search(journal, digits));
  const auto resume = joined(kRun, {"--resume", "--max-runs", "3"});
  CHECK(cli.parallax(resume).code == 4);
  cli.write("out/journal.ndjson",
            std::regex_replace(journal, digits, R"("build":"0123456789abcdef")"));
  const auto other = cli.parallax(resume);
  CHECK(other.code == 3);
  CHECK_MESSAGE(has(other.err, "its program's build, or that of a library is"), other.err);
  // An older journal does not say.
  cli.write("out/journal.ndjson",
            std::regex_replace(journal, std::regex(R"("build":"[0-9a-f]{16}",)"), ""));
  CHECK(cli.parallax(resume).code == 4);
}

TEST_CASE("worlds that modules read or step are simulated elsewhere") {
  const Cluster cli;
  cli.write("soft.yaml", "include: edge.yaml\nsimulator: {engine: mujoco}\n");
  const std::string office = PARALLAX_SOURCE_DIR "/scenarios/office/fetch.yaml";
  for (const std::string& scenario : {std::string("soft.yaml"), office}) {
    CAPTURE(scenario);
    const std::vector<std::string> rates = {"rates", scenario, "--runs", "3", "--json"};
    const auto expected = cli.parallax(rates);
    if (has(expected.err, "E5145") || has(expected.err, "built without")) {
      MESSAGE("SKIPPED: this build lacks a module for " << scenario);
      continue;
    }
    CHECK_MESSAGE(expected.code == 0, expected.err);
    const auto found = cli.parallax(joined(rates, {"--launcher", "env", "--jobs", "2"}));
    CHECK_MESSAGE(found.code == 0, found.err);
    CHECK(found.out == expected.out);
  }
}

TEST_CASE("a file of hosts leaves no trace in the files of a run") {
  const Cluster here, there;
  there.write("hosts", "2 env\n");
  REQUIRE(here.parallax(kRun).code == 0);
  const auto found = there.parallax(joined(kRun, {"--hosts", "hosts"}));
  CHECK_MESSAGE(found.code == 0, found.err);
  CHECK(differing_files(here, there, "out") == "");
}

TEST_CASE("a campaign with many workers that is killed outright loses nothing that was finished") {
  const Cluster cli;
  cli.coin(0.0, "seeded");
  const std::vector<std::string> run = {"run", "coin.yaml", "--launcher", "env", "--jobs", "16"};
  REQUIRE(cli.parallax(joined(run, {"--out", "whole"})).code == 0);
  std::filesystem::remove(cli.folder() / "coin.log");
  const auto lines = [&] {
    std::ifstream in(cli.folder() / "cut/journal.ndjson");
    std::size_t count = 0;
    for (std::string line; std::getline(in, line);) ++count;
    return count;
  };
  ProcessOptions options;
  options.signal_when = [&] { return lines() > 30 ? SIGKILL : 0; };
  const auto cut = cli.parallax(joined(run, {"--out", "cut"}), options);
  CHECK(cut.code == 128 + SIGKILL);
  const auto kept = lines();
  CHECK(kept > 30);
  const auto rest = cli.parallax(joined(run, {"--out", "cut", "--resume"}));
  CHECK_MESSAGE(rest.code == 0, rest.err);
  auto text = cli.read("cut/journal.ndjson");
  CHECK(text == cli.read("whole/journal.ndjson"));
  // Each simulation was made once, but for those that were under way at the end.
  CHECK(cli.lines_of("coin.log") <= journal_of(cli, "whole").size() + 16);
}

}  // namespace
}  // namespace parallax::test
