// Formulas that come from outside the model: --property, --until, --why, constraints of a scenario.
// Each is one formula to its end, whatever stands in it.

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/tools/cli_json.h"

namespace parallax::test {
namespace {

// F holds at 0 and goes where E happens; G never holds. One trace for every timepoint of E.
constexpr const char* kModel =
    "range time 0 2\n"
    "sort thing\n"
    "thing A, B\n"
    "fluent F()\n"
    "fluent G()\n"
    "fluent On(thing)\n"
    "event E()\n"
    "[time] Terminates(E(),F(),time).\n"
    "HoldsAt(F(),0).\n"
    "!HoldsAt(G(),0).\n"
    "HoldsAt(On(A),0).\n"
    "!HoldsAt(On(B),0).\n";

bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

ProcessResult verify(const CliFixture& cli, const std::string& property) {
  cli.write("m.e", kModel);
  return cli.parallax({"verify", "m.e", "--property=" + property});
}

ProcessResult until(const CliFixture& cli, const std::string& formula) {
  cli.write("m.e", kModel);
  return cli.parallax({"traces", "m.e", "--until=" + formula, "--limit=0"});
}

/// A text that is no formula, and the place that the message points to.
struct Refused {
  std::string text;
  std::string place;
};

std::string nested(std::size_t depth) {
  return std::string(depth, '(') + "HoldsAt(F(),time)" + std::string(depth, ')');
}

std::vector<Refused> refused() {
  return {
      // The text leaves a bracket around it and comes back.
      {"HoldsAt(F(),time)) & (HoldsAt(F(),time)", ":1:18: error[E1006]"},
      {"HoldsAt(F(),time)) | (HoldsAt(F(),time)", ":1:18: error[E1006]"},
      {"HoldsAt(F(),time))", ":1:18: error[E1006]"},
      {"(HoldsAt(F(),time)", ":1:18: error[E1005]"},
      {"HoldsAt(F(),time", ":1:13-16: error[E1005]"},
      {")(", ":1:1: error[E1003]"},
      {"{thing} (HoldsAt(On(thing),time)) & (HoldsAt(F(),time)) | HoldsAt(G(),time))",
       ":1:76: error[E1006]"},
      // A second sentence.
      {"HoldsAt(F(),time). HoldsAt(G(),time)", ":1:20-26: error["},
      {"HoldsAt(F(),time). HoldsAt(G(),time).", ":1:20-26: error["},
      {"HoldsAt(F(),time)\nHoldsAt(G(),time)", ":2:1-7: error["},
      {"HoldsAt(F(),time)..", ":1:19: error["},
      // A comment does not close what is open before it.
      {"(HoldsAt(F(),time) ; )", ":1:18: error[E1005]"},
      {"!(HoldsAt(F(),time) ; x\n", ":1:19: error[E1005]"},
      // Statements of a model.
      {"load other.e", ":1:6-10: error["},
      {"fluent H()", ":1:8: error["},
      {"sort other", ":1:6-10: error["},
      {"completion Happens", ":1:12-18: error["},
      {"HoldsAt(F(),time)\nthing C", ":2:1-5: error["},
      {"label: HoldsAt(F(),time)", ":1:6: error["},
      // Variables that nothing binds, symbols that do not exist, terms.
      {"HoldsAt(On(thing),time)", ":1:12-16: error[E2102]"},
      {"{thing} HoldsAt(F(),time) -> HoldsAt(On(thing2),time)", ":1:41-46: error[E2102]"},
      {"HoldsAt(H(),time)", ":1:9: error[E2101]"},
      {"F()", ":1:1-3: error[E2106]"},
      {"1", ":1:1: error[E2106]"},
      {"HoldsAt(Fé(),time)", ":1:10: error[E1001]"},
      {"HoldsAt(F(),time) ∧ HoldsAt(G(),time)", ":1:19: error[E1020]"},
      {"“HoldsAt(F(),time)”", ":1:1: error[E1001]"},
  };
}

TEST_CASE("a property that closes the bracket around it is refused, not proved") {
  const CliFixture cli;
  const auto result = verify(cli, "HoldsAt(F(),time)) & (HoldsAt(F(),time)");
  CHECK(result.code == 3);
  CHECK(result.out == "");
  CHECK(result.err ==
        "--property:1:18: error[E1006]: `)` closes nothing\n"
        "    1 | HoldsAt(F(),time)) & (HoldsAt(F(),time)\n"
        "      |                  ^\n"
        "help: Remove it or add the opening bracket.\n");
}

TEST_CASE("what is no formula is refused in its own text, wherever it comes from") {
  const CliFixture cli;
  for (const auto& [text, place] : refused()) {
    CAPTURE(text);
    for (const auto* option : {"--property", "--until"}) {
      const auto result = option == std::string("--until") ? until(cli, text) : verify(cli, text);
      CAPTURE(result.err);
      CHECK(result.code == 3);
      CHECK(holds(result.err, option + place));
      CHECK(holds(result.err, " | "));
      CHECK(!holds(result.err, "made from the text"));
    }
  }
}

TEST_CASE("the negation of a property goes around all of it") {
  const CliFixture cli;
  struct Case {
    std::string property;
    int timepoint;  // of the violation; -1: it holds
  };
  const std::vector<Case> cases = {
      {"HoldsAt(F(),time)", 1},
      {"HoldsAt(F(),time).", 1},
      {"  HoldsAt(F(),time)  .  ", 1},
      {"HoldsAt(F(),time) ; ) as a comment", 1},
      {"; about F\nHoldsAt(F(),time)", 1},
      {"HoldsAt(F(),\n  time)", 1},
      {"!HoldsAt(G(),time) & HoldsAt(F(),time)", 1},
      {"!HoldsAt(G(),time) | HoldsAt(F(),time)", -1},
      {"HoldsAt(G(),time) -> HoldsAt(F(),time)", -1},
      {"HoldsAt(F(),time) -> HoldsAt(G(),time)", 0},
      {"HoldsAt(F(),time) <-> HoldsAt(G(),time)", 0},
      {"!!HoldsAt(F(),time)", 1},
      // A quantifier reaches to the end of the formula; the negation stands before it.
      {"{thing} HoldsAt(On(thing),time)", -1},
      {"[thing] HoldsAt(On(thing),time)", 0},
      {"![thing] HoldsAt(On(thing),time)", -1},
      {"!{thing} HoldsAt(On(thing),time)", 0},
      {"[thing] HoldsAt(On(thing),time) | HoldsAt(F(),time)", 1},
      {"{thing} HoldsAt(On(thing),time) & HoldsAt(F(),time)", 1},
      {"HoldsAt(G(),time) -> [thing] HoldsAt(On(thing),time)", -1},
      {"HoldsAt(F(),time) & {thing} !HoldsAt(On(thing),time)", 1},
      {"1 < 2", -1},
      {"1 = 2", 0},
      {nested(5000), 1},
  };
  for (const auto& [property, timepoint] : cases) {
    CAPTURE(property);
    const auto result = verify(cli, property);
    CAPTURE(result.err);
    if (timepoint < 0) {
      CHECK(result.code == 0);
      CHECK(result.out == "holds up to horizon 2 (proof checked)\n");
    } else {
      CHECK(result.code == 1);
      CHECK(result.out.starts_with("violated at timepoint " + std::to_string(timepoint) + "\n"));
    }
  }
}

TEST_CASE("a formula nested too deeply is refused with its limit") {
  const CliFixture cli;
  for (const auto& result : {verify(cli, nested(25'000)), until(cli, nested(25'000))}) {
    CHECK(result.code == 3);
    CHECK(holds(result.err, "error[E1009]"));
  }
}

TEST_CASE("an empty formula is a wrong use of the option") {
  const CliFixture cli;
  cli.write("m.e", kModel);
  for (const std::string text : {"", " ", "\n", "; only a comment", " \t; a\n ; b\n"}) {
    CAPTURE(text);
    const std::vector<std::pair<std::vector<std::string>, std::string>> commands = {
        {{"verify", "m.e", "--property", text}, "--property"},
        {{"verify", "scenario.yaml", "--property", text}, "--property"},
        {{"traces", "m.e", "--until", text}, "--until"},
        {{"compile", "m.e", "--until", text}, "--until"},
        {{"explain", "m.e", "--why", text}, "--why"}};
    for (const auto& [arguments, option] : commands) {
      const auto result = cli.parallax(arguments);
      CHECK(result.code == 2);
      CHECK(result.out == "");
      CHECK(holds(result.err, option + ": error[E0007]: the formula is empty"));
    }
  }
}

TEST_CASE("a fact that --why asks about is one atom") {
  const CliFixture cli;
  cli.write("m.e", kModel);
  const std::vector<Refused> facts = {
      {"HoldsAt(F(),0)) & (HoldsAt(G(),0)", "--why:1:15: error[E7305]"},
      {"HoldsAt(F(),0) & HoldsAt(G(),0)", "--why:1:1-31: error[E7305]"},
      {"HoldsAt(F(),0). HoldsAt(G(),0).", "--why:1:17-23: error[E7305]"},
      {"!(HoldsAt(F(),0)", "--why:1:16: error[E7305]"},
      {"[time] HoldsAt(F(),time)", "--why:1:1-24: error[E7305]"},
      {"HoldsAt(F(),0,1)", "--why:1:1-16: error[E7305]"},
      {"HoldsAt(F(),time)", "--why:1:1-17: error[E7305]"},
      {"!HoldsAt(H(),0)", "--why:1:2-15: error[E7305]"},
      {nested(25'000), "error[E7305]"}};
  for (const auto& [text, place] : facts) {
    CAPTURE(text);
    const auto result = cli.parallax({"explain", "m.e", "--why", text});
    CAPTURE(result.err);
    CHECK(result.code == 2);
    CHECK(holds(result.err, place));
  }
  for (const auto* text : {"HoldsAt(F(),0)", "HoldsAt( F , 0 ).", "(HoldsAt(F(),0))",
                           "!!HoldsAt(F(),0)", "HoldsAt(F(),0) ; at the start"}) {
    const auto result = cli.parallax({"explain", "m.e", "--why", text});
    CHECK(result.code == 0);
    CHECK(holds(result.out, "F() holds at 0 in trace 1"));
  }
}

TEST_CASE("constraints of a scenario and of a suite are formulas of their own") {
  const CliFixture cli;
  cli.replace("scenario.yaml", "HoldsAt(BoxIn(region),time))\"",
              "HoldsAt(BoxIn(region),time))) & (HoldsAt(BoxIn(r1),time)\"");
  const auto scenario = cli.parallax({"check", "scenario.yaml"});
  CHECK(scenario.code == 3);
  CHECK(holds(scenario.err, "error[E1006]: `)` closes nothing"));
  cli.write("m.e", kModel);
  cli.write("suite.yaml",
            "cases:\n"
            "  - {id: torn, model: m.e, constraints: ['HoldsAt(F(),time)) & (HoldsAt(F(),time)'],\n"
            "     expect: {traces: 1}}\n"
            "  - {id: flag, model: m.e, constraints: ['--count'], expect: {traces: 1}}\n"
            "  - {id: good, model: m.e, constraints: ['-1 < 0 & !HoldsAt(F(),time)'],\n"
            "     expect: {traces: 2}}\n");
  const auto suite = cli.parallax({"suite", "suite.yaml"});
  CHECK(suite.code == 1);
  CHECK(suite.out.ends_with("\n1 passed, 0 failed, 2 without an answer\n"));
  CHECK(holds(suite.err, "ok    suite.yaml:good"));
  CHECK(holds(suite.out, "E1006: `)` closes nothing"));
  CHECK(holds(suite.out, "E2106: expected a formula, found the term `--count`"));
}

}  // namespace
}  // namespace parallax::test
