#include <fmt/core.h>

#include "tools/bench/families/families.h"
#include "tools/bench/families/tuned.h"

namespace parallax::tools {

std::string lamps_model(int lamps, int horizon) {
  constexpr const char* kText = R"(; {0} lamps with a switch each, {1} steps.

range time 0 {1}
sort lamp
lamp {2}

fluent Lit(lamp)
event Flip(lamp)

[lamp,time] !HoldsAt(Lit(lamp),time) -> Initiates(Flip(lamp),Lit(lamp),time).
[lamp,time] HoldsAt(Lit(lamp),time) -> Terminates(Flip(lamp),Lit(lamp),time).

[lamp] !HoldsAt(Lit(lamp),0).
[lamp] HoldsAt(Lit(lamp),{1}).
)";
  return fmt::format(kText, lamps, horizon, numbered_names("Lamp", lamps));
}

std::string distant_model(int lamps, int horizon) {
  return lamps_model(lamps, horizon) +
         fmt::format("\n[lamp] Happens(Flip(lamp),0) -> !Happens(Flip(lamp),{}).\n", horizon - 1);
}

std::string tuned_lamps(int lamps, int horizon) {
  constexpr const char* kText = R"(lamp(1..{}).
fluent(lit(L)) :- lamp(L).
{{ happens(flip(L),T) : lamp(L) }} :- step(T).
initiates(flip(L),lit(L),T) :- happens(flip(L),T), not holds(lit(L),T).
terminates(flip(L),lit(L),T) :- happens(flip(L),T), holds(lit(L),T).
:- holds(lit(L),0).
:- lamp(L), not holds(lit(L),horizon).
)";
  return tuned_calculus(horizon) + fmt::format(kText, lamps);
}

std::string tuned_distant(int lamps, int horizon) {
  return tuned_lamps(lamps, horizon) + ":- happens(flip(L),0), happens(flip(L),horizon-1).\n";
}

}  // namespace parallax::tools
