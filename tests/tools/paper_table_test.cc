// The table of the method's authors by one command, and the figures of their rule for a check by
// hand.

#include <doctest/doctest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/tools/cli_json.h"

namespace parallax::test {
namespace {

using Json = nlohmann::json;

TEST_CASE("with --verbose the interval follows from b, sigma, Z and the ranges") {
  const CliFixture cli;
  const std::vector<std::string> words = {
      "run",          "scenario.yaml", "--criterion", "paper-literal",
      "--confidence", "0.95",          "--max-runs",  "4"};
  const auto with = [&](std::vector<std::string> more) {
    auto all = words;
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  const auto document = json_of(cli, with({"--verbose", "--out", "a"}));
  const auto& paper = document["traces"][0]["paper"];
  CAPTURE(paper.dump());
  // Phi^-1((1 + sqrt(0.95)) / 2): two parameters of the start vary.
  CHECK(paper["quantile"].get<double>() == doctest::Approx(2.236477).epsilon(1e-6));
  const double runs = paper["runs"];
  CHECK(runs >= 3);
  REQUIRE(paper["intervals"].size() >= 1);
  for (const auto& one : paper["intervals"]) {
    double lower = 0.0, upper = 0.0;
    for (std::size_t i = 0; i < paper["starts"].size(); ++i) {
      const double b = one["b"][i];
      const auto& range = paper["starts"][i]["range"];
      lower += b * range[b > 0.0 ? 0 : 1].get<double>();
      upper += b * range[b > 0.0 ? 1 : 0].get<double>();
    }
    const double sigma = one["sigma"], half = 2.236477 * sigma / std::sqrt(runs);
    CHECK(one["sse"] == one["sigma"]);  // the literal reading
    CHECK(one["lower"].get<double>() == doctest::Approx(lower - half));
    CHECK(one["upper"].get<double>() == doctest::Approx(upper + half));
  }
  const auto text = cli.parallax(with({"--verbose", "--out", "b"}));
  CHECK(text.out.find("  regression   s = ") != std::string::npos);
  CHECK(text.out.find(", Z = 2.236477\n") != std::string::npos);
  CHECK(text.out.find(", b: box.x ") != std::string::npos);
  // Nobody asked: nothing is added, and the files of the run are the same.
  const auto plain = json_of(cli, with({"--out", "c"}));
  CHECK_FALSE(plain["traces"][0]["paper"].contains("intervals"));
  CHECK(cli.read("b/report.json") == cli.read("c/report.json"));
  CHECK(cli.read("b/report.txt").find("regression   s") == std::string::npos);
}

TEST_CASE("the table of the authors has our numbers beside theirs") {
  if (run_process({"python3", "--version"}).code != 0) {
    MESSAGE("SKIPPED: needs python3");
    return;
  }
  const auto table = [](std::vector<std::string> arguments) {
    std::vector<std::string> command = {"env", "PARALLAX=" + CliFixture::program(), "python3",
                                        PARALLAX_SOURCE_DIR "/tools/paper_table"};
    command.insert(command.end(), arguments.begin(), arguments.end());
    return run_process(command);
  };
  const auto ran = table({"--seeds", "2", "--json", "plan1", "plan3"});
  CAPTURE(ran.err);
  REQUIRE(ran.code == 0);
  const auto document = Json::parse(ran.out);
  REQUIRE(document["rows"].size() == 4);
  for (const auto& row : document["rows"]) {
    CAPTURE(row.dump());
    CHECK(row["seeds"] == 2);
    CHECK(row["kinds"] == Json{{row["plan"] == "plan1" ? "D1" : "D3", 2}});
    for (const auto* column : {"iterations", "simulations", "wall_s", "simulated_s"}) {
      const auto& cell = row[column];
      CHECK(cell["least"].get<double>() > 0.0);
      CHECK(cell["least"].get<double>() <= cell["median"].get<double>());
      CHECK(cell["median"].get<double>() <= cell["largest"].get<double>());
    }
    CHECK(row["iterations"]["largest"] == 1);
  }
  CHECK(document["authors"]["plan1"] ==
        Json{{"iterations", 1}, {"simulations", 12}, {"wall_s", 273}, {"kinds", "D1"}});
  const auto text = table({"--seeds", "1", "--criterion", "paper", "plan3"});
  CHECK(text.code == 0);
  CHECK(text.out.find("plan3           authors        1  1                  1 ") !=
        std::string::npos);
  CHECK(text.out.find("D3 x1") != std::string::npos);
  CHECK(table({"plan9"}).code == 2);
  CHECK(table({"--seeds", "0"}).code == 2);
}

}  // namespace
}  // namespace parallax::test
