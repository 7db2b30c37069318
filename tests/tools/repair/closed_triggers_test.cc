// Events that happen where triggers demand them, and nowhere else.

#include "compiler/repair/closed_triggers.h"

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "compiler/repair/condition_literal.h"
#include "tools/app/context.h"
#include "tools/repair/domain_model.h"
#include "tools/repair/verification.h"

namespace parallax::tools {
namespace {

constexpr const char* kKettle =
    "fluent On()\nfluent Hot()\nevent Switch()\nevent Boil()\nevent Whistle()\nevent Wait()\n"
    "[time] Initiates(Switch(),On(),time).\n[time] Initiates(Boil(),Hot(),time).\n"
    "[time] Terminates(Boil(),On(),time).\n";

compiler::ClosedTriggers closed(const std::string& axioms) {
  const auto domain = domain_of_text(kKettle + axioms);
  REQUIRE(domain != nullptr);
  return compiler::closed_triggers(domain->ast, domain->files, *domain->typed);
}

using Symbols = std::vector<std::string>;

TEST_CASE("an event is closed over its triggers, whatever their variables are called") {
  CHECK(closed("[time] HoldsAt(On(),time) -> Happens(Boil(),time).\n").symbols == Symbols{"Boil"});
  const auto renamed = closed("[time1] HoldsAt(On(),time1) -> Happens(Boil(),time1).\n");
  CHECK(renamed.symbols == Symbols{"Boil"});
  CHECK(renamed.text.find("time1") == std::string::npos);
}

TEST_CASE("an event that another axiom can demand as well is not closed") {
  const std::string trigger = "[time] HoldsAt(Hot(),time) -> Happens(Boil(),time).\n";
  for (const std::string other :
       {"[time] HoldsAt(On(),time) -> Happens(Boil(),time) & Happens(Whistle(),time).\n",
        "[time] HoldsAt(On(),time) -> Happens(Boil(),time) | Happens(Whistle(),time).\n",
        "[time] Happens(Whistle(),time) -> Happens(Boil(),time).\n",
        "[time] Happens(Boil(),time) <-> HoldsAt(On(),time).\n",
        "[time] !Happens(Boil(),time) -> Happens(Wait(),time).\n", "Happens(Boil(),0).\n"}) {
    CAPTURE(other);
    for (const auto& symbol : closed(trigger + other).symbols) CHECK(symbol != "Boil");
  }
  // An axiom that forbids an event, or names it in front of an effect, does not demand it.
  CHECK(closed(trigger + "[time] Happens(Boil(),time) -> HoldsAt(On(),time).\n").symbols ==
        Symbols{"Boil"});
  CHECK(closed(trigger + "[time] !Happens(Boil(),time) -> Initiates(Switch(),Hot(),time).\n")
            .symbols == Symbols{"Boil"});
}

Evidence seen(const Symbols& events, const std::vector<Evidence::State>& states) {
  Evidence out;
  out.ids = {"1.1"};
  for (const auto& event : events) out.steps.push_back({event, false, ""});
  out.states = states;
  return out;
}

TEST_CASE("an event that is performed at one step still happens at no other by itself") {
  const Context context;
  const auto text = std::string(kKettle) + "[time] HoldsAt(Hot(),time) -> Happens(Boil(),time).\n";
  const auto performed = seen({"Boil()"}, {{{"Hot()", false}}, {{"Hot()", true}}});
  const auto by_itself = seen({"Wait()"}, {{{"Hot()", false}}, {{"Hot()", true}}});
  CHECK(verify(text, {performed}, {}, context).runs_undemanded == 0);
  CHECK(verify(text, {performed, by_itself}, {}, context).runs_undemanded == 1);
  CHECK(verify(text, {}, {performed, by_itself}, context).validated == 1);
}

TEST_CASE("the functions of a large table do not fill the conditions") {
  const auto conditions = [](int functions) {
    std::string text = "sort item\nitem cola\nsort num: integer\nrange num 0 9\n";
    for (int i = 0; i < functions; ++i) {
      text += "function Price" + std::to_string(i) + "(item): num\nPrice" + std::to_string(i) +
              "(cola)=1.\n";
    }
    const auto domain = domain_of_text(text);
    REQUIRE(domain != nullptr);
    const auto& typed = *domain->typed;
    std::vector<compiler::SortedVariable> variables;
    for (const auto* name : {"item", "num1", "num2"}) {
      variables.push_back({name, *compiler::sort_of_variable(typed, name)});
    }
    return compiler::condition_literals(typed, variables, 100).size();
  };
  CHECK(conditions(1) < conditions(20));
  CHECK(conditions(40) == conditions(400));
}

}  // namespace
}  // namespace parallax::tools
