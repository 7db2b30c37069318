// `compile --emit` and `--stats`: every stage and every pass of the compiler can be looked at.

#include <doctest/doctest.h>

#include "compiler/pipeline/compile.h"
#include "tests/tools/cli_fixture.h"

namespace parallax::test {
namespace {

constexpr const char* kLamp =
    "range time 0 2\nfluent Lit()\nevent Press()\n!HoldsAt(Lit(),0).\n"
    "[time] Initiates(Press(),Lit(),time).\n";

TEST_CASE("--emit=help lists every stage and pass in order, without a model") {
  const CliFixture cli;
  const auto listed = cli.parallax({"compile", "--emit=help"});
  CHECK(listed.code == 0);
  std::size_t at = 0;
  for (const auto* stage : {"tokens", "ast", "typed", "lp"}) {
    at = listed.out.find(stage, at);
    REQUIRE_MESSAGE(at != std::string::npos, stage);
  }
  for (const auto& pass : compiler::compile_passes()) {
    at = listed.out.find('\n' + std::string(pass.name) + ' ', at);
    REQUIRE_MESSAGE(at != std::string::npos, std::string(pass.name));
    CHECK(listed.out.find(pass.description, at) != std::string::npos);
  }
  CHECK(listed.out.find("\ncnf ", at) < listed.out.find("\ncfg-dot ", at));
}

TEST_CASE("the help of compile names every pass") {
  const CliFixture cli;
  const auto help = cli.parallax({"compile", "--help"}).out;
  for (const auto& pass : compiler::compile_passes()) {
    CHECK_MESSAGE(help.find(pass.name) != std::string::npos, std::string(pass.name));
  }
}

TEST_CASE("--emit prints the value after every pass, the same each time") {
  const CliFixture cli;
  cli.write("lamp.e", kLamp);
  for (const auto& pass : compiler::compile_passes()) {
    const auto emit = "--emit=" + std::string(pass.name);
    CAPTURE(emit);
    const auto printed = cli.parallax({"compile", "lamp.e", emit});
    CHECK(printed.code == 0);
    CHECK(printed.err.empty());
    CHECK(!printed.out.empty());
    CHECK(cli.parallax({"compile", "lamp.e", emit}).out == printed.out);
    CHECK(cli.parallax({"compile", "lamp.e", emit, "-o", "value.txt"}).code == 0);
    CHECK(cli.read("value.txt") == printed.out);
  }
  const auto effects = cli.parallax({"compile", "lamp.e", "--emit=effects"}).out;
  CHECK(effects.find("lamp.e:5 effect axiom: Initiates(Press(),Lit(),time)\n") !=
        std::string::npos);
}

TEST_CASE("--emit=PASS of a model with errors prints nothing") {
  const CliFixture cli;
  cli.write("bad.e", "range time 0 1\nfluent F()\nHoldsAt(F(),0) & !HoldsAt(F(),0).\n");
  const auto refused = cli.parallax({"compile", "bad.e", "--emit=axioms"});
  CHECK(refused.code == 3);
  CHECK(refused.out.empty());
}

TEST_CASE("a compiled model has no passes, and compile needs a model") {
  const CliFixture cli;
  cli.write("lamp.e", kLamp);
  REQUIRE(cli.parallax({"compile", "lamp.e", "-o", "lamp.dec.cnf"}).code == 0);
  CHECK(cli.parallax({"compile", "lamp.dec.cnf", "--emit=effects"}).code == 2);
  CHECK(cli.parallax({"compile", "lamp.e", "--emit=nonsense"}).code == 2);
  CHECK(cli.parallax({"compile"}).code == 2);
  CHECK(cli.parallax({"compile", "--emit=cnf"}).code == 2);
}

TEST_CASE("a scenario's passes can be looked at as well") {
  const CliFixture cli;
  const auto printed = cli.parallax({"compile", "edge.yaml", "--emit=inertia"});
  CHECK(printed.code == 0);
  CHECK(printed.out.find(" frame axiom") != std::string::npos);
}

TEST_CASE("--stats shows time and size of every pass, the clock under `timing` in JSON") {
  const CliFixture cli;
  cli.write("lamp.e", kLamp);
  const auto stats = cli.parallax({"compile", "lamp.e", "--stats", "-o", "a.cnf"});
  for (const auto& pass : compiler::compile_passes()) {
    CHECK(stats.err.find('\n' + std::string(pass.name) + ' ') != std::string::npos);
  }
  const auto json = [&] {
    return without_timing(
        cli.parallax({"compile", "lamp.e", "--stats", "--json", "-o", "a.cnf"}).out);
  };
  const auto first = json();
  CHECK(first == json());
  for (const auto& pass : compiler::compile_passes()) {
    CHECK(first.find("{\"name\":\"" + std::string(pass.name) + "\"") != std::string::npos);
  }
}

}  // namespace
}  // namespace parallax::test
