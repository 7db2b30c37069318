#include <doctest/doctest.h>

#include "tests/tools/cli_fixture.h"

namespace parallax::test {
namespace {

constexpr const char* kSwitch =
    "range time 0 2\nfluent On()\nevent Press()\n[time] Initiates(Press(),On(),time).\n";

TEST_CASE("compile --emit=lp prints the model as a logic program with the horizon asked for") {
  const CliFixture cli;
  cli.write("switch.e", kSwitch);
  const auto printed = cli.parallax({"compile", "switch.e", "--emit=lp", "--horizon", "7"});
  CHECK(printed.code == 0);
  CHECK(printed.err.empty());
  CHECK(printed.out.find("#const horizon = 7.\n") != std::string::npos);
  CHECK(printed.out.find("% switch.e:4: [time] Initiates(Press(),On(),time)\n"
                         "initiates(press,on,Time) :- step(Time).\n") != std::string::npos);
  const auto written = cli.parallax({"compile", "switch.e", "--emit=lp", "-o", "switch.lp"});
  CHECK(written.code == 0);
  CHECK(cli.read("switch.lp") == cli.parallax({"compile", "switch.e", "--emit=lp"}).out);
}

TEST_CASE("compile --emit=lp has no other meaning than the standard one") {
  const CliFixture cli;
  cli.write("switch.e", kSwitch);
  const auto refused =
      cli.parallax({"compile", "switch.e", "--emit=lp", "--compat", "decreasoner"});
  CHECK(refused.code == 2);
  CHECK(refused.out.empty());
}

}  // namespace
}  // namespace parallax::test
