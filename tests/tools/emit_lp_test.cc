#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

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

/// The number of answer sets, each with the atoms shown; none where clingo is not installed.
std::optional<std::string> answer_sets(const CliFixture& cli, const std::string& program) {
  if (run_process({"clingo", "--version"}).code != 0) {
    MESSAGE("clingo is not installed: skipped");
    return std::nullopt;
  }
  cli.write("program.lp", program);
  const auto result = run_process({"clingo", "--verbose=0", "--warn=none", "--models=0",
                                   (cli.folder() / "program.lp").string()});
  CAPTURE(result.err);
  CHECK((result.code == 20 || result.code == 30));
  return std::to_string(std::count(result.out.begin(), result.out.end(), '\n') - 1) + "\n";
}

TEST_CASE("the answer sets of the logic program are the traces of --distinct all, one for one") {
  const CliFixture cli;
  const std::string one = "fluent On()\nevent Press()\n[time] Initiates(Press(),On(),time).\n";
  const std::string causal = "load foundations/ECCausal.e\nrange time 0 1\n" + one;
  const std::string things =
      "range time 0 1\nsort thing\nthing A, B, C\npredicate P(thing)\npredicate Q(thing,thing)\n"
      "predicate Never(time,thing)\npredicate R()\nfluent On()\nevent Press()\n"
      "[time] Initiates(Press(),On(),time).\n!HoldsAt(On(),0).\n";
  // Axioms with effects in their conditions are reasons for completion; definitions are not.
  const std::string reasons = one + "range time 0 1\nevent Ring()\ncompletion Happens\n";
  const std::vector<std::string> models = {
      reasons + "[time] !Terminates(Press(),On(),time) -> Happens(Press(),time).\n",
      reasons +
          "[time] HoldsAt(On(),time) & Initiates(Press(),On(),time) -> Happens(Ring(),time).\n",
      causal,
      causal + "!HoldsAt(On(),0).\n",
      causal + "[time] Started(On(),time) -> Stopped(On(),time).\n",
      causal + "[time] Stopped(On(),time) & Initiated(On(),time) -> Happens(Press(),time).\n",
      "load foundations/ECCausal.e\nrange time 0 0\n" + one,
      "load foundations/DEC.e\nrange time 0 2\n" + one + "!Clipped(0,On(),2).\n",
      things,
      things + "P(A).\nP(B) | HoldsAt(On(),1).\n",
      things +
          "P(A).\n[thing1,thing2] thing1!=thing2 & P(thing1) -> Q(thing1,thing2) | "
          "thing1=thing2.\n",
      things + "[thing] P(thing) | !P(thing).\nR() <-> HoldsAt(On(),1).\n",
      things +
          "[thing] P(thing) <-> thing=A.\n"
          "[thing1,thing2] P(thing1) -> Q(thing1,thing2) | HoldsAt(On(),1).\n",
      things + "[time,thing] HoldsAt(On(),time) -> Never(time,thing).\ncompletion Never\n",
      "range time 0 1\nfluent F()\nevent E()\nsort value: integer\npredicate V(value)\n"
      "V(3) | V(-4).\nV(3) -> HoldsAt(F(),0).\nV(5) | 1=1.\n",
  };
  for (const auto& model : models) {
    CAPTURE(model);
    cli.write("m.e", model);
    const auto printed = cli.parallax({"compile", "m.e", "--emit=lp"});
    CAPTURE(printed.err);
    REQUIRE(printed.code == 0);
    const auto found = answer_sets(cli, printed.out);
    if (!found) return;
    CHECK(cli.parallax({"traces", "m.e", "--count", "--distinct", "all"}).out == *found);
  }
}

TEST_CASE("the same of the classic problems") {
  const CliFixture cli;
  int compared = 0;
  const auto folder = std::filesystem::path(PARALLAX_SOURCE_DIR) / "scenarios/classics";
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.path().extension() != ".e") continue;
    const auto model = entry.path().string();
    CAPTURE(model);
    const auto printed = cli.parallax({"compile", model, "--emit=lp", "--allow-outside"});
    if (printed.code != 0) continue;  // a part that others load
    const auto found = answer_sets(cli, printed.out);
    if (!found) return;
    const auto counted =
        cli.parallax({"traces", model, "--count", "--distinct", "all", "--allow-outside"});
    CHECK(counted.out == *found);
    ++compared;
  }
  CHECK(compared >= 20);
}

TEST_CASE("for another horizon than the model's, the logic program leaves every atom open") {
  const CliFixture cli;
  cli.write("m.e",
            "range time 0 1\nfluent F()\nevent E()\npredicate P(time)\n"
            "[time] HoldsAt(F(),time) & time>=1 -> P(time).\n");
  auto program = cli.parallax({"compile", "m.e", "--emit=lp"}).out;
  CHECK(program.find("open_p(1).\n") != std::string::npos);
  CHECK(program.find("open_p(0).\n") == std::string::npos);
  const std::string horizon = "#const horizon = 1.";
  program.replace(program.find(horizon), horizon.size(), "#const horizon = 2.");
  const auto found = answer_sets(cli, program);
  // F always or never, E at 0 and 1, P(0) as it likes, P(1) and P(2) true with F.
  if (found) CHECK(*found == std::to_string(4 * 2 * (1 + 4)) + "\n");
}

TEST_CASE("what ECCausal.e defines is in every trace, also where it always holds") {
  const CliFixture cli;
  cli.write("m.e",
            "load foundations/ECCausal.e\nrange time 0 1\nfluent On()\nevent Press()\n"
            "[time] Initiates(Press(),On(),time).\n!HoldsAt(On(),0).\n");
  const auto listed =
      cli.parallax({"traces", "m.e", "--format", "jsonl", "--distinct", "all", "--limit", "1"}).out;
  CHECK(listed.find("\"Stopped(On(),0)\"") != std::string::npos);
  CHECK(listed.find("\"Terminated(On(),0)\"") != std::string::npos);
  CHECK(listed.find("\"Started(On(),0)\"") == std::string::npos);
}

}  // namespace
}  // namespace parallax::test
