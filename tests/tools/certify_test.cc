// `parallax traces --certify`: the proof that a list of traces is complete.

#include <doctest/doctest.h>

#include "tests/tools/cli_fixture.h"

namespace parallax::test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTwoTraces =
    "range time 0 1\nfluent F()\nfluent G()\nevent E()\nHoldsAt(F(),0).\n!Happens(E(),0).\n";

bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// Seven things in six places, each with a place of its own: no model, and hard to tell.
std::string crowd(int things) {
  std::string text = "range time 0 0\nsort thing\nsort place\nthing T0";
  for (int i = 1; i < things; ++i) text += ",T" + std::to_string(i);
  text += "\nplace P0";
  for (int i = 1; i + 1 < things; ++i) text += ",P" + std::to_string(i);
  return text +
         "\nfluent At(thing,place)\n[thing] {place} HoldsAt(At(thing,place),0).\n"
         "[thing1,thing2,place] HoldsAt(At(thing1,place),0) & HoldsAt(At(thing2,place),0) -> "
         "thing1=thing2.\n";
}

TEST_CASE("the summary says whether the list was proved to be complete") {
  const CliFixture cli;
  cli.write("m.e", kTwoTraces);
  CHECK(holds(cli.parallax({"traces", "m.e"}).out, "\n2 traces, complete (no proof)\n"));
  CHECK(holds(cli.parallax({"traces", "m.e", "--json"}).out, "\"proof\":\"none\""));
  const auto text = cli.parallax({"traces", "--certify", "m.e"});
  CHECK(text.code == 0);
  CHECK(holds(text.out, "\n2 traces, complete (proof checked)\n"));
  CHECK(holds(text.err, "m.drat: "));
  CHECK(fs::exists(cli.folder() / "m.drat"));
  CHECK(holds(cli.read("m.drat.cnf"), "HoldsAt(G(),1)\np cnf "));
  const auto lines = cli.parallax({"traces", "m.e", "--certify=q.drat", "--format", "jsonl"});
  CHECK(holds(lines.out,
              "\"complete\":true,\"proof\":\"checked\",\"proof_origin\":\"search\","
              "\"proof_file\":\"q.drat\",\"formula_file\":\"q.drat.cnf\""));
  const auto tree = cli.parallax({"traces", "m.e", "--certify", "--strategy", "tree", "--json"});
  CHECK(holds(tree.out, "\"proof\":\"checked\",\"proof_origin\":\"fresh solve\""));
}

TEST_CASE("an unsatisfiable model is certified, listed or counted") {
  const CliFixture cli;
  cli.write("m.e", crowd(7));
  const auto listed = cli.parallax({"traces", "m.e", "--certify"});
  CHECK(listed.code == 0);
  CHECK(listed.out == "0 traces, complete (proof checked)\n");
  const auto counted = cli.parallax({"traces", "m.e", "--certify=c.drat", "--count", "--json"});
  CHECK(holds(counted.out, "\"traces\":0,\"complete\":true"));
  CHECK(holds(counted.out, "\"proof\":\"checked\""));
  CHECK(cli.read("m.drat") == cli.read("c.drat"));
}

TEST_CASE("without a complete list there is no proof, and that is said") {
  const CliFixture cli;
  cli.write("m.e", kTwoTraces);
  const auto cut = cli.parallax({"traces", "m.e", "--certify", "--limit", "1"});
  CHECK(cut.code == 0);
  CHECK(holds(cut.out, "1 trace, stopped\n"));
  CHECK(holds(cut.err, "warning[W7303]"));
  const auto counted = cli.parallax({"traces", "m.e", "--certify", "--count", "--json"});
  CHECK(holds(counted.out, "\"proof\":\"none\""));
  CHECK(holds(counted.out, "W7303"));
  CHECK_FALSE(fs::exists(cli.folder() / "m.drat"));
  CHECK_FALSE(fs::exists(cli.folder() / "m.drat.part"));
}

TEST_CASE("a compiled model and a scenario with a plan are certified like a text") {
  const CliFixture cli;
  cli.write("m.e", kTwoTraces);
  REQUIRE(cli.parallax({"compile", "m.e", "-o", "m.dec.cnf"}).code == 0);
  const auto compiled = cli.parallax({"traces", "m.dec.cnf", "--certify"});
  CHECK(holds(compiled.out, "2 traces, complete (proof checked)\n"));
  CHECK(fs::exists(cli.folder() / "m.drat"));
  const auto scenario = cli.parallax({"traces", "scenario.yaml", "--certify"});
  CHECK(holds(scenario.out, "1 trace, all traces explored (proof checked)\n"));
}

TEST_CASE("a proof file that cannot be written ends the command with 2 before the work") {
  const CliFixture cli;
  cli.write("m.e", kTwoTraces);
  const auto folder = cli.parallax({"traces", "m.e", "--certify=none/m.drat"});
  CHECK(folder.code == 2);
  CHECK(folder.out == "");
  CHECK(holds(folder.err, "none/m.drat: error[E0005]"));
  const auto device = cli.parallax({"traces", "m.e", "--certify=/dev/null", "--json"});
  CHECK(device.code == 2);
  CHECK(device.out.starts_with("{\"status\":\"error\""));
  CHECK(holds(device.out, "E0003"));
}

TEST_CASE("a limit in the middle leaves no proof behind and exits with 4") {
  const CliFixture cli;
  cli.write("m.e", crowd(13));
  const auto result = cli.parallax({"traces", "m.e", "--certify", "--time-limit", "1"});
  CHECK(result.code == 4);
  CHECK(holds(result.out, "0 traces, stopped\n"));
  CHECK_FALSE(fs::exists(cli.folder() / "m.drat"));
  CHECK_FALSE(fs::exists(cli.folder() / "m.drat.part"));
}

}  // namespace
}  // namespace parallax::test
