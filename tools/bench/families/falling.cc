#include <fmt/core.h>

#include "tools/bench/families/families.h"
#include "tools/bench/families/tuned.h"

namespace parallax::tools {

std::string falling_model(int horizon) {
  constexpr const char* kText = R"(; A plate is dropped {1} units above the ground.

range time 0 {0}
range offset 1 {0}
sort thing
thing Plate
sort height: integer
range height 0 {1}

fluent Falling(thing)
fluent Above(thing,height)
event Drop(thing)
event HitGround(thing)

[thing,time] Initiates(Drop(thing),Falling(thing),time).
[thing,height,time] Releases(Drop(thing),Above(thing,height),time).
[thing,time] Terminates(HitGround(thing),Falling(thing),time).
[thing,height,time]
HoldsAt(Above(thing,height),time) -> Initiates(HitGround(thing),Above(thing,height),time).

; One unit a step.
[thing,height1,height2,offset,time]
HoldsAt(Above(thing,height1),time) & height2=height1-offset ->
Trajectory(Falling(thing),time,Above(thing,height2),offset).

[thing,height1,height2,time]
HoldsAt(Above(thing,height1),time) & HoldsAt(Above(thing,height2),time) -> height1=height2.

Course: [thing,time]
HoldsAt(Falling(thing),time) & HoldsAt(Above(thing,0),time) -> Happens(HitGround(thing),time).
Course: Happens(Drop(Plate),0).
completion Course Happens

!HoldsAt(Falling(Plate),0).
HoldsAt(Above(Plate,{1}),0).
)";
  return fmt::format(kText, horizon, horizon - 2);
}

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
