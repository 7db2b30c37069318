#include <fmt/core.h>

#include "tools/bench/families/object_names.h"
#include "tools/bench/families/tuned.h"

namespace parallax::tools {
namespace {

constexpr const char* kTunedRobotWorld = R"(room(1..{}).
thing(1..{}).
fluent(robot(R)) :- room(R).
fluent(lies(X,R)) :- thing(X), room(R).
fluent(carries(X)) :- thing(X).

% At most one thing is done at a time, and only what can be done.
{{ happens(enter(R),T) : room(R);
  happens(grasp(X),T) : thing(X);
  happens(drop(X),T) : thing(X) }} 1 :- step(T).
:- happens(enter(R),T), not holds(robot(R-1),T), not holds(robot(R+1),T).
:- happens(grasp(X),T), holds(robot(R),T), not holds(lies(X,R),T).
:- happens(grasp(X),T), holds(carries(Y),T).
:- happens(drop(X),T), not holds(carries(X),T).

initiates(enter(R),robot(R),T) :- happens(enter(R),T).
terminates(enter(R),robot(Q),T) :- happens(enter(R),T), holds(robot(Q),T), Q != R.
initiates(grasp(X),carries(X),T) :- happens(grasp(X),T).
releases(grasp(X),lies(X,R),T) :- happens(grasp(X),T), room(R).
terminates(drop(X),carries(X),T) :- happens(drop(X),T).
initiates(drop(X),lies(X,R),T) :- happens(drop(X),T), holds(robot(R),T).
terminates(drop(X),lies(X,R),T) :- happens(drop(X),T), room(R), not holds(robot(R),T).
:- holds(carries(X),T), holds(robot(R),T), not holds(lies(X,R),T).
:- holds(lies(X,R),T), holds(lies(X,Q),T), R < Q.

:- not holds(robot(1),0).
:- holds(robot(R),0), R != 1.
:- holds(carries(X),0).
)";

}  // namespace

std::string tuned_roaming(int rooms, int things, int horizon) {
  std::string text = tuned_calculus(horizon) + fmt::format(kTunedRobotWorld, rooms, things);
  for (int thing = 1; thing <= things; ++thing) {
    text += fmt::format(":- not holds(lies({0},{1}),0).\n:- holds(lies({0},R),0), R != {1}.\n",
                        thing, first_room(thing, rooms));
  }
  return text;
}

std::string tuned_robot(int rooms, int things, int slack) {
  auto text = tuned_roaming(rooms, things, things * (rooms + 1) + slack) +
              ":- holds(carries(X),horizon).\n";
  for (int thing = 1; thing <= things; ++thing) {
    text += fmt::format(":- not holds(lies({},{}),horizon).\n", thing,
                        rooms + 1 - first_room(thing, rooms));
  }
  return text;
}

}  // namespace parallax::tools
