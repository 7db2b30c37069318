#include <fmt/core.h>

#include "tools/bench/families/families.h"
#include "tools/bench/families/tuned.h"

namespace parallax::tools {

std::string pigeon_model(int pigeons, int holes) {
  constexpr const char* kText = R"(; {0} pigeons come home to {1} holes.

range time 0 1
sort pigeon
pigeon {2}
sort hole
hole {3}

fluent Home(pigeon)
fluent SitsIn(pigeon,hole)
event ComeHome(pigeon)

; Where a pigeon sits is open once it has come home.
[pigeon,time] Initiates(ComeHome(pigeon),Home(pigeon),time).
[pigeon,hole,time] Releases(ComeHome(pigeon),SitsIn(pigeon,hole),time).

[pigeon,time] HoldsAt(Home(pigeon),time) -> ({{hole}} HoldsAt(SitsIn(pigeon,hole),time)).
[pigeon,hole1,hole2,time]
HoldsAt(SitsIn(pigeon,hole1),time) & HoldsAt(SitsIn(pigeon,hole2),time) -> hole1=hole2.
[pigeon1,pigeon2,hole,time]
HoldsAt(SitsIn(pigeon1,hole),time) & HoldsAt(SitsIn(pigeon2,hole),time) -> pigeon1=pigeon2.

[pigeon] !HoldsAt(Home(pigeon),0).
[pigeon,hole] !HoldsAt(SitsIn(pigeon,hole),0).
[pigeon] Happens(ComeHome(pigeon),0).
)";
  return fmt::format(kText, pigeons, holes, numbered_names("Pigeon", pigeons),
                     numbered_names("Hole", holes));
}

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
