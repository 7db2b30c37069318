#include <fmt/core.h>

#include "tools/bench/families/tuned.h"

namespace parallax::tools {

std::string tuned_pigeon(int pigeons, int holes) {
  constexpr const char* kText = R"(pigeon(1..{}).
hole(1..{}).
fluent(home(P)) :- pigeon(P).
fluent(sits(P,H)) :- pigeon(P), hole(H).
happens(come(P),0) :- pigeon(P).
initiates(come(P),home(P),T) :- happens(come(P),T).
releases(come(P),sits(P,H),T) :- happens(come(P),T), hole(H).
:- holds(home(P),T), not holds(sits(P,H),T) : hole(H).
:- holds(sits(P,G),T), holds(sits(P,H),T), G < H.
:- holds(sits(P,H),T), holds(sits(Q,H),T), P < Q.
:- holds(home(P),0).
:- holds(sits(P,H),0).
)";
  return tuned_calculus(1) + fmt::format(kText, pigeons, holes);
}

}  // namespace parallax::tools
