// Branches of `par` that ask the model: what others perform first may change the answer.

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "tests/tools/cli_json.h"

namespace parallax::test {
namespace {

using Strings = std::set<std::string>;

void write_switch(const CliFixture& cli) {
  cli.write("switch.e",
            "sort what\nwhat a, b\nfluent On()\nfluent Tried()\nevent Set()\nevent Try()\n"
            "event Note(what)\n[time] Initiates(Set(),On(),time).\n!HoldsAt(On(),0).\n"
            "[time] Initiates(Try(),Tried(),time).\n!HoldsAt(Tried(),0).\n");
  cli.write("switch.bind",
            "action setting () -> Set() ok: always\n"
            "action trying () -> Try() ok: !Tried() @t+1\n"
            "action noting (:n ?n) -> Note(?n) ok: always\n"
            "goal (bound-on) -> On()\n"
            "query on () ok: On() @t\n");
}

/// The sequences of events of all traces with branches by turns; the proof must be `proof`.
Strings traces_of(const CliFixture& cli, const std::string& plan,
                  const std::string& proof = "checked") {
  cli.write("switch.lisp",
            "(defun note (?n) (perform (an action (type noting) (n ?n))))\n"
            "(defun set-on () (perform (an action (type setting))))\n" +
                plan + "\n");
  const auto all =
      json_of(cli, {"traces", "switch.e", "--plan", "switch.lisp", "--bind", "switch.bind",
                    "--horizon", "5", "--limit", "0", "--par=interleave", "--certify"});
  CHECK(all["proof"] == proof);
  Strings out;
  for (const auto& trace : all["list"]) {
    std::string events;
    for (const auto& point : trace["timepoints"]) {
      for (const auto& event : point["happens"]) events += event.get<std::string>() + " ";
    }
    out.insert(events);
  }
  return out;
}

TEST_CASE("branches ask at their turn what others may change") {
  const CliFixture cli;
  write_switch(cli);
  const Strings either = {"Set() ", "Note(a) Set() ", "Set() Note(a) "};
  CHECK(traces_of(cli, "(par (unless (holds '(on)) (note 'a)) (set-on))") == either);
  CHECK(traces_of(cli, "(par (set-on) (unless (holds '(on)) (note 'a)))") == either);
  CHECK(traces_of(cli, "(par (unless (prolog '(on)) (note 'a)) (set-on))") == either);
  CHECK(traces_of(cli, "(par (unless (prolog '(or (true) (on))) (note 'b)) (set-on))") ==
        Strings{"Set() "});
  // The goal of an action: by the table, by a query, and by a rule.
  for (const std::string goal : {"bound-on", "on", "ready"}) {
    CAPTURE(goal);
    CHECK(traces_of(cli, "(def-fact-group facts (ready) (<- (ready) (on)))\n(let ((?g '(" + goal +
                             "))) (par (perform (an action (type noting) (n a) (goal ?g)))"
                             " (set-on)))") == either);
  }
  // Which function carries out an action.
  CHECK(traces_of(cli, R"(
(def-fact-group ways (action-grounding)
  (<- (action-grounding ?action (first-way ?action))
    (property ?action (:type :helping)) (not (on)))
  (<- (action-grounding ?action (second-way ?action))
    (property ?action (:type :helping)) (on)))
(defun first-way (&key &allow-other-keys) (note 'a))
(defun second-way (&key &allow-other-keys) (note 'b))
(par (perform (an action (type helping))) (set-on)))") ==
        Strings{"Note(a) Set() ", "Set() Note(a) ", "Set() Note(b) "});
  // Two questions of one branch see the event between them or not.
  CHECK(traces_of(cli,
                  "(par (if (holds '(on)) (note 'a) (when (holds '(on)) (note 'b))) (set-on))") ==
        Strings{"Set() Note(a) ", "Set() Note(b) ", "Set() "});
}

TEST_CASE("a branch that asks whenever it wakes up brings nothing new") {
  const CliFixture cli;
  write_switch(cli);
  CHECK(traces_of(cli,
                  "(pursue (loop until (holds '(on)) do (sleep 1))"
                  " (seq (note 'a) (set-on) (note 'b)))") ==
        Strings{"Note(a) Set() ", "Note(a) Set() Note(b) "});
}

TEST_CASE("a branch that asks when another one fails still comes to its perform") {
  const CliFixture cli;
  write_switch(cli);
  CHECK(traces_of(cli, R"(
(with-failure-handling ((plan-failure (e) (return)))
  (par (perform (an action (type trying)))
       (seq (unless (holds '(on)) (note 'a)) (note 'b)))))") ==
        Strings{"Try() ", "Try() Note(a) ", "Note(a) Try() ", "Note(a) Try() Note(b) ",
                "Note(a) Note(b) Try() "});
}

TEST_CASE("without branches goals are asked where the action is performed") {
  const CliFixture cli;
  write_switch(cli);
  const std::string rule =
      "(def-fact-group facts (ready) (<- (ready ?x) (member ?x (:a)) (on)) (<- (never ?x) "
      "(fail)))\n";
  const auto noting = [](const std::string& goal) {
    return "(let ((?g '" + goal + ")) (perform (an action (type noting) (n a) (goal ?g))))";
  };
  CHECK(traces_of(cli, rule + noting("(ready :a)") + "(set-on)" + noting("(ready :a)")) ==
        Strings{"Note(a) Set() "});
  CHECK(traces_of(cli, rule + "(set-on)" + noting("(ready :b)")) == Strings{"Set() Note(a) "});
  CHECK(traces_of(cli, rule + "(set-on)" + noting("(ready ?_)")) == Strings{"Set() "});
  CHECK(traces_of(cli, rule + noting("(never :a)")) == Strings{"Note(a) "});
  // Goals that are written into the designator are keywords, of which neither rules nor queries
  // speak.
  CHECK(traces_of(cli, rule + "(perform (an action (type noting) (n a) (goal (on))))", "none") ==
        Strings{"Note(a) "});
  // Clauses of another number of arguments say nothing of it.
  CHECK(traces_of(cli, rule + noting("(ready)"), "none") == Strings{"Note(a) "});
}

}  // namespace
}  // namespace parallax::test
