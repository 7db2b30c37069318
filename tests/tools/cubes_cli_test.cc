// `--jobs` of commands that ask a solver: the same bytes for any number, and no claim of a proof.

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/tools/cli_json.h"

namespace parallax::test {
namespace {

/// Lamps in holes, at most one in each, and one hole too few where `odd`: a solver needs many
/// conflicts to find that not all are in. Numbers are distinguished, so there is no symmetry.
std::string lamps(int count, bool odd) {
  std::string text = "range time 0 1\nrange lamp 1 " + std::to_string(count) +
                     "\nsort lamp: integer\nsort hole: integer\nrange hole 1 " +
                     std::to_string(odd ? count - 1 : count) +
                     "\nfluent In(lamp,hole)\nevent Put(lamp,hole)\n"
                     "[lamp,hole,time] Initiates(Put(lamp,hole),In(lamp,hole),time).\n"
                     "[lamp,hole1,hole2,time] HoldsAt(In(lamp,hole1),time) & "
                     "HoldsAt(In(lamp,hole2),time) -> hole1=hole2.\n"
                     "[lamp1,lamp2,hole,time] HoldsAt(In(lamp1,hole),time) & "
                     "HoldsAt(In(lamp2,hole),time) -> lamp1=lamp2.\n"
                     "[lamp,hole] !HoldsAt(In(lamp,hole),0).\n";
  return text;
}

const std::string kAllIn = "[lamp] {hole} HoldsAt(In(lamp,hole),1).\n";

TEST_CASE("the same bytes for any number of jobs, also where a question is cut") {
  const CliFixture cli;
  cli.write("none.e", lamps(9, true) + kAllIn);
  cli.write("some.e", lamps(9, false) + kAllIn);
  for (const std::string model : {"none.e", "some.e"}) {
    std::vector<std::string> arguments = {"traces", model, "--limit", "1", "--order", "any"};
    const auto plain = cli.parallax(arguments);
    CHECK(plain.code == 0);
    std::string first;
    for (const std::string jobs : {"1", "2", "4"}) {
      auto with = arguments;
      with.insert(with.end(), {"--jobs", jobs});
      const auto found = cli.parallax(with);
      CHECK(found.code == 0);
      if (first.empty()) first = found.out;
      CHECK(found.out == first);
      CHECK(found.out.starts_with("0 traces, complete") ==
            plain.out.starts_with("0 traces, complete"));
    }
  }
  const auto listed = cli.parallax({"traces", "some.e", "--limit", "3"});
  CHECK(cli.parallax({"traces", "some.e", "--limit", "3", "--jobs", "2"}).out == listed.out);
}

TEST_CASE(
    "a property that takes long to prove: cubes say that there is no proof, --certify has one") {
  const CliFixture cli;
  cli.write("birds.e", lamps(9, true));
  const std::string property = "{lamp} [hole] !HoldsAt(In(lamp,hole),time)";
  const std::vector<std::string> ask = {"verify", "birds.e", "--property", property};
  auto with = ask;
  with.insert(with.end(), {"--jobs", "2"});
  const auto cut = cli.parallax(with);
  CHECK(cut.code == 0);
  CHECK(cut.out.starts_with("holds up to horizon 1 (cubes, not proof checked)"));
  const auto json = json_of(cli, with, 0);
  CHECK(json["proof"] == "none");
  CHECK(json["cubes"] == true);
  // A proof that is asked for is made, without cubes.
  auto proved = with;
  proved.push_back("--certify=birds.drat");
  CHECK(cli.parallax(proved).out.find("(proof checked)") != std::string::npos);
  auto easy = with;
  easy[3] = "[lamp,hole] HoldsAt(In(lamp,hole),time) -> time>0";
  CHECK(cli.parallax(easy).out.find("(proof checked)") != std::string::npos);
}

TEST_CASE("limits end all threads with the code for it, and what makes no sense is refused") {
  const CliFixture cli;
  cli.write("hard.e", lamps(16, true) + kAllIn);
  const auto ended = cli.parallax(
      {"traces", "hard.e", "--limit", "1", "--order", "any", "--jobs", "2", "--time-limit", "1"});
  CHECK(ended.code == 4);
  for (const std::string jobs : {"0", "-1", "two", "1000"}) {
    CHECK(cli.parallax({"traces", "hard.e", "--jobs", jobs}).code == 2);
  }
}

}  // namespace
}  // namespace parallax::test
