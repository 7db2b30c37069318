// Claims cover what was examined: attempts, borders, repetitions, seeds, interruptions.

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "tests/tools/cluster_fixture.h"

namespace parallax::test {
namespace {

using Json = nlohmann::json;

bool has(const std::string& text, const std::string& part) {
  CAPTURE(text);
  const bool found = text.find(part) != std::string::npos;
  CHECK_MESSAGE(found, part);
  return found;
}

bool lacks(const std::string& text, const std::string& part) {
  return text.find(part) == std::string::npos;
}

/// A coin as the simulator, and 11 runs that exclude 20 % with 90 % confidence.
class Coin : public Cluster {
 public:
  ProcessResult run(const std::string& out, std::vector<std::string> more = {}) const {
    std::vector<std::string> words = {"run", "coin.yaml",        "--out",
                                      out,   "--allow-commands", "--confidence",
                                      "0.9", "--epsilon",        "0.2"};
    words.insert(words.end(), more.begin(), more.end());
    return parallax(words);
  }
  Json report(const std::string& out) const { return Json::parse(read(out + "/report.json")); }

  /// A case whose simulator is one coin in the first attempt and another one later.
  void two_coins(double first, double later, const std::string& expect) const {
    coin(0.0, "seeded");
    replace("coin.yaml",
            read("coin.yaml")
                .substr(read("coin.yaml").find("simulator:"),
                        read("coin.yaml").find("regions:") - read("coin.yaml").find("simulator:")),
            fmt::format("simulator: {{command: [sh, -c, 'if [ -e tried ]; then exec {0} {2} seeded "
                        "coin.log; fi; : >tried; exec {0} {1} seeded coin.log']}}\nexpect: {3}\n",
                        PARALLAX_COIN_SIMULATOR, first, later, expect));
  }
};

TEST_CASE("a statistical test is not repeated until it passes") {
  const Coin cli;
  const std::vector<std::string> suite = {"suite", "coin.yaml",  "--retry",
                                          "3",     "--no-cache", "--allow-commands"};
  cli.two_coins(1.0, 0.0, "{rate: {below: 0.2, confidence: 0.9}}");
  const auto rate = cli.parallax(suite);
  CHECK(rate.code == 1);
  has(rate.out, "not repeated (--retry)");
  std::filesystem::remove(cli.folder() / "tried");
  cli.two_coins(1.0, 0.0, "{verdict: no-discrepancy}");
  CHECK(cli.parallax(suite).code == 1);
  // That there is a discrepancy is no statistics: one that was found once is there.
  std::filesystem::remove(cli.folder() / "tried");
  cli.two_coins(0.0, 1.0, "{verdict: discrepancy}");
  const auto found = cli.parallax(suite);
  CHECK(found.code == 0);
  has(found.out, "flaky: passed in attempt 2");
}

TEST_CASE("bounds of rates are rounded outwards, with digits enough") {
  const Coin cli;
  cli.coin(0.0, "seeded");
  const auto rates = cli.parallax({"rates", "coin.yaml", "--runs", "400", "--allow-commands"});
  CHECK(rates.code == 0);
  has(rates.out, "0 %  [0, 0.918]");  // 0.91798
  has(rates.out, "Clopper-Pearson, supposing that no run affects another");
}

TEST_CASE("interrupted rates have intervals that hold whenever they end") {
  const Coin cli;
  cli.coin(0.3, "seeded");
  const std::vector<std::string> words = {"rates",        "coin.yaml", "--runs",          "100000",
                                          "--time-limit", "1",         "--allow-commands"};
  const auto text = cli.parallax(words);
  CHECK(text.code == 4);
  has(text.out, "valid whenever one looks");
  CHECK(lacks(text.out, "Clopper"));
}

TEST_CASE("a claim is about the part of the start region that is drawn") {
  const Coin cli;
  cli.coin(0.0, "seeded");
  cli.replace("coin.yaml", "actions:", "sampling: {inset_m: 0.2}\nactions:");
  const auto run = cli.run("out");
  CHECK(run.code == 0);
  has(run.out.substr(0, run.out.find("made")), "`inset_m`: 0.2");
  has(cli.read("out/report.txt"), "60 %");
  const auto report = cli.report("out");
  CHECK(report["traces"][0]["start_shares"][0]["share"].get<double>() == doctest::Approx(0.6));
  has(report["traces"][0]["claim"].get<std::string>(), "without its rim (`inset_m`: 0.2)");
}

TEST_CASE("a clean simulation is repeated after the others, and in a fresh simulator") {
  const Coin cli;
  cli.coin(0.0, "seeded");
  REQUIRE(cli.run("well").code == 0);
  const auto well = cli.report("well");
  CHECK(well["repetition"]["sample"] == "1.1");
  CHECK(well["repetition"]["after_the_others"]["outcome"] == "same");
  CHECK(well["repetition"]["fresh_simulator"]["outcome"] == "same");
  CHECK(well["simulations"] == 11);
  CHECK(cli.lines_of("coin.log") == 13);
  // Neither is a sample, and no journal has it; a continuation and other workers tell the same.
  CHECK(cli.lines_of("well/journal.ndjson") == 13);
  const auto before = without_timing(cli.read("well/report.json"));
  REQUIRE(cli.run("well", {"--resume"}).code == 0);
  CHECK(without_timing(cli.read("well/report.json")) == before);
  REQUIRE(cli.run("jobs", {"--jobs", "3"}).code == 0);
  CHECK(cli.report("jobs")["repetition"] == well["repetition"]);

  cli.replace("coin.yaml", "command: [", "command: [env, COIN_WEAR=11, ");
  const auto worn = cli.run("worn");
  CHECK(worn.code == 4);
  has(worn.out, "nothing is claimed");
  const auto report = cli.report("worn");
  CHECK(report["verdict"] == "inconclusive");
  CHECK(report["repetition"]["after_the_others"]["outcome"] == "not-clean");
  CHECK(report["repetition"]["fresh_simulator"]["outcome"] == "same");
  CHECK(report["traces"][0]["certified"]["epsilon"] == 1.0);
  has(report["traces"][0]["caveats"].dump(), "repeated after the others with the same start");
}

TEST_CASE("a fresh seed is printed, and the run can be repeated with it") {
  const Coin cli;
  cli.coin(0.0, "seeded");
  const auto first = cli.run("first", {"--seed", "new"}),
             second = cli.run("second", {"--seed", "new"});
  REQUIRE(first.code == 0);
  REQUIRE(second.code == 0);
  const auto seed = cli.report("first")["seed"].get<std::uint64_t>();
  CHECK(seed != cli.report("second")["seed"].get<std::uint64_t>());
  has(first.out, fmt::format("seed {}", seed));
  REQUIRE(cli.run("again", {"--seed", std::to_string(seed)}).code == 0);
  CHECK(cli.read("again/journal.ndjson") == cli.read("first/journal.ndjson"));
  const auto refused = cli.run("none", {"--seed", "newer"});
  CHECK(refused.code == 2);
  has(refused.err, "neither `new` nor a whole number");
}

TEST_CASE("starts that found a discrepancy before are not new, and a run says so") {
  const Coin cli;
  cli.coin(1.0, "seeded");
  REQUIRE(cli.run("runs/before").code == 1);
  cli.coin(0.0, "seeded");
  const auto mended = cli.run("runs/mended");
  CHECK(mended.code == 0);
  has(mended.err, "W7168");
  has(mended.err, "runs/before");
  CHECK(lacks(cli.run("runs/fresh", {"--seed", "new"}).err, "W7168"));
  CHECK(lacks(cli.run("elsewhere/mended").err, "W7168"));
}

}  // namespace
}  // namespace parallax::test
