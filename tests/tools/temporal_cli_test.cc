// Temporal formulas on the command line, in suites and scenarios: docs/reference/model_language.md.

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/tools/cli_json.h"

namespace parallax::test {
namespace {

// F holds at 0 and goes where E happens; G never holds.
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

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

ProcessResult verify(const CliFixture& cli, const std::string& property) {
  cli.write("m.e", kModel);
  return cli.parallax({"verify", "m.e", "--check", "--property=" + property});
}

TEST_CASE("what the operators say of the traces of a model") {
  const CliFixture cli;
  struct Case {
    std::string property;
    int timepoint;  // at which the shortest violation ends; -1: it holds
  };
  const std::vector<Case> cases = {
      {"always HoldsAt(F(),time)", 1},
      {"eventually HoldsAt(F(),time)", -1},
      {"eventually !HoldsAt(F(),time)", 2},
      {"next HoldsAt(F(),time)", 1},
      {"weak_next HoldsAt(F(),time)", 1},
      {"next next (0=0)", -1},
      {"next next next (0=0)", 2},
      {"weak_next weak_next weak_next (0=1)", -1},
      {"weak_next weak_next (0=1)", 2},
      {"always (Happens(E(),time) -> next !HoldsAt(F(),time))", -1},
      {"always (Happens(E(),time) -> next HoldsAt(F(),time))", 1},
      {"always (Happens(E(),time) -> HoldsAt(F(),time))", 2},
      {"eventually Happens(E(),time)", 2},
      {"HoldsAt(F(),time) until HoldsAt(G(),time)", 1},
      {"HoldsAt(F(),time) until Happens(E(),time)", 2},
      {"(HoldsAt(F(),time) until Happens(E(),time)) | always HoldsAt(F(),time)", -1},
      {"historically HoldsAt(F(),time)", 1},
      {"once HoldsAt(F(),time)", -1},
      {"previously HoldsAt(F(),time)", 0},
      {"!previously !HoldsAt(F(),time)", 2},
      {"!HoldsAt(F(),time) -> once Happens(E(),time)", -1},
      {"!HoldsAt(F(),time) -> previously Happens(E(),time)", 2},
      {"!HoldsAt(F(),time) -> !HoldsAt(G(),time) since Happens(E(),time)", -1},
      {"[thing] always HoldsAt(On(thing),time)", 0},
      {"{thing} always HoldsAt(On(thing),time)", -1},
      {"always HoldsAt(F(),time) | eventually !HoldsAt(F(),time)", -1},
      // Where a timepoint before 0 is named, an instance says nothing.
      {"always (Happens(E(),time-1) -> !HoldsAt(F(),time))", -1},
      {"always Happens(E(),time-1)", 1},
      // Tighter than `&`, `|` and `->`.
      {"always HoldsAt(G(),time) & HoldsAt(F(),time) -> HoldsAt(G(),time)", -1},
      {"HoldsAt(F(),time) until !HoldsAt(F(),time) | HoldsAt(F(),time)", -1},
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
      CHECK(result.out.starts_with("violated at timepoint " + std::to_string(timepoint) + "\n`"));
    }
  }
}

TEST_CASE("a counterexample names the part that breaks, and where") {
  const CliFixture cli;
  auto result = verify(cli, "always (Happens(E(),time) -> next\n  HoldsAt(F(),time))");
  CHECK(has(result.out, "\n`HoldsAt(F(),time)` does not hold at timepoint 1\n"));
  result = verify(cli, "always (HoldsAt(F(),time) -> eventually Happens(E(),time))");
  CHECK(has(result.out,
            "\n`eventually Happens(E(),time)` is not met from timepoint 0 to the end, "
            "timepoint 2\n"));
  result = verify(cli, "HoldsAt(F(),time) until HoldsAt(G(),time)");
  CHECK(has(result.out, "\n`HoldsAt(F(),time)` does not hold at timepoint 1, and what it should"));
  const auto answer = json_of(
      cli, {"verify", "m.e", "--property", "always HoldsAt(F(),time) & once HoldsAt(F(),time)"}, 1);
  CHECK(answer["timepoint"] == 1);
  CHECK(answer["broken"]["formula"] == "HoldsAt(F(),time)");
  CHECK(answer["broken"]["timepoint"] == 1);
}

TEST_CASE("what is no temporal formula is refused where it stands") {
  const CliFixture cli;
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"allways HoldsAt(F(),time)", ":1:1-7: error[E1023]"},
      {"G HoldsAt(F(),time)", ":1:1: error[E1023]"},
      {"HoldsAt(F(),time) U HoldsAt(G(),time)", ":1:19: error[E1023]"},
      {"HoldsAt(F(),time) untill HoldsAt(G(),time)", ":1:19-24: error[E1023]"},
      {"until HoldsAt(F(),time)", ":1:1-5: error[E1003]"},
      {"HoldsAt(F(),time) until", "error[E1003]"},
      {"always", ":1:1-6: error["},
      {"always ()", "error[E1003]"},
      {"HoldsAt(F(),time) always", ":1:19-24: error[E1004]"},
      {"always HoldsAt(F(),time) HoldsAt(G(),time)", ":1:26-32: error[E1004]"},
      {"HoldsAt(F(),time) until HoldsAt(G(),time) until HoldsAt(F(),time)",
       ":1:43-47: error[E1021]"},
      {"HoldsAt(F(),time) since HoldsAt(G(),time) until HoldsAt(F(),time)",
       ":1:43-47: error[E1021]"},
      {"HoldsAt(always F(),time)", ":1:9-18: error[E2107]"},
      {"HoldsAt(F() until G(),time)", ":1:9-21: error[E2107]"},
      {"always F()", ":1:8-10: error[E2106]"},
      {"always 1=1", ":1:1-8: error[E2107]"},
      {"[time] always HoldsAt(F(),time)", ":1:8-31: error[E2306]"},
      {"always [time1] once HoldsAt(F(),time1)", ":1:16-38: error[E2306]"},
      {"{time1} (HoldsAt(F(),time1) until HoldsAt(G(),time))", ":1:10-51: error[E2306]"},
      {"always HoldsAt(F(),time1)", ":1:20-24: error[E2102]"},
      {"always HoldsAt(F(),time+1)", ":1:8-26: error[E3013]"},
      {"eventually Happens(E(),time+1)", ":1:12-30: error[E3013]"},
      {"always HoldsAt(H(),time)", ":1:16: error[E2101]"},
  };
  for (const auto& [text, place] : cases) {
    CAPTURE(text);
    cli.write("m.e", kModel);
    for (const std::string option : {"--property", "--until"}) {
      const auto result =
          cli.parallax({option == "--until" ? "traces" : "verify", "m.e", option + "=" + text});
      CAPTURE(result.err);
      CHECK(result.code == 3);
      CHECK(result.out.empty());
      CHECK(has(result.err, place));
      CHECK(result.err.find("error[") == result.err.rfind("error["));
    }
  }
}

TEST_CASE("axioms and weights of starts have no temporal operators") {
  const CliFixture cli;
  for (const std::string axiom :
       {"[thing] always HoldsAt(On(thing),0).", "HoldsAt(F(),0) until HoldsAt(G(),1)."}) {
    cli.write("bad.e", kModel + axiom + "\n");
    const auto result = cli.parallax({"check", "bad.e"});
    CHECK(result.code == 3);
    CHECK(has(result.err, "error[E1022]"));
  }
}

TEST_CASE("a constant may have the name of an operator") {
  const CliFixture cli;
  cli.write("named.e",
            "range time 0 2\nsort place\nplace next, once\nfluent At(place)\n"
            "[place,time] !HoldsAt(At(place),time) | HoldsAt(At(place),0).\n"
            "HoldsAt(At(next),0).\n!HoldsAt(At(once),0).\n");
  const auto result = cli.parallax(
      {"verify", "named.e", "--property",
       "always next = next | always (HoldsAt(At(next),time) & !once HoldsAt(At(once),time))"});
  CHECK(result.code ==
        3);  // `always next` is an operator without a formula: brackets say what is meant
  const auto fine = cli.parallax({"verify", "named.e", "--property",
                                  "always (next = next & HoldsAt(At(next),time) & "
                                  "!once HoldsAt(At(once),time))"});
  CHECK(fine.out == "holds up to horizon 2 (proof checked)\n");
}

TEST_CASE("traces end where a temporal goal is met") {
  const CliFixture cli;
  cli.write("m.e", kModel);
  const auto traces = [&](const std::string& goal) {
    return json_of(cli, {"traces", "m.e", "--limit=0", "--until=" + goal});
  };
  // F goes at 1 or at 2.
  const auto state = traces("!HoldsAt(F(),time)");
  CHECK(state["traces"] == 2);
  CHECK(traces("eventually !HoldsAt(F(),time)")["traces"] == state["traces"]);
  CHECK(traces("once !HoldsAt(F(),time)")["traces"] == state["traces"]);
  CHECK(traces("next (0=0)")["traces"] == 2);
  CHECK(traces("HoldsAt(G(),time) since HoldsAt(F(),time)")["traces"] == 1);  // at once
  CHECK(traces("previously previously HoldsAt(F(),time)")["traces"] == 4);
}

TEST_CASE("a property of the paths of a plan speaks of paths that have ended") {
  const CliFixture cli;
  const auto verify_plan = [&](const std::string& property, const std::string& horizon) {
    return cli.parallax({"verify", "domain.e", "start.e", "--plan", "fetch.lisp", "--bind",
                         "robot.bind", "--regions", "scenario.yaml", "--horizon", horizon,
                         "--check", "--property", property});
  };
  auto result = verify_plan("eventually HoldsAt(Holding(),time)", "6");
  CHECK(result.code == 0);
  CHECK(has(result.out, "every path of the plan has ended"));
  result =
      verify_plan("always (HoldsAt(Holding(),time) -> eventually HoldsAt(BoxIn(r1),time))", "6");
  CHECK(result.code == 0);
  // The horizon cuts the plan before it has brought the box: that refutes nothing.
  result = verify_plan("eventually HoldsAt(BoxIn(r1),time)", "3");
  CHECK(result.code == 0);
  CHECK(has(result.out, "holds up to horizon 3"));
  CHECK(!has(result.out, "has ended"));
  result = verify_plan("eventually (HoldsAt(Holding(),time) & HoldsAt(BoxIn(r1),time))", "6");
  CHECK(result.code == 1);
  CHECK(has(result.out, "is not met from timepoint 0 to the"));
}

TEST_CASE("a case of a suite expects properties") {
  const CliFixture cli;
  cli.write("m.e", kModel);
  cli.write("suite.yaml",
            "cases:\n"
            "  - {id: good, model: m.e, expect: {holds: 'eventually HoldsAt(F(),time)',\n"
            "     violated: ['always HoldsAt(F(),time)', '!HoldsAt(F(),time)']}}\n"
            "  - {id: both, model: m.e, expect: {traces: 4, holds: '-1 < 0'}}\n"
            "  - {id: broken, model: m.e, expect: {holds: 'always HoldsAt(F(),time)'}}\n"
            "  - {id: kept, model: m.e, expect: {violated: 'once HoldsAt(F(),time)'}}\n"
            "  - {id: wrong, model: m.e, expect: {holds: 'allways HoldsAt(F(),time)'}}\n");
  const auto suite = cli.parallax({"suite", "suite.yaml"});
  CHECK(suite.code == 1);
  CHECK(suite.out.ends_with("\n2 passed, 2 failed, 1 without an answer\n"));
  CHECK(has(suite.err, "ok    suite.yaml:good"));
  CHECK(has(suite.out, "expected to hold: always HoldsAt(F(),time)"));
  CHECK(has(suite.out, "`HoldsAt(F(),time)` does not hold at timepoint 1"));
  CHECK(has(suite.out, "expected to be violated: once HoldsAt(F(),time)"));
  CHECK(has(suite.out, "E1023: there is no operator `allways`"));
}

}  // namespace
}  // namespace parallax::test
