// Each rule finds its own kind of fault, and leaves similar text alone.

#include <doctest/doctest.h>

#include <algorithm>
#include <set>

#include "tests/compiler/lint/lint_text.h"

namespace parallax::test {
namespace {

/// A model about which there is nothing to say.
const char* const kClean =
    "range time 0 3\nsort a\na A, B\nfluent F(a)\nevent Up(a)\nevent Down(a)\n"
    "[a,time] Initiates(Up(a),F(a),time).\n[a,time] Terminates(Down(a),F(a),time).\n";

Strings places(const std::string& more) { return LintedText(kClean + more).places(); }
/// The warnings with `code` alone; places are counted from the line after the clean model.
Strings only(const std::string& code, const std::string& more) {
  Strings found;
  for (const auto& place : places(more)) {
    if (place.starts_with(code)) found.push_back(place);
  }
  return found;
}

TEST_CASE("a model without oddities gets no warning") {
  CHECK(places("").empty());
  CHECK(places("Happens(Up(A),0).\ncompletion Happens\n").empty());
}

TEST_CASE("fluents that nothing changes") {
  CHECK(only("W2101", "fluent G(a)\n") == Strings{"W2101 9:8-11"});
  CHECK(only("W2101", "fluent G(a)\nnoninertial G\n").empty());
  CHECK(only("W2101", "fluent G(a)\n[a,time] Releases(Up(a),G(a),time).\n").empty());
  CHECK(only("W2101", "option manualrelease on\nfluent G(a)\n").empty());
  CHECK(only("W2101",
             "range offset 1 3\nfluent G(a)\n"
             "[a,time,offset] Trajectory(F(a),time,G(a),offset).\n")
            .empty());
}

TEST_CASE("fluents that change one way") {
  const LintedText up(std::string(kClean) + "fluent G()\n[a,time] Initiates(Up(a),G(),time).\n");
  CHECK(up.places() == Strings{"W2102 9:8-10"});
  CHECK(up.text().find("can begin but no event terminates it") != std::string::npos);
  const LintedText down(std::string(kClean) + "fluent G()\n[a,time] Terminates(Up(a),G(),time).\n");
  CHECK(down.text().find("can end but no event initiates it") != std::string::npos);
}

TEST_CASE("events that nothing is said of") {
  CHECK(places("event Idle()\n") == Strings{"W2103 9:7-12"});
  CHECK(places("event Idle()\n[time] Happens(Idle(),time) -> HoldsAt(F(A),time).\n").empty());
  CHECK(only("W2103", "event Idle()\nmutex Idle, Up\n").empty());
}

TEST_CASE("sorts that are not used or empty") {
  CHECK(places("sort b\nb C\n") == Strings{"W2104 9:6-6"});
  CHECK(places("sort b: a\nb C\n").empty());  // its constants are of sort a
  CHECK(places("sort b: a\n") == Strings{"W2104 9:6-6"});
  CHECK(places("sort b\npredicate P(b)\n") == Strings{"W2105 9:6-6"});
  CHECK(places("sort b, c: b\nc C\npredicate P(c)\n").empty());  // b orders the sorts
  CHECK(places("sort h: integer\nrange h 0 9\n") == Strings{"W2104 9:6-6"});
}

TEST_CASE("labels and completions that miss each other") {
  const std::string theta = "predicate P(a)\npredicate Q(a)\nTheta: [a] Q(a) -> P(a).\n";
  CHECK(places(theta + "Theta: Q(A).\ncompletion Theta P\ncompletion Theta Q\n").empty());
  CHECK(places(theta + "Other: P(B).\ncompletion Theta P\n") == Strings{"W2106 12:1-11"});
  CHECK(only("W2106", theta + "Other: P(B).\ncompletion Theta P\ncompletion P\n").empty());
  CHECK(places(theta + "completion Theta P\ncompletion Theta Q\n") == Strings{"W2107 13:1-18"});
  CHECK(places(theta + "Theta: Q(A).\ncompletion Theta P\n") == Strings{"W2112 12:1-11"});
  CHECK(places(theta + "Happens(Up(A),0).\ncompletion Theta P\n") == Strings{"W2112 12:1-16"});
  // Planning: only goals and preconditions speak of events.
  CHECK(places(theta + "[a,time] Happens(Up(a),time) -> P(a).\ncompletion Theta P\n").empty());
}

TEST_CASE("ranges that fit nothing") {
  const std::string h = "sort h: integer\npredicate P(h)\n";
  CHECK(places(h + "range h 3 3\n") == Strings{"W2109 11:1-11"});
  CHECK(places(h + "range h 3 3\nrange h 4 4\n").empty());
  CHECK(places("range offset 1 1\n").empty());
  const std::string path =
      "[a,time,offset] HoldsAt(F(A),time) -> Trajectory(F(a),time,F(a),offset).\n";
  CHECK(places("range offset 1 2\n" + path) == Strings{"W2110 9:1-16"});
  CHECK(places("range offset 1 3\n" + path).empty());
  const std::string range = h + "range h 1 4\n";
  CHECK(places(range + "[h] h=5 -> P(h).\n") == Strings{"W2111 12:5-7"});
  CHECK(places(range + "[h] 0=h | P(h).\n") == Strings{"W2111 12:5-7"});
  CHECK(places(range + "[h] h<1 -> P(h).\n") == Strings{"W2111 12:5-7"});
  CHECK(places(range + "[h] 4<h -> P(h).\n") == Strings{"W2111 12:5-7"});
  CHECK(places(range + "[h] h<2 & h>=4 | h=4 -> P(h).\n").empty());
}

TEST_CASE("variables that are bound in vain") {
  CHECK(places("[a1,a2,time] HoldsAt(F(a1),time) -> HoldsAt(F(A),time).\n") ==
        Strings{"W2113 9:5-6"});
  CHECK(places("[a,time] HoldsAt(F(a),time) -> {a} HoldsAt(F(a),time+1).\n").empty());
  CHECK(places("[time] {a} HoldsAt(F(A),time).\n") == Strings{"W2113 9:9-9"});
  CHECK(places("[a,time] HoldsAt(F(a),time) & ({a} HoldsAt(F(B),time)).\n") ==
        Strings{"W2113 9:33-33"});
}

TEST_CASE("effect axioms that stop the 2005 reasoner") {
  CHECK(places("[time] Initiates(Up(A),F(A),time).\n") == Strings{"W2114 9:1-33"});
  CHECK(places("fluent G(a,a)\n[a,time] Initiates(Up(a),G(a,a),time).\n"
               "[a,time] Terminates(Down(a),G(a,A),time).\n") ==
        Strings{"W2114 10:1-37", "W2114 11:1-40"});
  CHECK(places("[a,time] a=A -> Initiates(Up(a),F(a),time).\n").empty());
}

TEST_CASE("mutex and xor that exclude less than they seem to") {
  CHECK(places("mutex Up, Down\n") == Strings{"W2115 9:1-14"});
  CHECK(places("event Wait()\nmutex Up, Wait\n") == Strings{"W2115 10:1-14"});
  CHECK(places("event Wait()\nevent Sit()\nmutex Wait, Sit\n").empty());
}

TEST_CASE("facts beside rules for the same completed atom") {
  const std::string rule = "[a,time] HoldsAt(F(a),time) -> Happens(Up(a),time).\n";
  CHECK(places("Happens(Up(A),0).\n" + rule + "completion Happens\n") == Strings{"W2201 9:1-16"});
  CHECK(places("Happens(Down(A),0).\n" + rule + "completion Happens\n").empty());
  CHECK(only("W2201", "Happens(Up(A),0).\n" + rule).empty());
  const std::string of_b = "[a,time] a=B & HoldsAt(F(a),time) -> Happens(Up(a),time).\n";
  CHECK(places("Happens(Up(A),0).\n" + of_b + "completion Happens\n").empty());
  CHECK(places("Happens(Up(B),0).\n" + of_b + "completion Happens\n").size() == 1);
  CHECK(places("Happens(Up(A),0).\nHappens(Up(A),1).\ncompletion Happens\n").empty());
  // A label of its own for the rule.
  CHECK(only("W2201", "L: Happens(Up(A),0).\n" + rule + "completion L Happens\n").empty());
}

TEST_CASE("effects on noninertial fluents") {
  const std::string more = "fluent G(a)\nnoninertial G\n";
  CHECK(places(more + "[a,time] Initiates(Up(a),G(a),time).\n") == Strings{"W2202 11:1-35"});
  CHECK(places(more + "[a,time] Releases(Up(a),G(a),time).\n").empty());
}

TEST_CASE("arithmetic inside arithmetic in effect axioms") {
  const std::string more =
      "sort h: integer\nrange h 0 9\nfluent G(h)\nevent Tick(h)\n"
      "[h,time] Terminates(Tick(h),G(h),time).\n";
  CHECK(places(more + "[h1,h2,time] h2=h1+h1+1 -> Initiates(Tick(h1),G(h2),time).\n") ==
        Strings{"W2203 14:17-23"});
  CHECK(places(more + "[h1,h2,time] h2=h1+1 -> Initiates(Tick(h1),G(h2),time).\n").empty());
}

TEST_CASE("built-in foundations are not looked at") {
  CHECK(LintedText("load foundations/Root.e\nload foundations/EC.e\n"
                   "load foundations/ECCausal.e\nrange time 0 1\n")
            .places()
            .empty());
}

TEST_CASE("a precondition that a completion takes for a reason") {
  const std::string facts =
      "event Go(a,a)\npredicate Near(a,a)\nNear(A,B).\n"
      "[a1,a2,time] Initiates(Go(a1,a2),F(a2),time).\n";
  const std::string needs = "[a1,a2,time] Happens(Go(a1,a2),time) -> Near(a1,a2).\n";
  CHECK(only("W2160", facts + needs + "completion Near\n") == Strings{"W2160 13:1-51"});
  CHECK(only("W2160", facts + "[a1,a2,time] !Near(a1,a2) -> !Happens(Go(a1,a2),time).\n"
                              "completion Near\n")
            .size() == 1);
  // Nothing is invented: the completion is over the facts alone, or there is none, or the rest of
  // the formula stands beside it.
  const auto labelled = [&](const std::string& label) {
    return "event Go(a,a)\npredicate Near(a,a)\nTheta: Near(A,B).\n"
           "[a1,a2,time] Initiates(Go(a1,a2),F(a2),time).\n" +
           label + needs + "completion Theta Near\n";
  };
  CHECK(only("W2160", labelled("")).empty());
  CHECK(only("W2160", labelled("Theta: ")).size() == 1);
  CHECK(only("W2160", facts + needs).empty());
  CHECK(only("W2160", facts + "[a1,a2] Near(a1,a2) -> Near(a2,a1).\ncompletion Near\n").empty());
  // A predicate that is implied by events alone counts as defined by them.
  CHECK(only("W2160",
             "predicate Seen(a)\n[a,time] Happens(Up(a),time) -> Seen(a).\ncompletion Seen\n")
            .empty());
}

TEST_CASE("a predicate that is completed twice") {
  const std::string reasons = "Delta: Happens(Up(A),0).\nGamma: Happens(Down(A),1).\n";
  CHECK(only("W2161", reasons + "completion Delta Happens\ncompletion Gamma Happens\n") ==
        Strings{"W2161 12:1-24"});
  CHECK(only("W2161", reasons + "completion Happens\ncompletion Happens\n").size() == 1);
  CHECK(only("W2161", reasons + "predicate P(a)\nGamma: P(A).\ncompletion Delta Happens\n"
                                "completion Gamma P\n")
            .empty());
}

TEST_CASE("formulas that take back what they say when the horizon grows") {
  const auto depends = [](const std::string& more) { return only("W2162", more).size() == 1; };
  CHECK(depends("{time} Happens(Up(A),time).\n"));
  CHECK(depends("[time] HoldsAt(F(A),time) -> {time1} time1>time & HoldsAt(F(B),time1).\n"));
  CHECK(depends("[time] HoldsAt(F(A),time) -> {time1} time1=time+1 & HoldsAt(F(B),time1).\n"));
  CHECK(depends("[time] HoldsAt(F(A),time) -> {time1} time1<=time & Happens(Up(B),time1).\n"));
  CHECK(depends("[time] HoldsAt(F(A),time) <-> {time1} Happens(Up(B),time1).\n"));
  CHECK(depends("{time} time=3 & Happens(Up(A),time).\n"));
  CHECK(
      depends("sort n: integer\nrange n 0 2\n"
              "[time] HoldsAt(F(A),time) -> {n} HoldsAt(F(B),time+n).\n"));
  CHECK(depends("[time] ([time1] HoldsAt(F(A),time1)) -> HoldsAt(F(B),time).\n"));
  CHECK(depends("[time] HoldsAt(F(A),time+2) -> Initiates(Up(B),F(B),time).\n"));
  CHECK(depends("[time] HoldsAt(F(A),time+2) -> Happens(Up(B),time).\ncompletion Happens\n"));
  CHECK(
      depends("[time] ({time1} Happens(Up(A),time1)) -> Happens(Up(B),time).\n"
              "completion Happens\n"));
  CHECK(depends("[time] ({time1} Happens(Up(A),time1)) -> Initiates(Up(B),F(B),time).\n"));
  CHECK(depends("predicate Ever(a)\n[a,time] Happens(Up(a),time) -> Ever(a).\ncompletion Ever\n"));
  CHECK(depends("count{time: Happens(Up(A),time)}>=1.\n"));
  CHECK(depends("2>count{time: Happens(Up(A),time)} -> HoldsAt(F(A),1).\n"));
  CHECK(depends("count{time: Happens(Up(A),time)}!=1.\n"));
  CHECK(depends("sum{time: -1: Happens(Up(A),time)}<=1.\n"));
  CHECK(depends("[time] count{a: !({time1} Happens(Up(a),time1))}<1 | HoldsAt(F(A),time).\n"));
  for (const std::string stays :
       {"count{time: Happens(Up(A),time)}<=1.\n",
        "[time] count{a: HoldsAt(F(a),time)}=1 -> sum{a: 2: HoldsAt(F(a),time+1)}>3.\n",
        "[time] count{time1: time1<time & Happens(Up(A),time1)}>=2 -> Happens(Up(B),time).\n",
        "[time] HoldsAt(F(A),time) -> {a} Happens(Up(a),time).\n",
        "[time] HoldsAt(F(A),time) -> Happens(Up(B),time+1).\n",
        "[time] HoldsAt(F(A),time) -> HoldsAt(F(B),time+2).\n",
        "[time] HoldsAt(F(A),time) -> {time1} time1<time & Happens(Up(B),time1).\n",
        "[time] HoldsAt(F(A),time) -> {time1} time1<=time & HoldsAt(F(B),time1).\n",
        "[time] Happens(Up(A),time) -> {time1} time1<=time & Happens(Up(B),time1).\n",
        "[time] Happens(Up(A),time) -> {time1} time1=time+1 & HoldsAt(F(B),time1).\n",
        "{time} time=2 & Happens(Up(A),time).\n", "{time} time<=3 & HoldsAt(F(A),time).\n",
        "[time1,time2] Happens(Up(A),time1) & Happens(Up(A),time2) -> time1=time2.\n",
        "[time] HoldsAt(F(A),time+1) -> Initiates(Up(B),F(B),time).\n",
        "[time] HoldsAt(F(A),time) -> Happens(Up(B),time).\ncompletion Happens\n",
        "[time] Happens(Up(A),time) -> Happens(Up(B),time+1).\ncompletion Happens\n",
        "[time,time1] time1<time & Happens(Up(A),time1) & Happens(Up(A),time) -> "
        "Happens(Up(B),time).\ncompletion Happens\n",
        "[time] ({time1} time1<time & Happens(Up(A),time1)) -> Happens(Up(B),time).\n"
        "completion Happens\n",
        "Happens(Up(A),2).\n"}) {
    CAPTURE(stays);
    CHECK(!depends(stays));
  }
}

TEST_CASE("every code of the rules is in their tables and is produced above") {
  std::set<std::string> expected, listed;
  for (const auto& info : base::all_diagnostics()) {
    if (info.id.starts_with("W21") || info.id.starts_with("W22")) {
      expected.insert(std::string(info.id));
    }
  }
  for (const auto rules : {compiler::lint_rules(), compiler::difference_rules()}) {
    for (const auto& rule : rules) {
      CHECK_FALSE(rule.description.empty());
      CHECK(listed.insert(std::string(base::info(rule.code).id)).second);
    }
  }
  CHECK(listed == expected);
  for (const auto code : compiler::reproduced_differences()) {
    CHECK(base::info(code).severity == base::Severity::kWarning);
  }
}

}  // namespace
}  // namespace parallax::test
