// Each bad input gets one clear located message and the right exit code.

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "tests/tools/cli_fixture.h"

namespace parallax::test {
namespace {

void check_message(const ProcessResult& result, int code, const std::string& place,
                   const std::string& text) {
  CAPTURE(result.err);
  CHECK(result.code == code);
  CHECK(result.out.empty());
  CHECK(result.err.find(place) != std::string::npos);
  CHECK(result.err.find(text) != std::string::npos);
}

TEST_CASE("missing files") {
  const CliFixture cli;
  check_message(cli.parallax({"run", "nowhere.yaml"}), 2, "nowhere.yaml", "cannot open");
  cli.replace("scenario.yaml", "fetch.lisp", "fetsch.lisp");
  check_message(cli.parallax({"run", "scenario.yaml"}), 3, "scenario.yaml:8", "fetsch.lisp");
}

TEST_CASE("a misspelt key is answered with the nearest one") {
  const CliFixture cli;
  cli.replace("scenario.yaml", "horizon:", "horizn:");
  check_message(cli.parallax({"run", "scenario.yaml"}), 3, "scenario.yaml:10", "`horizon`");
}

TEST_CASE("regions with a gap, an overlap or reversed bounds") {
  const CliFixture cli;
  SUBCASE("gap") {
    cli.replace("common.yaml", "r1: {x: [0, 1]}", "r1: {x: [0, 0.9]}");
    check_message(cli.parallax({"run", "scenario.yaml"}), 3, "common.yaml:", "0.9");
  }
  SUBCASE("overlap") {
    cli.replace("common.yaml", "r1: {x: [0, 1]}", "r1: {x: [0, 1.2]}");
    check_message(cli.parallax({"run", "scenario.yaml"}), 3, "common.yaml:", "`r2`");
  }
  SUBCASE("reversed") {
    cli.replace("common.yaml", "r1: {x: [0, 1]}", "r1: {x: [1, 0]}");
    check_message(cli.parallax({"run", "scenario.yaml"}), 3, "common.yaml:", "r1");
  }
}

TEST_CASE("a fluent without a mapping and an event without an action") {
  const CliFixture cli;
  SUBCASE("fluent") {
    cli.replace("common.yaml", "  Holding(): {flag: box.held}\n", "");
    check_message(cli.parallax({"run", "scenario.yaml"}), 3, "common.yaml:", "Holding");
  }
  SUBCASE("event") {
    cli.replace("common.yaml",
                "  PickUp(): {controller: picking-up, object: box, time_limit_s: 30}\n", "");
    check_message(cli.parallax({"run", "scenario.yaml"}), 3, "common.yaml:", "PickUp");
  }
  SUBCASE("action without a controller") {
    cli.replace("common.yaml", "{controller: going, time_limit_s: 30}", "{time_limit_s: 30}");
    check_message(cli.parallax({"run", "scenario.yaml"}), 3, "common.yaml:", "controller");
  }
  SUBCASE("unknown controller") {
    cli.replace("common.yaml", "controller: going", "controller: gooing");
    check_message(cli.parallax({"run", "scenario.yaml"}), 3, "common.yaml:", "`going`");
  }
}

TEST_CASE("start states that always interpenetrate end after a bounded number of draws") {
  const CliFixture cli;
  // A fixed block where the box starts.
  cli.replace("world.yaml", "bodies:\n",
              "bodies:\n  block: {size_m: [1.2, 0.2, 0.3], position_m: [1.5, 0, 0.15]}\n");
  const auto result = cli.parallax({"run", "scenario.yaml", "--out", "run"});
  check_message(result, 3, "common.yaml", "block");
  CHECK(result.err.find("box") != std::string::npos);
}

TEST_CASE("an unsatisfiable model is blamed on the axioms that clash") {
  const CliFixture cli;
  cli.write("start.e", "HoldsAt(RobotIn(r1),0).\nHoldsAt(BoxIn(r2),0).\nHoldsAt(BoxIn(r1),0).\n");
  const auto result = cli.parallax({"run", "scenario.yaml", "--out", "run"});
  check_message(result, 3, "start.e:2", "contradict");
  CHECK(result.err.find("start.e:3") != std::string::npos);
  CHECK(result.err.find("start.e:1") == std::string::npos);
}

TEST_CASE("a plan that never meets the constraints leaves the question open, it is no clean bill") {
  const CliFixture cli;
  // With the right model the hasty plan's pick-up fails.
  cli.replace("wrong_model.yaml", "wrong_domain.e", "domain.e");
  const auto result = cli.parallax({"run", "wrong_model.yaml", "--out", "run"});
  CAPTURE(result.err);
  CHECK(result.code == 4);
  CHECK(result.err.find("W7002") != std::string::npos);
}

TEST_CASE("a simulator that dies or hangs is told apart from a failing action") {
  const CliFixture cli;
  const auto with_command = [&](const std::string& command) {
    cli.write("lost.yaml", "include: scenario.yaml\nsimulator: {command: " + command +
                               ", hello_timeout_s: 1, reset_timeout_s: 1}\n");
    return cli.parallax({"run", "lost.yaml", "--out", "run"});
  };
  SUBCASE("it cannot be started") {
    const auto result = with_command("[./no-such-simulator]");
    CAPTURE(result.err);
    CHECK(result.code == 4);
    CHECK(result.err.find("no-such-simulator") != std::string::npos);
  }
  SUBCASE("it dies at once") {
    const auto result = with_command("[sh, -c, 'echo broken >&2; exit 7']");
    CAPTURE(result.err);
    CHECK(result.code == 4);
    CHECK(result.err.find("7") != std::string::npos);
    CHECK(result.err.find("broken") != std::string::npos);
  }
  SUBCASE("it hangs") {
    const auto result = with_command("[sleep, '1000']");
    CAPTURE(result.err);
    CHECK(result.code == 4);
  }
  SUBCASE("it talks nonsense") {
    const auto result = with_command("[yes]");
    CAPTURE(result.err);
    CHECK(result.code == 4);
  }
}

TEST_CASE("usage errors exit with 2 and suggest what was meant") {
  const CliFixture cli;
  check_message(cli.parallax({"run", "scenario.yaml", "--sed", "3"}), 2, "--sed", "`--seed`");
  check_message(cli.parallax({"rnu", "scenario.yaml"}), 2, "rnu", "`run`");
  check_message(cli.parallax({}), 2, "parallax", "--help");
  CHECK(cli.parallax({"--help"}).code == 0);
  CHECK(cli.parallax({"run", "--help"}).out.find("--resume") != std::string::npos);
  CHECK(cli.parallax({"--version"}).out.find("parallax ") == 0);
}

TEST_CASE("with --json a failing command still prints exactly one document") {
  const CliFixture cli;
  for (const auto& arguments :
       std::vector<std::vector<std::string>>{{"run", "nowhere.yaml", "--json"},
                                             {"run", "scenario.yaml", "--jsn", "--json"},
                                             {"check", "nowhere.e", "--json"},
                                             {"replay", "nowhere", "--json"},
                                             {"traces", "start.e", "--json"}}) {
    const auto result = cli.parallax(arguments);
    CAPTURE(result.out);
    REQUIRE(nlohmann::json::accept(result.out));
    const auto document = nlohmann::json::parse(result.out);
    CHECK(document["status"] == "error");
    CHECK(!document["diagnostics"].empty());
    CHECK(result.code != 0);
  }
}

TEST_CASE("several errors of one run are reported together") {
  const CliFixture cli;
  cli.replace("domain.e", "Initiates(Go(region),RobotIn(region),time)",
              "Initiates(Go(region),RobotInn(region),time)");
  cli.replace("domain.e", "HoldsAt(Holding(),time) | {region}",
              "HoldsAt(Holdin(),time) | {region}");
  const auto result = cli.parallax({"check", "domain.e", "start.e", "--horizon", "3"});
  CAPTURE(result.err);
  CHECK(result.code == 3);
  CHECK(result.err.find("`RobotIn`") != std::string::npos);
  CHECK(result.err.find("`Holding`") != std::string::npos);
}

TEST_CASE("limits end a run with 4") {
  const CliFixture cli;
  const auto result =
      cli.parallax({"run", "scenario.yaml", "--out", "run", "--time-limit", "0.3", "--json"});
  CAPTURE(result.out);
  CHECK(result.code == 4);
  CHECK(nlohmann::json::accept(result.out));
  const auto capped = cli.parallax({"run", "scenario.yaml", "--out", "run2", "--max-runs", "5"});
  CHECK(capped.code == 4);
  CHECK(capped.out.find("inconclusive") != std::string::npos);
}

/// The program with its streams redirected by a shell.
ProcessResult with_streams(const CliFixture& cli, const std::string& arguments) {
  ProcessOptions options;
  options.folder = cli.folder().string();
  return run_process({"sh", "-c", "exec " PARALLAX_BINARY_DIR "/parallax " + arguments}, options);
}

TEST_CASE("a command that is none is named, with the one that may be meant") {
  const CliFixture cli;
  const auto far = cli.parallax({"frobnicate"});
  CHECK(far.code == 2);
  CHECK(far.err.find("there is no command `frobnicate`") != std::string::npos);
  const auto near = cli.parallax({"repiar", "out"});
  CHECK(near.err.find("there is no command `repiar`") != std::string::npos);
  CHECK(near.err.find("replace `repiar` with `repair`") != std::string::npos);
  CHECK(cli.parallax({}).err.find("A subcommand is required") != std::string::npos);
}

TEST_CASE("streams that are full or closed cost the text, not the program") {
  const CliFixture cli;
  const auto full = with_streams(cli, "traces scenario.yaml >/dev/full");
  CHECK(full.code == 2);
  CHECK(full.err.find("standard output") != std::string::npos);
  CHECK(with_streams(cli, "check scenario.yaml --json >/dev/full").code == 2);
  CHECK(with_streams(cli, "run nowhere.yaml 2>/dev/full").code == 2);
  // An explanation that was not searched for, as nobody would see it, has no message of its own.
  cli.write("no.e", "fluent F()\n\nHoldsAt(F(),0).\n!HoldsAt(F(),0).\n");
  const auto explained = with_streams(cli, "explain no.e --horizon 2 >/dev/full");
  CHECK(explained.code == 2);
  CHECK(explained.err.find("standard output") != std::string::npos);
  CHECK(explained.err.find("E7306") == std::string::npos);
  CHECK(with_streams(cli, "check scenario.yaml 2>&-").code == 0);
  const auto head = with_streams(cli, "traces start.e domain.e --horizon 3 --limit 0 | head -2");
  CHECK(head.code == 0);
}

TEST_CASE("options that are no numbers of their kind are refused") {
  const CliFixture cli;
  for (const auto& option :
       std::vector<std::vector<std::string>>{{"--confidence", "nan"},
                                             {"--epsilon", "nan"},
                                             {"--time-limit", "1e300"},
                                             {"--seed", "-1"},
                                             {"--seed", ""},
                                             {"--seed", "18446744073709551616"},
                                             {"--jobs", "0"},
                                             {"--max-runs", "2.5"}}) {
    CAPTURE(option[0]);
    CAPTURE(option[1]);
    const auto result = cli.parallax({"run", "scenario.yaml", option[0], option[1]});
    CHECK(result.code == 2);
  }
}

TEST_CASE("what is wrong with a substituted formula is told at the binding table") {
  const CliFixture cli;
  cli.replace("robot.bind", "ok: Holding() @t+1", "ok: Hold() @t+1");
  const auto result = cli.parallax({"check", "scenario.yaml"});
  CAPTURE(result.err);
  CHECK(result.code == 3);
  CHECK(result.err.find("robot.bind:5:") != std::string::npos);
  CHECK(result.err.find("robot.bind:5:1:") == std::string::npos);
}

TEST_CASE("output files replace files only") {
  const CliFixture cli;
  const auto result = cli.parallax({"compile", "scenario.yaml", "-o", "/dev/null"});
  CHECK(result.code == 2);
  CHECK(std::filesystem::is_character_file("/dev/null"));
}

TEST_CASE("a limit on the number of traces leaves a run inconclusive") {
  const CliFixture cli;
  // The robot starts in r1 and the pick-up fails, or in r2 and it does not: two traces. Of the
  // first no start draws a discrepancy, as the arm cannot reach so far.
  cli.write("free.e", "HoldsAt(BoxIn(r2),0).\n");
  cli.write("free.yaml",
            "include: scenario.yaml\nmodel: [domain.e, free.e]\nplan: free.lisp\n"
            "constraints: [\"HoldsAt(RobotIn(r1),time) & {event} Happens(event,time-1)\"]\n"
            "criterion: {epsilon: 0.4}\nlimits: {max_traces: 1}\n"
            "sampling: {variables: {robot.x: [0, 0.3]}}\n");
  cli.write("free.lisp",
            "(with-failure-handling ((manipulation-low-level-failure (e) (return)))\n"
            "  (perform (an action (type picking-up) (object (an object (name box))))))\n"
            "(perform (a motion (type going) (pose (make-pose-stamped \"map\" 0.0 "
            "(make-3d-vector 0.5 0 0) (make-identity-rotation)))))\n");
  const auto all = cli.parallax({"traces", "free.yaml", "--count"});
  CAPTURE(all.err);
  REQUIRE(all.out == "2\n");
  const auto limited = cli.parallax({"run", "free.yaml", "--out", "run"});
  CAPTURE(limited.out);
  CHECK(limited.code == 4);
  CHECK(limited.out.starts_with(
      "inconclusive: nothing differs so far, and there are more traces than"));
}

}  // namespace
}  // namespace parallax::test
