// `parallax traces --prefer`; the oracle of its answers is in tests/runtime/optimize.

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "tests/tools/cli_json.h"

namespace parallax::test {
namespace {

/// Two switches were pressed, and one light at most is on; the porch is also known to be wet.
const char* const kLights =
    "range time 0 1\nsort switch\nswitch Hall, Porch\npredicate Ab(switch)\npredicate Wet(switch)\n"
    "fluent On(switch)\nevent Press(switch)\n"
    "[switch,time] !Ab(switch) -> Initiates(Press(switch),On(switch),time).\n"
    "[switch] !HoldsAt(On(switch),0).\n[switch] Happens(Press(switch),0).\n"
    "!HoldsAt(On(Hall),1) | !HoldsAt(On(Porch),1).\n[switch] Wet(switch) | !Ab(switch).\n";

TEST_CASE("--prefer lists the traces of minimal sets, and says which these are") {
  const CliFixture cli;
  cli.write("lights.e", kLights);
  CHECK(json_of(cli, {"traces", "lights.e", "--count"})["traces"] == 3);
  const auto text = cli.parallax({"traces", "lights.e", "--limit", "0", "--prefer", "Ab"});
  CHECK(text.code == 0);
  CHECK(
      text.out.ends_with("2 traces, complete (no proof)\nminimal: Ab(Hall)\nminimal: Ab(Porch)\n"));
  const auto answer =
      json_of(cli, {"traces", "lights.e", "--limit", "0", "--prefer", "Ab", "--check"});
  CHECK(answer["traces"] == 2);
  CHECK(answer["minimal_sets"] == nlohmann::json::parse(R"json([["Ab(Hall)"],["Ab(Porch)"]])json"));
  CHECK(json_of(cli, {"traces", "lights.e", "--count", "--prefer", "Ab"})["traces"] == 2);
}

TEST_CASE("--prefer: the first level counts most, and one level takes several names") {
  const CliFixture cli;
  cli.write("lights.e", kLights);
  // The first level: the porch's switch should work.
  const auto answer = json_of(
      cli, {"traces", "lights.e", "--limit", "0", "--prefer", "Ab(Porch)", "--prefer", "Ab, Wet"});
  CHECK(answer["traces"] == 1);
  CHECK(answer["minimal_sets"] == nlohmann::json::parse(R"json([["Ab(Hall)","Wet(Hall)"]])json"));
  // Fluents and events count as well, at each timepoint.
  const auto dark = json_of(cli, {"traces", "lights.e", "--limit", "0", "--prefer", "On"});
  CHECK(dark["minimal_sets"] == nlohmann::json::parse("[[]]"));
  CHECK(dark["traces"] == 1);
}

TEST_CASE("--prefer: wrong names, and what it does not go with") {
  const CliFixture cli;
  cli.write("lights.e", kLights);
  const auto wrong = cli.parallax({"traces", "lights.e", "--prefer", "Wett"});
  CHECK(wrong.code == 2);
  CHECK(wrong.err.find("no fluent, event or predicate `Wett`") != std::string::npos);
  CHECK(wrong.err.find("Wet") != std::string::npos);
  // Predicates of the calculus are no atoms of their own, and would prefer nothing.
  for (const std::string core : {"HoldsAt", "Happens", "Initiates", "ReleasedAt"}) {
    CHECK(cli.parallax({"traces", "lights.e", "--prefer", core}).code == 2);
  }
  cli.write("none.e", std::string("sort none\nfluent Never(none)\n") + kLights);
  CHECK(json_of(cli, {"traces", "none.e", "--count", "--prefer", "Never"})["traces"] == 3);
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{"--until", "HoldsAt(On(Hall),time)"},
        {"--minimize", "count Ab(switch)"},
        {"--up-to-symmetry"},
        {"--certify=x.drat"}}) {
    std::vector<std::string> arguments = {"traces", "lights.e", "--prefer", "Ab"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    CHECK(cli.parallax(arguments).code == 2);
  }
}

}  // namespace
}  // namespace parallax::test
