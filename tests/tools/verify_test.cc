// `parallax verify`, and the plan on the command line.

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "tests/tools/cli_json.h"

namespace parallax::test {
namespace {

std::vector<std::string> with_plan(std::vector<std::string> arguments) {
  for (const auto* word : {"domain.e", "start.e", "--plan", "fetch.lisp", "--bind", "robot.bind",
                           "--regions", "scenario.yaml", "--horizon", "6"}) {
    arguments.emplace_back(word);
  }
  return arguments;
}

TEST_CASE("verify: one shortest trace, and its events named by their performs") {
  const CliFixture cli;
  const auto result =
      cli.parallax(with_plan({"verify", "--check", "--property", "!HoldsAt(Holding(),time)"}));
  CHECK(result.code == 1);
  CHECK(result.out.starts_with("violated at timepoint 2\n"));
  CHECK(result.out.find("  0 Go(r2) at fetch.lisp:11:5, succeeded\n") != std::string::npos);
  CHECK(result.out.find("  1 PickUp() at fetch.lisp:12:5, succeeded\n") != std::string::npos);
  CHECK(result.out.find("Place") == std::string::npos);
}

TEST_CASE("verify: a property of the start is violated without a step") {
  const CliFixture cli;
  const auto answer =
      json_of(cli, with_plan({"verify", "--property", "HoldsAt(RobotIn(r2),time)"}), 1);
  CHECK(answer["verdict"] == "violated");
  CHECK(answer["timepoint"] == 0);
  CHECK(answer["performed"].empty());
}

/// In each trace Up() holds from 0 on: Tick() happens at 0 and 1, and where it happens Up() holds.
const char* const kTicking =
    "range time 0 2\nfluent Up()\nevent Tick()\n[time] Happens(Tick(),time).\n"
    "[time] Happens(Tick(),time) -> HoldsAt(Up(),time).\n";

TEST_CASE("verify: what only a prefix that cannot go on violates is no violation") {
  const CliFixture cli;
  cli.write("tick.e", kTicking);
  for (const std::string property :
       {"HoldsAt(Up(),time)", "always HoldsAt(Up(),time)", "historically HoldsAt(Up(),time)"}) {
    CAPTURE(property);
    const auto answer = json_of(cli, {"verify", "tick.e", "--property", property}, 0);
    CHECK(answer["verdict"] == "holds");
    CHECK(answer["proof"] == "checked");
    CHECK(answer["dead_end"] == 0);
  }
  const auto result = cli.parallax({"verify", "tick.e", "--property", "HoldsAt(Up(),time)"});
  CHECK(result.out == "holds up to horizon 2 (proof checked)\n");
  CHECK(result.err.find("a prefix that cannot go on violates the property at timepoint 0") !=
        std::string::npos);
  // A violation that goes on is one.
  CHECK(json_of(cli, {"verify", "tick.e", "--property", "!HoldsAt(Up(),time)"}, 1)["timepoint"] ==
        0);
}

/// Whether Easy() can be false is a question of eleven pigeons in ten holes.
std::string pigeons() {
  std::string text =
      "range time 0 1\nsort pigeon\nsort hole\nfluent F()\nevent E()\npredicate Easy()\n"
      "predicate In(pigeon,hole)\n[time] Initiates(E(),F(),time).\n!HoldsAt(F(),0).\n"
      "[pigeon] Easy() | {hole} In(pigeon,hole).\n"
      "[pigeon1,pigeon2,hole] pigeon1!=pigeon2 & In(pigeon1,hole) & In(pigeon2,hole) -> Easy().\n";
  for (int i = 1; i <= 11; ++i) text += "pigeon G" + std::to_string(i) + "\n";
  for (int i = 1; i <= 10; ++i) text += "hole H" + std::to_string(i) + "\n";
  return text;
}

/// The trace says what holds and happens, and nothing else.
void check_observable(const nlohmann::json& trace, const nlohmann::json& happens) {
  REQUIRE(trace.is_object());
  CHECK(trace["timepoints"][0]["happens"] == happens);
  CHECK_FALSE(trace["timepoints"][0].contains("released"));
  CHECK_FALSE(trace.contains("predicates"));
  CHECK_FALSE(trace.contains("undetermined"));
}

TEST_CASE(
    "a violation or a best trace is told also where its undetermined atoms are hard to tell") {
  const CliFixture cli;
  cli.write("pigeons.e", pigeons());
  const auto violated =
      json_of(cli, {"verify", "pigeons.e", "--property", "!HoldsAt(F(),time)"}, 1);
  CHECK(violated["verdict"] == "violated");
  check_observable(violated["trace"], nlohmann::json::array({"E()"}));
  const auto best = json_of(cli, {"traces", "pigeons.e", "--minimize", "count Happens(E(),time)",
                                  "--limit", "1", "--order", "any"});
  CHECK(best["traces"] == 1);
  CHECK(best["proved"] == true);
  REQUIRE(best["list"].size() == 1);
  check_observable(best["list"][0], nlohmann::json::array());
}

TEST_CASE("verify: a model whose prefixes all end before the horizon has no execution") {
  const CliFixture cli;
  cli.write("stuck.e",
            "range time 0 2\nfluent Up()\nevent Tick()\n[time] Terminates(Tick(),Up(),time).\n"
            "[time] Happens(Tick(),time) -> HoldsAt(Up(),time).\n[time] Happens(Tick(),time).\n");
  const auto result = cli.parallax({"verify", "stuck.e", "--property", "HoldsAt(Up(),time)"});
  CHECK(result.code == 3);
  CHECK(result.err.find("error[E7001]") != std::string::npos);
  const auto until = json_of(cli, {"traces", "stuck.e", "--until", "HoldsAt(Up(),time)"}, 0);
  CHECK(until["traces"] == 0);
  CHECK(until["complete"] == true);
  CHECK(until["dead_end"] == 0);
  const auto best = cli.parallax({"traces", "stuck.e", "--until", "HoldsAt(Up(),time)",
                                  "--minimize", "count Happens(Tick(),time)"});
  CHECK(best.out.starts_with("0 traces"));
}

TEST_CASE("verify: horizons give one answer about a timepoint") {
  const CliFixture cli;
  cli.write("warm.e",
            "fluent Warm()\nevent Heat()\nevent Bell()\n[time] Initiates(Heat(),Warm(),time).\n"
            "!HoldsAt(Warm(),0).\n[time] Happens(Heat(),time) -> time=0.\n"
            "Happens(Heat(),0) -> Happens(Bell(),2).\n");
  const auto asked = [&](const std::string& horizon) {
    return cli.parallax({"verify", "warm.e", "--horizon", horizon, "--property",
                         "!(HoldsAt(Warm(),time) & previously previously (0=0))"});
  };
  const auto shorter = asked("2");
  CHECK(shorter.code == 3);
  CHECK(shorter.err.find("error[E3004]") != std::string::npos);
  CHECK(shorter.err.find("--horizon 3") != std::string::npos);
  CHECK(asked("3").out.starts_with("violated at timepoint 2\n"));
  CHECK(asked("4").out.starts_with("violated at timepoint 2\n"));
}

TEST_CASE("verify: a formula about this horizon alone is told with its place") {
  const CliFixture cli;
  cli.write("some.e",
            "range time 0 2\nfluent F()\nevent E()\n[time] Initiates(E(),F(),time).\n"
            "{time} Happens(E(),time).\n");
  const auto result = cli.parallax({"verify", "some.e", "--property", "HoldsAt(F(),time)"});
  CHECK(result.err.find("some.e:5:1-24: warning[W2162]") != std::string::npos);
  CHECK(cli.parallax({"traces", "some.e"}).err.find("W2162") == std::string::npos);
  cli.write("loop.e",
            "range time 0 1\nfluent F()\nevent E()\nevent G()\n[time] Initiates(E(),F(),time).\n"
            "[time] Happens(E(),time) -> Happens(G(),time).\n"
            "[time] Happens(G(),time) -> Happens(E(),time).\ncompletion Happens\n");
  const auto checked = cli.parallax({"check", "loop.e"});
  CHECK(checked.err.find("loop.e:6:1-45: warning[W3060]") != std::string::npos);
}

TEST_CASE("verify: holds to the end of the plan, or up to the horizon only") {
  const CliFixture cli;
  const auto result = cli.parallax(
      {"verify", "scenario.yaml", "--property", "{region} HoldsAt(RobotIn(region),time)"});
  CHECK(result.code == 0);
  CHECK(result.out ==
        "holds up to horizon 6 (proof checked), and every path of the plan has ended by then\n");
  const auto answer = json_of(cli, {"verify", "domain.e", "start.e", "--plan", "fetch.lisp",
                                    "--bind", "robot.bind", "--regions", "scenario.yaml",
                                    "--horizon", "3", "--property", "!(HoldsAt(BoxIn(r1),time))"});
  CHECK(answer["verdict"] == "holds");
  CHECK(answer["proof"] == "checked");
  CHECK(!answer.contains("proof_file"));
  CHECK(answer["exploration"] == "complete up to bound");
  CHECK(answer["bounds"] ==
        nlohmann::json::array({"the plan goes on beyond timepoint 3 with Place(r1) at "
                               "fetch.lisp:14:5"}));
}

TEST_CASE("verify: the proof is kept where the user says") {
  const CliFixture cli;
  const auto answer = json_of(cli, {"verify", "scenario.yaml", "--certify=safe.drat", "--property",
                                    "{region} HoldsAt(RobotIn(region),time)"});
  CHECK(answer["proof_file"] == "safe.drat");
  CHECK(std::filesystem::exists(cli.folder() / "safe.drat"));
  CHECK(cli.read("safe.drat.cnf").find("p cnf ") != std::string::npos);
}

TEST_CASE("verify: a property may look back, and needs no plan") {
  const CliFixture cli;
  const auto result = cli.parallax({"verify", "domain.e", "start.e", "--horizon", "2", "--property",
                                    "Happens(PickUp(),time-1) -> HoldsAt(Holding(),time)"});
  CHECK(result.code == 1);  // picking up where no box is
  CHECK(result.out.starts_with("violated at timepoint 1\n"));
}

TEST_CASE("verify: what is wrong with a property is reported in it") {
  const CliFixture cli;
  const auto result = cli.parallax(with_plan({"verify", "--property", "HoldsAt(Hloding(),time)"}));
  CHECK(result.code == 3);
  CHECK(result.err.find("--property") != std::string::npos);
  CHECK(result.err.find("Holding") != std::string::npos);
}

TEST_CASE("traces: branches of a plan run in written order, or in every order") {
  const CliFixture cli;
  cli.write("named.bind",
            "motion going (:object name ?r) -> Go(?r) ok: RobotIn(?r) @t+1\n"
            "action picking-up () -> PickUp() ok: Holding() @t+1\n");
  cli.write("par.lisp",
            "(par (perform (a motion (type going) (object (an object (name r2)))))\n"
            "     (with-failure-handling ((plan-failure (e) (return)))\n"
            "       (perform (an action (type picking-up)))))\n");
  std::vector<std::string> arguments = {"traces",     "domain.e", "start.e",
                                        "--plan",     "par.lisp", "--bind",
                                        "named.bind", "--until",  "HoldsAt(RobotIn(r2),time)",
                                        "--limit=0"};
  // The plan says nothing of Place: at every timepoint two instances happen or not, 4 ways. Go
  // comes first, and the region is reached; or PickUp fails before it, one timepoint more.
  const auto ordered = json_of(cli, arguments);
  CHECK(ordered["traces"] == 4);
  CHECK(ordered["every_order"] == false);
  // Nothing is known about the other order.
  const auto claim = cli.parallax({"verify", "domain.e", "start.e", "--plan", "par.lisp", "--bind",
                                   "named.bind", "--horizon", "3", "--property",
                                   "HoldsAt(Holding(),time) | !HoldsAt(Holding(),time)"});
  CHECK(claim.code == 0);
  CHECK(claim.out.starts_with("holds up to horizon 3 (not of every order, no proof)"));
  CHECK(claim.err.find("not explored: the other orders of `par` at par.lisp:1") !=
        std::string::npos);
  // A compiled model could not tell that, so there is none.
  const std::vector<std::string> compile = {"compile",    "domain.e", "start.e",
                                            "--plan",     "par.lisp", "--bind",
                                            "named.bind", "--until",  "HoldsAt(RobotIn(r2),time)",
                                            "-o",         "par.cnf"};
  const auto compiled = cli.parallax(compile);
  CHECK(compiled.code == 2);
  CHECK(compiled.err.find("the other orders of `par` are not explored") != std::string::npos);
  auto interleaved = compile;
  interleaved.push_back("--par=interleave");
  CHECK(cli.parallax(interleaved).code == 0);
  arguments.push_back("--par=interleave");
  const auto both = json_of(cli, arguments);
  CHECK(!both.contains("every_order"));
  CHECK(both["traces"] == 4 + 4 * 4);
  CHECK(both["exploration"] == "all traces explored");
}

/// `verify` of what always holds, so that only the plan decides whether it is proved.
std::vector<std::string> tautology_of_plan() {
  return {"verify",
          "domain.e",
          "start.e",
          "--plan",
          "plan.lisp",
          "--bind",
          "named.bind",
          "--horizon",
          "3",
          "--property",
          "HoldsAt(Holding(),time) | !HoldsAt(Holding(),time)"};
}

TEST_CASE("verify: nothing is proved of a plan of which something is approximated") {
  const CliFixture cli;
  cli.write("named.bind",
            "motion going (:object name ?r) -> Go(?r) ok: RobotIn(?r) @t+1\n"
            "action picking-up () -> PickUp() ok: Holding() @t+1\n");
  const std::string go = "(perform (a motion (type going) (object (an object (name r2)))))";
  const std::vector<std::pair<std::string, std::string>> plans = {
      {"(let ((l (list 1 2))) (setf (car l) 3) " + go + ")", "changes of shared lists"},
      {"(unless (check-picking-up-collisions) " + go + ")",
       "what `check-picking-up-collisions` finds"},
      {"(perform (a motion (type going) (goal (robot-in r2)) (object (an object (name r2)))))", ""},
      {"(perform (an action (type picking-up) (goal (object-held box))))",
       "the goal `object-held`, which the table does not bind"},
      {"(when (eql \"a\" \"a\") " + go + ")", "equal things taken for one thing"},
      {"(with-failure-handling ((condition (e) (ros-warn (a b) \"~a\" e))) " + go + ")", ""}};
  for (const auto& [text, gap] : plans) {
    CAPTURE(text);
    cli.write("plan.lisp", text + "\n");
    const auto verify = tautology_of_plan();
    const auto claim = cli.parallax(verify);
    const auto answer = json_of(cli, verify);
    CHECK(claim.code == 0);
    CHECK(!answer.contains("every_order"));
    if (gap.empty()) {  // only actions have goals, and it makes no difference what a log tells
      CHECK(answer["proof"] == "checked");
      continue;
    }
    CHECK(claim.out.starts_with("holds up to horizon 3 (approximated, no proof)"));
    CHECK(claim.err.find("approximated: " + gap + " at plan.lisp:1") != std::string::npos);
    CHECK(answer["proof"] == "none");
    CHECK(answer["approximated"] == true);
    const auto compiled = cli.parallax({"compile", "domain.e", "start.e", "--plan", "plan.lisp",
                                        "--bind", "named.bind", "--horizon", "3", "-o", "out.cnf"});
    CHECK(compiled.code == 2);
    CHECK(compiled.err.find(gap + ": approximated") != std::string::npos);
  }
}

TEST_CASE("verify: nothing is proved of a plan that is cut where an execution comes to") {
  const CliFixture cli;
  cli.write("named.bind",
            "query is-held () ok: Holding() @t\n"
            "motion going (:object name ?r) -> Go(?r) ok: RobotIn(?r) @t+1\n");
  const std::string go = "(perform (a motion (type going) (object (an object (name r2)))))";
  const auto verify = [&](const std::string& text, bool turns) {
    cli.write("plan.lisp", text + "\n");
    auto arguments = tautology_of_plan();
    if (turns) arguments.emplace_back("--par=interleave");
    return json_of(cli, arguments);
  };
  const auto asks = verify("(loop until (holds '(is-held)))" + go, false);
  CHECK(asks["proof"] == "none");
  CHECK(asks["cut"] == true);
  CHECK(!asks.contains("every_order"));
  CHECK(asks["bounds"] == nlohmann::json::array({"bound reached: `loop` at plan.lisp:1:1"}));
  // Behind the horizon nothing is asked of the loop.
  const auto later = verify(
      "(dotimes (i 4) (perform (a motion (type going) (object (an object "
      "(name r2))))))(loop until (holds '(is-held)))",
      false);
  CHECK(later["proof"] == "checked");
  // A branch that counts its turns where others can see it.
  const auto sleeps = verify(
      "(let ((k 0)) (par (dotimes (i 20) (setf k i) (sleep 1)) (progn (sleep 1) " + go + ")))",
      true);
  CHECK(sleeps["proof"] == "none");
  CHECK(sleeps["cut"] == true);
  CHECK(cli.parallax({"traces", "domain.e", "start.e", "--plan", "plan.lisp", "--bind",
                      "named.bind", "--horizon", "3", "--limit=0", "--par=interleave"})
            .out.find("(within the bounds of loops and calls, no proof)") != std::string::npos);
  // A branch that only sleeps has nothing to count.
  const auto idle = verify("(par (dotimes (i 200) (sleep 1)) (progn (sleep 1) " + go + "))", true);
  CHECK(idle["proof"] == "checked");
}

TEST_CASE("turns of branches that meet again cost their number, not their orders") {
  const CliFixture cli;
  cli.write("named.bind", "motion going (:object name ?r) -> Go(?r) ok: RobotIn(?r) @t+1\n");
  const std::string branch = "(dotimes (i 5) (sleep 1) (setf k 0))";
  cli.write("plan.lisp", "(let ((k 0)) (par " + branch + branch + branch + "))\n" +
                             "(perform (a motion (type going) (object (an object (name r2)))))\n");
  // 756,756 orders of 216 states.
  const auto answer =
      json_of(cli, {"verify", "domain.e", "start.e", "--plan", "plan.lisp", "--bind", "named.bind",
                    "--horizon", "2", "--par=interleave", "--time-limit=20", "--property",
                    "HoldsAt(Holding(),time) | !HoldsAt(Holding(),time)"});
  CHECK(answer["verdict"] == "holds");
  CHECK(answer["exploration"] == "all traces explored");
  // The branches change one variable between their turns, in an order that is not explored.
  CHECK(answer["proof"] == "none");
  CHECK(answer["every_order"] == false);
}

TEST_CASE("traces tell how the plan ended") {
  const CliFixture cli;
  cli.write("named.bind", "action picking-up () -> PickUp() ok: Holding() @t+1 else lost\n");
  cli.write("plan.lisp",
            "(define-condition lost (plan-failure) ())\n"
            "(with-retry-counters ((n 1))\n"
            "  (with-failure-handling ((lost (e) (do-retry n (retry))))\n"
            "    (perform (an action (type picking-up)))))\n"
            "(perform (an action (type picking-up)))\n");
  const auto traces = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"traces", "domain.e",   "--plan",      "plan.lisp",
                                          "--bind", "named.bind", "--horizon=2", "--limit=0"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  };
  const auto all = json_of(cli, traces({}));
  std::map<std::string, int> ends;
  for (const auto& trace : all["list"]) ++ends[trace["ended"].get<std::string>()];
  REQUIRE(ends.size() == 3);
  int found = 0;
  for (const auto& [end, number] : ends) {
    CHECK((end == "done" || end == "FAILED(lost)" || end == "cut"));
    const auto wanted = end == "FAILED(lost)" ? "failed" : end;
    const auto some = json_of(cli, traces({"--ended", wanted}));
    CHECK(some["traces"] == number);
    CHECK(json_of(cli, traces({"--ended", wanted, "--count"}))["traces"] == number);
    for (const auto& trace : some["list"]) CHECK(trace["ended"] == end);
    const auto text = cli.parallax(traces({"--ended", wanted})).out;
    CHECK(text.find("\n  plan ended: " + end + "\n") != std::string::npos);
    found += number;
  }
  CHECK(all["traces"] == found);
  // The same events, and a predicate that nothing shows decides how it ends.
  cli.write("silent.e", "predicate Lucky()\nevent Tick()\nfluent On()\n!HoldsAt(On(),0).\n");
  cli.write("silent.bind", "query lucky () ok: Lucky() @t\naction a -> Tick() ok: always\n");
  cli.write("silent.lisp",
            "(perform (an action (type a)))\n(unless (holds '(lucky)) (fail 'plan-failure))\n");
  const auto silent = json_of(cli, {"traces", "silent.e", "--plan", "silent.lisp", "--bind",
                                    "silent.bind", "--horizon=2", "--limit=0"});
  REQUIRE(silent["traces"] == 1);
  CHECK(silent["list"][0]["ended"] == "done or FAILED(plan-failure)");
  // A trace that ends in a hit while the plan goes on does not say how that ends.
  const auto hit = json_of(cli, traces({"--until", "HoldsAt(Holding(),time)"}));
  for (const auto& trace : hit["list"]) CHECK(trace.value("ended", "") != "cut");
  CHECK(cli.parallax({"traces", "domain.e", "--horizon=2", "--ended=done"}).code == 2);
}

TEST_CASE("verify: a violation says what of the model the plan asked for") {
  const CliFixture cli;
  cli.write("kinds.e",
            "sort item\nitem cup, jar\npredicate Fragile(item)\npredicate Blue(item)\n"
            "fluent Held(item)\nevent Take(item)\n"
            "[item,time] Initiates(Take(item),Held(item),time).\n"
            "[item] !HoldsAt(Held(item),0).\n");
  cli.write("kinds.bind",
            "query fragile (?o) ok: Fragile(?o) @t\n"
            "action taking (:object ?o) -> Take(?o) ok: Held(?o) @t+1\n");
  cli.write("kinds.lisp",
            "(when (holds '(fragile cup)) (perform (an action (type taking) (object cup))))\n");
  const std::vector<std::string> verify = {"verify",      "kinds.e",    "--plan",
                                           "kinds.lisp",  "--bind",     "kinds.bind",
                                           "--horizon=1", "--property", "!HoldsAt(Held(cup),time)"};
  const auto answer = json_of(cli, verify, 1);
  REQUIRE(answer.contains("inputs"));
  const auto inputs = answer["inputs"].get<std::vector<std::string>>();
  CHECK(std::find(inputs.begin(), inputs.end(), "Fragile(cup)") != inputs.end());
  for (const auto& atom : inputs) CHECK(atom.starts_with("Fragile("));
  CHECK(answer["trace"]["ended"] == "done");
  CHECK(cli.parallax(verify).out.find("of what the plan asks for,\n  Fragile(cup)\n") !=
        std::string::npos);
  // Predicates that have to be false count as well.
  cli.write("kinds.lisp",
            "(unless (holds '(fragile cup)) (perform (an action (type taking) (object cup))))\n");
  CHECK(json_of(cli, verify, 1)["inputs"] == nlohmann::json::array({"!Fragile(cup)"}));
}

TEST_CASE("a loop of `go` around a question ends at its bound") {
  const CliFixture cli;
  cli.write("named.bind",
            "query is-held () ok: Holding() @t\n"
            "action picking-up () -> PickUp() ok: Holding() @t+1\n");
  cli.write("again.lisp",
            "(tagbody again (unless (holds '(is-held)) (go again)))\n"
            "(perform (an action (type picking-up)))\n");
  cli.write("until.lisp",
            "(loop until (holds '(is-held)))\n"
            "(perform (an action (type picking-up)))\n");
  // Asking changes nothing, so that it asks for ever where nothing is held.
  const auto traces = [&](const char* plan) {
    return json_of(cli, {"traces", "domain.e", "start.e", "--plan", plan, "--bind", "named.bind",
                         "--horizon", "3", "--limit=0"})["traces"];
  };
  CHECK(traces("again.lisp") == traces("until.lisp"));
}

TEST_CASE("check warns of retries that cannot help in the model") {
  const CliFixture cli;
  cli.write("stubborn.lisp",
            "(with-retry-counters ((n 2))\n"
            "  (with-failure-handling ((manipulation-low-level-failure (e) (do-retry n (retry))))\n"
            "    (perform (an action (type picking-up) (object (an object (name box)))))))\n");
  const auto result = cli.parallax({"check", "domain.e", "start.e", "--horizon", "5", "--plan",
                                    "stubborn.lisp", "--bind", "robot.bind"});
  CHECK(result.code == 0);
  CHECK(result.err.find("stubborn.lisp:3:5") != std::string::npos);
  CHECK(result.err.find("W-DEAD") != std::string::npos);
  CHECK(result.err.find("2 repetitions can be reached") != std::string::npos);
}

TEST_CASE("the plan of the command line is compiled, drawn and enumerated") {
  const CliFixture cli;
  auto result = cli.parallax(with_plan({"compile", "--emit", "cfg"}));
  CHECK(result.code == 0);
  CHECK(result.out.starts_with("entry L0\nL0 Go(r2) at fetch.lisp:11"));
  result = cli.parallax(with_plan({"compile", "--emit", "cfg-dot"}));
  CHECK(result.code == 0);
  CHECK(result.out.starts_with("digraph plan {"));
  result = cli.parallax({"traces", "domain.e", "start.e", "--plan", "fetch.lisp", "--bind",
                         "robot.bind", "--regions", "scenario.yaml", "--horizon", "6", "--until",
                         "HoldsAt(BoxIn(r1),time)"});
  CHECK(result.code == 0);
  CHECK(result.out.find("\n1 trace, all traces explored") != std::string::npos);
  result = cli.parallax({"traces", "domain.e", "start.e", "--plan", "fetch.lisp", "--bind",
                         "robot.bind", "--horizon", "4"});
  CHECK(result.code == 3);
  CHECK(result.err.find("CPL031") != std::string::npos);
  CHECK(cli.parallax({"traces", "domain.e", "--plan", "fetch.lisp"}).code == 2);
}

}  // namespace
}  // namespace parallax::test
