// `parallax rates --method`: rates that are too small to be found by counting.

#include <doctest/doctest.h>

#include "tests/tools/cli_fixture.h"

namespace parallax::test {
namespace {

bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

constexpr const char* kScenario = "scenario.yaml";

TEST_CASE("rare rates: bad input") {
  const CliFixture cli;
  for (const std::string option :
       {"--plot=p.html", "--samples=s.csv", "--cause-kinds", "--until-width=0.1",
        "--until-below=0.1", "--until-above=0.1", "--runs=999", "--indifference=0.1", "--mean=goal",
        "--outcomes"}) {
    CAPTURE(option);
    const auto ran = cli.parallax({"rates", kScenario, "--method", "importance", option});
    CHECK(ran.code == 2);
    CHECK(holds(ran.err, option.substr(0, option.find('='))));
  }
  const auto few = cli.parallax({"rates", kScenario, "--method", "splitting", "--runs", "1000"});
  CHECK(few.code == 2);
  CHECK(holds(few.err, "fewer than 3500 runs"));
  CHECK(cli.parallax({"rates", kScenario, "--method", "guessing"}).code == 2);
  // A rate that was estimated in this way is no count, and is not compared as one.
  cli.write("rare.json",
            R"({"status":"ok","scenario":"s","seed":1,"confidence":0.95,"method":"importance",)"
            R"("compare":"every-step","complete":true,"traces":[{"trace":1,"events":"Go",)"
            R"("runs":1000,"rejected":0,"lost":0,"end":"estimated","left_out":[],)"
            R"("any":{"rate":0.001,"lower":0.0005,"upper":0.003}}]})");
  CHECK(cli.parallax({"diff", "rare.json", "rare.json"}).code == 3);
}

}  // namespace
}  // namespace parallax::test
