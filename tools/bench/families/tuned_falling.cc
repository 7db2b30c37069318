#include <fmt/core.h>

#include "tools/bench/families/tuned.h"

namespace parallax::tools {

std::string tuned_falling(int horizon) {
  constexpr const char* kText = R"(height(0..{0}).
fluent(falling).
fluent(above(V)) :- height(V).
happens(drop,0).
happens(hit,T) :- step(T), holds(falling,T), holds(above(0),T).
initiates(drop,falling,T) :- happens(drop,T).
releases(drop,above(V),T) :- happens(drop,T), height(V).
terminates(hit,falling,T) :- happens(hit,T).
initiates(hit,above(V),T) :- happens(hit,T), holds(above(V),T).

% Falls since S, unstopped.
since(S,S+1) :- on(falling,S).
since(S,T+1) :- since(S,T), step(T), not off(falling,T).
:- since(S,T), holds(above(V),S), V >= T-S, not holds(above(V-T+S),T).
:- holds(above(V),T), holds(above(W),T), V < W.
:- holds(falling,0).
:- not holds(above({0}),0).
)";
  return tuned_calculus(horizon) + fmt::format(kText, horizon - 2);
}

}  // namespace parallax::tools
