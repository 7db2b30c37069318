// The entry of a plan on the command line, and what answers say about what it takes in.

#include <doctest/doctest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "tests/tools/cli_json.h"

namespace parallax::test {
namespace {

TEST_CASE("the entry of a plan may be a call with arguments") {
  const CliFixture cli;
  cli.write("named.bind", "motion going (:object name ?r) -> Go(?r) ok: RobotIn(?r) @t+1\n");
  cli.write("plan.lisp",
            "(defun visit (?r) (perform (a motion (type going) (object (an object (name ?r))))))\n"
            "(defun unknown () (read-camera))\n"
            "(visit 'r1)\n");
  const auto entry = [&](const std::string& text) {
    return cli.parallax({"compile", "domain.e", "start.e", "--plan", "plan.lisp", "--bind",
                         "named.bind", "--horizon", "2", "--emit=cfg", "--plan-entry", text});
  };
  const auto called = entry("(visit 'r2)");
  CHECK(called.code == 0);
  CHECK(called.out.find("L0 Go(r2) at plan.lisp:1") != std::string::npos);
  CHECK(called.out.find("Go(r1)") == std::string::npos);
  CHECK(entry("(visit \"r2\")").out == called.out);
  CHECK(entry("visit").err.find("--plan-entry \"(visit ...)\"") != std::string::npos);
  CHECK(entry("(visit x)").err.find("--plan-entry:1:8: error[CPL004]") != std::string::npos);
  CHECK(entry("(visit").err.find("--plan-entry:1:1: error[CPL001]") != std::string::npos);
  // Blanks around it, and what is no call or more than one.
  CHECK(entry("  (visit 'r2) ; there").out == called.out);
  CHECK(entry(" visit ").err.find("`visit` needs arguments") != std::string::npos);
  for (const std::string empty : {"()", " ", "( )", "(visit 'r1)(visit 'r2)", "(visit 'r1) r2"}) {
    CAPTURE(empty);
    const auto refused = entry(empty);
    CHECK(refused.code == 3);
    CHECK(refused.err.find("error[CPL006]") != std::string::npos);
  }
}

/// Things that are taken by one of two arms, unless the cup is fragile.
void write_things(const CliFixture& cli) {
  cli.write("things.e",
            "sort item\nitem cup, jar, pan\nsort arm\narm left, right\npredicate Fragile(item)\n"
            "fluent Held(item)\nevent Take(arm,item)\n"
            "[arm,item,time] Initiates(Take(arm,item),Held(item),time).\n"
            "[item] !HoldsAt(Held(item),0).\n");
  cli.write("things.bind",
            "query fragile (?o) ok: Fragile(?o) @t\n"
            "action taking (:arm ?a :object ?o) -> Take(?a,?o) ok: Held(?o) @t+1\n");
  cli.write("things.lisp",
            "(defun fetch (?x &optional (?arm :left))\n"
            "  (unless (holds '(fragile cup))\n"
            "    (perform (an action (type taking) (arm ?arm) (object ?x)))))\n"
            "(defun other (?x) (if (eq ?x 'cup) (fetch 'jar) (fetch ?x)))\n");
}

std::vector<std::string> with_things(const std::string& command, const std::string& entry,
                                     const std::vector<std::string>& more) {
  std::vector<std::string> out = {command,       "things.e",     "--plan",
                                  "things.lisp", "--bind",       "things.bind",
                                  "--horizon=1", "--plan-entry", entry};
  out.insert(out.end(), more.begin(), more.end());
  return out;
}

TEST_CASE("free variables of the entry have every value") {
  const CliFixture cli;
  write_things(cli);
  const auto events = [&](const std::string& entry) {
    std::set<std::string> out;
    const auto answer = json_of(cli, with_things("traces", entry, {"--limit=0"}));
    for (const auto& trace : answer["list"]) {
      for (const auto& event : trace["timepoints"][0]["happens"]) out.insert(event);
    }
    return out;
  };
  using Events = std::set<std::string>;
  CHECK(events("(fetch ?x)") == Events{"Take(left,cup)", "Take(left,jar)", "Take(left,pan)"});
  CHECK(events("(fetch 'cup ?arm)") == Events{"Take(left,cup)", "Take(right,cup)"});
  CHECK(events("(fetch ?x ?arm)").size() == 6);
  CHECK(events("(other ?x)") == Events{"Take(left,jar)", "Take(left,pan)"});
  // One variable has one value.
  CHECK(events("(progn (fetch ?x) (fetch ?x))").size() == 3);
  const auto verify = [&](const std::string& entry, const std::string& property, int code) {
    return json_of(cli, with_things("verify", entry, {"--property", property}), code);
  };
  CHECK(verify("(other ?x)", "!HoldsAt(Held(cup),time)", 0)["proof"] == "checked");
  const auto jar = verify("(fetch ?x)", "!HoldsAt(Held(jar),time)", 1);
  CHECK(jar["inputs"] == nlohmann::json::array({"?x=jar", "!Fragile(cup)"}));
  // Nothing says what it can be.
  const auto unused = cli.parallax(with_things("verify", "(list ?x)", {"--property", "0=0"}));
  CHECK(unused.code == 3);
  CHECK(unused.err.find("`?x` is no argument of an event") != std::string::npos);
  const auto refusal = [&](const std::string& entry) {
    const auto answer = cli.parallax(with_things("verify", entry, {"--property", "0=0"}));
    CHECK(answer.code == 3);
    CHECK(answer.err.find("error[CPL006]") != std::string::npos);
    return answer.err;
  };
  CHECK(refusal("(fetch ?x ?x)").find("`?x` stands for a `") != std::string::npos);
  cli.write("things.e", cli.read("things.e") + "sort tray\npredicate Clean(tray)\n");
  cli.write("things.bind", cli.read("things.bind") + "query clean (?t) ok: Clean(?t) @t\n");
  cli.write("things.lisp", "(defun wipe (?t) (holds (list 'clean ?t)))\n");
  CHECK(refusal("(wipe ?t)").find("`?t` is a `tray`, of which the model names none") !=
        std::string::npos);
}

TEST_CASE("traces say how many initial states they stand for") {
  const CliFixture cli;
  write_things(cli);
  const auto all = with_things("traces", "(other ?x)", {"--limit=0"});
  const auto list = json_of(cli, all)["list"];
  REQUIRE(list.size() == 3);
  std::map<std::string, int> starts;
  for (const auto& trace : list) {
    const auto& happens = trace["timepoints"][0]["happens"];
    starts[happens.empty() ? "" : happens[0].get<std::string>()] = trace.value("initial_states", 1);
  }
  // Where the cup is fragile nothing is taken, whatever ?x is; a cup is replaced by a jar.
  CHECK(starts ==
        std::map<std::string, int>{{"", 3}, {"Take(left,jar)", 2}, {"Take(left,pan)", 1}});
  const auto text = cli.parallax(all).out;
  CHECK(text.find("\n  from 3 initial states that differ in nothing printed\n") !=
        std::string::npos);
  CHECK(text.find("from 1 initial") == std::string::npos);
  // More than ten are not counted.
  auto model = cli.read("things.e");
  const std::string items = "item cup, jar, pan";
  model.replace(model.find(items), items.size(), items + ", a, b, c, d, e, f, g, h");
  cli.write("things.e", model);
  CHECK(cli.parallax(all).out.find(
            "\n  from at least 10 initial states that differ in nothing printed\n") !=
        std::string::npos);
  int cut = 0;
  const auto many = json_of(cli, all)["list"];
  for (const auto& trace : many) {
    if (!trace.value("more_initial_states", false)) continue;
    ++cut;
    CHECK(trace["initial_states"] == 10);
  }
  CHECK(cut == 1);
}

TEST_CASE("compiled models of plans that are cut say so, and who answers about them does") {
  const CliFixture cli;
  write_things(cli);
  cli.write("things.lisp", "(loop until (holds '(fragile cup)))\n");
  const std::vector<std::string> plan = {"things.e", "--plan",      "things.lisp",
                                         "--bind",   "things.bind", "--horizon=1"};
  const auto with_plan = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin() + 1, plan.begin(), plan.end());
    return arguments;
  };
  const std::string cut = "unrolling was cut: `loop` at things.lisp:1:1";
  const auto compiled = cli.parallax(with_plan({"compile", "-o", "things.dec.cnf"}));
  CHECK(compiled.code == 0);
  CHECK(compiled.err.find(cut) != std::string::npos);
  CHECK(cli.read("things.dec.cnf").find("cut loop") != std::string::npos);
  for (const bool artifact : {false, true}) {
    CAPTURE(artifact);
    const auto ask = [&](std::vector<std::string> arguments) {
      if (!artifact) return cli.parallax(with_plan(std::move(arguments)));
      arguments.insert(arguments.begin() + 1, "things.dec.cnf");
      return cli.parallax(arguments);
    };
    CHECK(ask({"consequences"}).err.find(cut) != std::string::npos);
    CHECK(ask({"traces", "--count", "--json"}).out.find("\"cut\":true") != std::string::npos);
    CHECK(ask({"traces", "--limit=0"}).out.find("within the bounds of loops and calls") !=
          std::string::npos);
  }
}

}  // namespace
}  // namespace parallax::test
