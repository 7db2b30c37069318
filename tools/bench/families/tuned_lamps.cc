#include <fmt/core.h>

#include "tools/bench/families/tuned.h"

namespace parallax::tools {

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
