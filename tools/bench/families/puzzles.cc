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

std::string ringed_model(int pigeons, int holes) {
  auto text = fmt::format(
      R"(; {0} pigeons come home to {1} holes; each wears a ring of its own, and each hole has a door.

range time 0 1
sort pigeon
pigeon {2}
sort ring
ring {3}
sort hole
hole {4}
sort door
door {5}

fluent Home(pigeon)
fluent SitsIn(ring,hole)
fluent Shut(door)
event ComeHome(pigeon)

[pigeon,time] Initiates(ComeHome(pigeon),Home(pigeon),time).
[pigeon,door,time] Releases(ComeHome(pigeon),Shut(door),time).

[ring,hole1,hole2,time]
HoldsAt(SitsIn(ring,hole1),time) & HoldsAt(SitsIn(ring,hole2),time) -> hole1=hole2.
[ring1,ring2,hole,time]
HoldsAt(SitsIn(ring1,hole),time) & HoldsAt(SitsIn(ring2,hole),time) -> ring1=ring2.

[pigeon] !HoldsAt(Home(pigeon),0).
[ring,hole] !HoldsAt(SitsIn(ring,hole),0).
[pigeon] Happens(ComeHome(pigeon),0).
)",
      pigeons, holes, numbered_names("Pigeon", pigeons), numbered_names("Ring", pigeons),
      numbered_names("Hole", holes), numbered_names("Door", holes));
  // The ring in a hole is that of the pigeon that has come home.
  for (int i = 1; i <= pigeons; ++i) {
    text += fmt::format(
        "[hole,time] Releases(ComeHome(Pigeon{0}),SitsIn(Ring{0},hole),time).\n"
        "[time] HoldsAt(Home(Pigeon{0}),time) -> ({{hole}} HoldsAt(SitsIn(Ring{0},hole),time)).\n",
        i);
  }
  for (int i = 1; i <= holes; ++i) {
    text += fmt::format(
        "[time] HoldsAt(Shut(Door{0}),time) <-> ({{ring}} HoldsAt(SitsIn(ring,Hole{0}),time)).\n",
        i);
  }
  return text;
}

std::string tuned_ringed(int pigeons, int holes) {
  return tuned_pigeon(pigeons, holes) + R"(door(H) :- hole(H).
fluent(shut(D)) :- door(D).
releases(come(P),shut(D),T) :- happens(come(P),T), door(D).
:- holds(shut(D),T), not holds(sits(P,D),T) : pigeon(P).
:- door(D), holds(sits(P,D),T), not holds(shut(D),T).
)";
}

std::string chain_model(int stages) {
  constexpr const char* kText = R"(; A chain of {0} stages; each tick of a clock lights one more.

range time 0 {1}
sort stage: integer
range stage 1 {0}

fluent Lit(stage)
event Tick()

[stage1,stage2,time]
HoldsAt(Lit(stage1),time) & stage2=stage1+1 -> Initiates(Tick(),Lit(stage2),time).

HoldsAt(Lit(1),0).
[time] time<{1} -> Happens(Tick(),time).

; What is to be inferred, denied.
!HoldsAt(Lit({0}),{1}).
)";
  return fmt::format(kText, stages, stages - 1);
}

std::string tuned_chain(int stages) {
  constexpr const char* kText = R"(fluent(lit(1..{0})).
happens(tick,T) :- step(T).
initiates(tick,lit(S+1),T) :- happens(tick,T), holds(lit(S),T), S < {0}.
:- not holds(lit(1),0).
:- holds(lit({0}),horizon).
)";
  return tuned_calculus(stages - 1) + fmt::format(kText, stages);
}

}  // namespace parallax::tools
