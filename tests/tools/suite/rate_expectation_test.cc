// Cases that pass only on evidence, and only for the expected cause, as real processes.

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "tests/tools/cli_json.h"
#include "tests/tools/two_models.h"

namespace parallax::test {
namespace {

using Json = nlohmann::json;

bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// The drawer that sticks every other time, with the given expectation.
class Sticking : public TwoModels {
 public:
  void expect(const std::string& what) const {
    write("two/case.yaml",
          "include: common.yaml\nmodel: [opens.e, start.e]\nsimulator: {model: sticks.e}\n"
          "expect: " +
              what + "\n");
  }
  /// Problems that the suite reports for the expectation; empty if it passes.
  std::string problems(const std::string& what) const {
    expect(what);
    const auto result = parallax({"suite", "two/case.yaml", "--json", "--no-cache"});
    CAPTURE(result.out);
    const auto document = Json::parse(result.out);
    std::string out;
    for (const auto& problem : document["cases"][0]["problems"]) {
      out += problem.get<std::string>() + "\n";
    }
    CHECK(result.code == (out.empty() ? 0 : 1));
    return out;
  }
  /// Why `check` and the suite refuse it, at which place.
  std::string refusal(const std::string& what) const {
    expect(what);
    const auto checked = parallax({"check", "two/case.yaml"});
    CHECK(checked.code == 3);
    const auto suite = parallax({"suite", "two/case.yaml", "--json"});
    CHECK(suite.code == 1);
    CHECK(Json::parse(suite.out)["errors"] == 1);
    CHECK(holds(suite.out, "can never hold"));
    return checked.err;
  }
};

TEST_CASE("a rate is as expected only where the runs show it") {
  const Sticking cli;
  CHECK(cli.problems("{rate: {above: 0.3, confidence: 0.99}}").empty());
  CHECK(cli.problems("{rate: {below: 0.7, confidence: 0.99}}").empty());
  CHECK(cli.problems("{rate: {between: [0.4, 0.6], confidence: 0.95, runs: 500}}").empty());
  CHECK(holds(cli.problems("{rate: {below: 0.3}}"),
              "with 95 % confidence the rate is not below 30 %"));
  CHECK(holds(cli.problems("{rate: {between: [0.1, 0.3], confidence: 0.95}}"),
              "the rate is not from 10 to 30 %"));
  // Ten runs meet nearly any interval; asked for evidence, they have too little.
  CHECK(cli.problems("{rate: {between: [0.1, 0.6], runs: 20}}").empty());
  const auto few = cli.problems("{rate: {below: 0.7, confidence: 0.99, runs: 20}}");
  CHECK(holds(few, "not enough evidence that the rate is below 70 % with 99 % confidence"));
  CHECK(holds(few, "runs would tell if it stays like this"));
}

TEST_CASE("as many runs as would have been enough are enough") {
  const Sticking cli;
  const auto few = cli.problems("{rate: {below: 0.65, confidence: 0.95, runs: 20}}");
  const auto at = few.find("; ");
  REQUIRE(at != std::string::npos);
  const auto runs = std::stoi(few.substr(at + 2));
  CHECK(runs > 20);
  CHECK(cli.problems("{rate: {below: 0.65, confidence: 0.95, runs: " + std::to_string(4 * runs) +
                     "}}")
            .empty());
}

TEST_CASE("runs end as soon as they tell, and it is said how many they were") {
  const Sticking cli;
  const auto runs_behind = [](const std::string& text, const std::string& words) {
    const auto at = text.find(words);
    return at == std::string::npos ? 0 : std::stoi(text.substr(at + words.size()));
  };
  cli.expect("{rate: {above: 0.3, confidence: 0.99, max_runs: 1000}}");
  const auto passed = cli.parallax({"suite", "two/case.yaml"});
  CHECK(passed.code == 0);
  const int shown = runs_behind(passed.err, ", shown by ");
  CHECK(shown > 20);
  CHECK(shown < 300);
  CHECK(holds(cli.parallax({"suite", "two/case.yaml"}).err, "(cached), shown by"));
  const auto refuted = cli.problems("{rate: {below: 0.3, max_runs: 1000}}");
  CHECK(holds(refuted, "with 95 % confidence the rate is not below 30 %"));
  CHECK(runs_behind(refuted, " of ") < 300);
  CHECK(cli.problems("{rate: {between: [0.3, 0.7], max_runs: 2000}}").empty());
  const auto open = cli.problems("{rate: {below: 0.52, max_runs: 60}}");
  CHECK(holds(open, "of 60 runs"));
  CHECK(holds(open, "not enough evidence that the rate is below 52 %"));
  CHECK(holds(cli.refusal("{rate: {below: 0.01, max_runs: 50}}"),
              "whatever 50 runs come to, they do not show with 95 % confidence that the rate is "
              "below 1 %"));
  cli.expect("{rate: {below: 0.1, runs: 50, max_runs: 60}}");
  CHECK(holds(cli.parallax({"check", "two/case.yaml"}).err, "two numbers of runs"));
}

TEST_CASE("how many runs tell does not depend on how many are made at once") {
  const Sticking cli;
  const auto rates = [&](const std::string& jobs) {
    return cli.parallax({"rates", "two/sticks.yaml", "--until-above", "0.3", "--until-below", "0.7",
                         "--jobs", jobs});
  };
  const auto one = rates("1"), three = rates("3");
  CHECK(one.code == 0);
  CHECK(one.out == three.out);
  CHECK_MESSAGE(holds(one.out, "it is from 30 to 70 % (with 95 % confidence)"), one.out);
  CHECK(holds(one.out, "valid whenever one looks"));
  CHECK(cli.parallax({"rates", "two/sticks.yaml", "--until-above", "0.7", "--until-below", "0.3"})
            .code == 2);
}

TEST_CASE("a discrepancy with another cause is not the one that is expected") {
  const Sticking cli;
  const std::string rate = "rate: {above: 0.3, cause: ";
  CHECK(cli.problems("{" + rate + "{event: OpenDrawer(top), fluent: Open(top), kind: random}}}")
            .empty());
  const auto event = cli.problems("{" + rate + "{event: CloseDrawer(top)}}}");
  CHECK(holds(event, "the cause is `OpenDrawer(top): not Open(top)`"));
  CHECK(holds(event, "expected the event CloseDrawer(top)"));
  CHECK(holds(cli.problems("{" + rate + "{fluent: Parked()}}}"), "expected the fluent Parked()"));
  CHECK(holds(cli.problems("{" + rate + "{kind: always}}}"), "and its kind random"));
  CHECK(holds(cli.problems("{" + rate + "{reason: stuck}}}"), "expected the reason stuck"));

  CHECK(cli.problems("{cause: {event: OpenDrawer(top), fluent: Open(top), kind: random}}").empty());
  CHECK(holds(cli.problems("{cause: {fluent: Parked()}}"),
              "the cause is `OpenDrawer(top): not Open(top)`, expected the fluent Parked()"));
  CHECK(holds(cli.problems("{cause: {kind: region}}"), "the kind of cause is random"));
  cli.replace("two/sticks.e", "!HoldsAt(Sticks(),time) -> ", "");
  CHECK(holds(cli.problems("{cause: {event: OpenDrawer(top)}}"),
              "no discrepancy, expected one with the event OpenDrawer(top)"));
}

TEST_CASE("what no outcome can meet is refused where it stands") {
  const Sticking cli;
  const auto few = cli.refusal("{rate: {below: 0.01, runs: 50}}");
  CHECK(holds(few, "two/case.yaml:4:36"));
  CHECK(holds(few,
              "whatever 50 runs come to, they do not show with 95 % confidence that the rate "
              "is below 1 %; 299 can"));
  CHECK(holds(cli.refusal("{rate: {between: [0.5, 0.5], confidence: 0.9}}"), "1000000 runs"));
  CHECK(holds(cli.refusal("{rate: {between: [0.49, 0.51], confidence: 0.9, runs: 100}}"),
              "100 runs"));
  CHECK(holds(cli.refusal("{verdict: no-discrepancy, fluents: [Open(top)]}"), "nothing diverges"));
  CHECK(holds(cli.refusal("{verdict: inconclusive, cause: {event: Park()}}"), "nothing diverges"));
  CHECK(holds(cli.refusal("{verdict: discrepancy, max_simulations: 0}"), "without a simulation"));
  CHECK(holds(cli.refusal("{verdict: no-discrepancy, max_simulations: 89}"), "90 simulations"));
  CHECK(holds(cli.refusal("{verdict: no-discrepancy}\nlimits: {max_runs: 89}"), "90 clean runs"));
  CHECK(holds(cli.refusal("{iterations: 3}\nlimits: {max_traces: 2}"), "`max_traces` is 2"));
}

TEST_CASE("expectations that are no expectations are refused where they stand") {
  const Sticking cli;
  const auto complaint = [&](const std::string& what) {
    cli.expect(what);
    const auto result = cli.parallax({"check", "two/case.yaml"});
    CHECK(result.code == 3);
    return result.err;
  };
  CHECK(holds(complaint("{rate: {below: 0.1, above: 0.05}}"), "bounded twice"));
  CHECK(holds(complaint("{rate: {below: 0}}"), "below"));
  CHECK(holds(complaint("{rate: {below: 1.5}}"), "below"));
  CHECK(holds(complaint("{rate: {between: [0, 1], confidence: 0.9}}"), "every rate lies there"));
  CHECK(holds(complaint("{rate: {below: 0.1, confidence: 1}}"), "confidence"));
  CHECK(holds(complaint("{rate: {below: 0.1, confidenc: 0.9}}"), "`confidence`"));
  CHECK(holds(complaint("{cause: {}}"), "expects nothing"));
  CHECK(holds(complaint("{cause: {kind: luck}}"), "`luck` is not a known kind of cause"));
  CHECK(holds(complaint("{cause: {event: OpenDrawr(top)}}"), "no event of the model"));
  CHECK(holds(complaint("{cause: {event: OpenDrawr(top)}}"), "OpenDrawer(top)"));
  CHECK(holds(complaint("{rate: {above: 0.1, cause: {fluent: Ope(top)}}}"),
              "no fluent of the model"));
  CHECK(holds(complaint("{cause: [Open(top)]}"), "cause"));
}

TEST_CASE("a red case says which event, fluent and axiom") {
  const Sticking cli;
  cli.replace("two/unparks.yaml", "verdict: discrepancy", "verdict: no-discrepancy");
  cli.replace("two/unparks.yaml", "max_simulations: 1, fluents: [Parked()], ", "");
  const auto result = cli.parallax({"suite", "two/unparks.yaml", "--junit", "r.xml"});
  CHECK(result.code == 1);
  CAPTURE(result.err);
  CHECK(holds(result.out, "OpenDrawer(top)"));
  CHECK(holds(result.out, "Parked()"));
  CHECK(holds(result.out, "two/domain.e:"));
  CHECK(holds(cli.read("r.xml"), "two/domain.e:"));
}

}  // namespace
}  // namespace parallax::test
