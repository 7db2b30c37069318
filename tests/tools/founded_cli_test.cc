// `option founded on` as the commands show it; its oracle is in tests/fuzz.

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "tests/tools/cli_json.h"

namespace parallax::test {
namespace {

TEST_CASE("verify: founded events do not demand each other, with checked proofs") {
  const CliFixture cli;
  const std::string loop =
      "range time 0 3\nfluent F()\nevent E()\nevent G()\n[time] Initiates(E(),F(),time).\n"
      "[time] Happens(E(),time) -> Happens(G(),time).\n"
      "[time] Happens(G(),time) -> Happens(E(),time).\n!HoldsAt(F(),0).\ncompletion Happens\n";
  cli.write("loop.e", loop);
  cli.write("founded.e", "option founded on\n" + loop);
  const std::string never = "!HoldsAt(F(),time)";
  CHECK(cli.parallax({"verify", "loop.e", "--property", never}).code == 1);
  const auto bounded = cli.parallax({"verify", "founded.e", "--property", never});
  CHECK(bounded.code == 0);
  CHECK(bounded.out == "holds up to horizon 3 (proof checked)\n");
  const auto answer = json_of(cli, {"verify", "founded.e", "--property", never, "--unbounded"}, 0);
  CHECK(answer["verdict"] == "holds");
  CHECK(answer["proof"] == "checked");
  CHECK(json_of(cli, {"traces", "loop.e", "--count"}, 0)["traces"] == 8);
  CHECK(json_of(cli, {"traces", "founded.e", "--count"}, 0)["traces"] == 1);
  CHECK(cli.parallax({"traces", "founded.e", "--check"}).code == 0);
  CHECK(cli.parallax({"check", "founded.e"}).err.find("W3060") == std::string::npos);
}

}  // namespace
}  // namespace parallax::test
