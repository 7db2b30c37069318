// Effects on numbers: the learned axioms say how the number changes, not which numbers were seen.

#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "tests/tools/learn/taught_world.h"

namespace parallax::tools {
namespace {

const std::string kKiosk =
    "sort item\n"
    "sort count: integer\n"
    "range count 0 5\n"
    "item cola, mate\n"
    "fluent Stock(item,count)\n"
    "fluent Closed()\n"
    "event Buy(item)\n"
    "event Fill(item)\n"
    "event Close()\n"
    "[item,count1,count2,time] HoldsAt(Stock(item,count1),time) & "
    "HoldsAt(Stock(item,count2),time)\n"
    "  -> count1=count2.\n";

/// A shelf of at most five bottles of each kind; nothing is sold where there is none.
Evidence run_of(std::map<std::string, int> stock, const std::vector<std::string>& events) {
  bool closed = false;
  const auto seen = [&] {
    Evidence::State out;
    for (const auto& [item, count] : stock) {
      for (int i = 0; i <= 5; ++i) {
        out["Stock(" + item + "," + std::to_string(i) + ")"] = count == i;
      }
    }
    out["Closed()"] = closed;
    return out;
  };
  Evidence run;
  run.ids = {"2.1"};
  run.states.push_back(seen());
  for (const auto& event : events) {
    for (auto& [item, count] : stock) {
      if (event == "Buy(" + item + ")") count = std::max(0, count - 1);
      if (event == "Fill(" + item + ")") count = std::min(5, count + 1);
    }
    closed = closed || event == "Close()";
    run.steps.push_back({event, false, ""});
    run.states.push_back(seen());
  }
  return run;
}

TEST_CASE("one sale teaches that a number becomes one less, not which numbers they were") {
  TaughtWorld world(kKiosk);
  world.add(run_of({{"cola", 3}, {"mate", 2}}, {"Buy(cola)", "Close()"}));
  const auto axioms = world.axioms();
  CHECK(
      axioms.contains("[item,count,time] HoldsAt(Stock(item,count),time) -> "
                      "Terminates(Buy(item),Stock(item,count),time)."));
  CHECK(
      axioms.contains("[item,count,time] HoldsAt(Stock(item,count+1),time) -> "
                      "Initiates(Buy(item),Stock(item,count),time)."));
  CHECK(world.check().admitted == 1);
  // Other numbers and another item go as in the world.
  const auto other = world.check({run_of({{"cola", 5}, {"mate", 1}}, {"Buy(cola)", "Buy(mate)"})});
  CHECK(other.first == "");
  CHECK(other.admitted == 1);
}

TEST_CASE("borders of a number are learned, and hold for what was not seen") {
  TaughtWorld world(kKiosk);
  world.add(
      run_of({{"cola", 2}, {"mate", 4}}, {"Buy(cola)", "Buy(cola)", "Buy(cola)", "Fill(mate)",
                                          "Fill(mate)", "Buy(mate)", "Fill(cola)", "Close()"}));
  const auto check = world.check();
  CHECK(check.wrong == "");
  CHECK(check.admitted == 1);
  const auto other = world.check(
      {run_of({{"cola", 5}, {"mate", 0}}, {"Fill(cola)", "Buy(mate)", "Buy(cola)", "Fill(mate)"}),
       run_of({{"cola", 3}, {"mate", 1}}, {"Fill(cola)", "Buy(mate)", "Fill(cola)", "Buy(mate)"})});
  CHECK(other.first == "");
  CHECK(other.admitted == 2);
  for (const auto& axiom : world.axioms()) {
    CAPTURE(axiom);
    CHECK(axiom.find(",3)") == std::string::npos);  // no number between the borders stands alone
  }
}

TEST_CASE("an event that turns a fluent over is learned") {
  TaughtWorld world("sort lamp\nlamp left, right\nfluent Lit(lamp)\nevent Press(lamp)\n");
  Evidence run;
  bool lit = false;
  const auto seen = [&] {
    run.states.push_back(Evidence::State{{"Lit(left)", lit}, {"Lit(right)", false}});
  };
  seen();
  for (int i = 0; i < 3; ++i) {
    lit = !lit;
    run.steps.push_back({"Press(left)", false, ""});
    seen();
  }
  world.add(run);
  CHECK(world.axioms() ==
        std::set<std::string>{
            "[lamp,time] !HoldsAt(Lit(lamp),time) -> Initiates(Press(lamp),Lit(lamp),time).",
            "[lamp,time] HoldsAt(Lit(lamp),time) -> Terminates(Press(lamp),Lit(lamp),time)."});
  CHECK(world.check().admitted == 1);
}

}  // namespace
}  // namespace parallax::tools
