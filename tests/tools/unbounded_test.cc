// `parallax verify --unbounded`; the oracle of its answers is in tests/runtime/induction.

#include <doctest/doctest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/tools/cli_json.h"

namespace parallax::test {
namespace {

const char* const kToggle =
    "range time 0 3\nfluent On()\nfluent Off()\nevent Flip()\n"
    "[time] HoldsAt(Off(),time) -> Initiates(Flip(),On(),time).\n"
    "[time] HoldsAt(Off(),time) -> Terminates(Flip(),Off(),time).\n"
    "[time] HoldsAt(On(),time) -> Initiates(Flip(),Off(),time).\n"
    "[time] HoldsAt(On(),time) -> Terminates(Flip(),On(),time).\n"
    "HoldsAt(On(),0).\n!HoldsAt(Off(),0).\n";

TEST_CASE("verify --unbounded: at every timepoint, with its proofs beside that of the horizon") {
  const CliFixture cli;
  cli.write("toggle.e", kToggle);
  const std::string property = "!(HoldsAt(On(),time) & HoldsAt(Off(),time))";
  const auto text = cli.parallax({"verify", "toggle.e", "--property", property, "--unbounded"});
  CHECK(text.code == 0);
  CHECK(text.out.starts_with("holds up to horizon 3 (proof checked)\nholds at every timepoint ("));
  const auto answer = json_of(
      cli, {"verify", "toggle.e", "--property", property, "--unbounded", "--certify=t.drat"}, 0);
  CHECK(answer["verdict"] == "holds");
  CHECK(answer["unbounded"]["holds"] == true);
  CHECK(answer["unbounded"]["proof"] == "checked");
  REQUIRE(answer["unbounded"]["proof_files"].size() >= 2);
  for (const auto& file : answer["unbounded"]["proof_files"]) {
    CHECK(std::filesystem::exists(cli.folder() / file.get<std::string>()));
    CHECK(std::filesystem::exists(cli.folder() / (file.get<std::string>() + ".cnf")));
  }
}

TEST_CASE("verify --unbounded: violated, not decided, refused") {
  const CliFixture cli;
  cli.write("toggle.e", kToggle);
  CHECK(json_of(cli, {"verify", "toggle.e", "--property", "HoldsAt(On(),time)", "--unbounded"},
                1)["timepoint"] == 1);
  // It is broken at 4, and the horizon is 3.
  cli.write("late.e",
            "range time 0 3\nsort n: integer\nrange n 0 4\nfluent At(n)\nevent Tick()\n"
            "[n,time] HoldsAt(At(n),time) -> Initiates(Tick(),At(n+1),time).\n"
            "[n] HoldsAt(At(n),0) <-> n=0.\n");
  const auto open =
      cli.parallax({"verify", "late.e", "--property", "!HoldsAt(At(4),time)", "--unbounded"});
  CHECK(open.code == 4);
  CHECK(open.out ==
        "holds up to horizon 3 (proof checked)\n"
        "not decided beyond: induction over 3 steps does not show it\n");
  CHECK(json_of(cli, {"verify", "late.e", "--property", "!HoldsAt(At(4),time)", "--unbounded"},
                4)["verdict"] == "inconclusive");
  cli.write("some.e", std::string(kToggle) + "{time} Happens(Flip(),time).\n");
  const auto refused =
      cli.parallax({"verify", "some.e", "--property", "HoldsAt(On(),0)", "--unbounded"});
  CHECK(refused.code == 3);
  CHECK(refused.err.find("some.e:11:1") != std::string::npos);
  CHECK(refused.err.find("error[E3021]") != refused.err.rfind("error[E3021]"));
  CHECK(cli.parallax(
               {"verify", "scenario.yaml", "--property", "!HoldsAt(Holding(),time)", "--unbounded"})
            .code == 2);
}

}  // namespace
}  // namespace parallax::test
