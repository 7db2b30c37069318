#include <fmt/core.h>

#include "tools/bench/families/families.h"
#include "tools/bench/families/tuned.h"

namespace parallax::tools {
namespace {

constexpr const char* kRobotWorld =
    R"(; A robot carries {0} things along a row of {1} rooms, {2} steps.

range time 0 {2}
sort room: integer
range room 1 {1}
sort thing
thing {3}

fluent Robot(room)
fluent LiesIn(thing,room)
fluent Carries(thing)
event Enter(room)
event Grasp(thing)
event Drop(thing)

; Effects. Where a carried thing is follows from where the robot is.
[room,time] Initiates(Enter(room),Robot(room),time).
[room1,room2,time]
HoldsAt(Robot(room1),time) & room1!=room2 -> Terminates(Enter(room2),Robot(room1),time).
[thing,time] Initiates(Grasp(thing),Carries(thing),time).
[thing,room,time] Releases(Grasp(thing),LiesIn(thing,room),time).
[thing,time] Terminates(Drop(thing),Carries(thing),time).
[thing,room,time] HoldsAt(Robot(room),time) -> Initiates(Drop(thing),LiesIn(thing,room),time).
[thing,room,time] !HoldsAt(Robot(room),time) -> Terminates(Drop(thing),LiesIn(thing,room),time).

[thing,room,time]
HoldsAt(Carries(thing),time) & HoldsAt(Robot(room),time) -> HoldsAt(LiesIn(thing,room),time).
[thing,room1,room2,time]
HoldsAt(LiesIn(thing,room1),time) & HoldsAt(LiesIn(thing,room2),time) -> room1=room2.

; One thing is done at a time: into the next room, grasp what is here, drop what is carried.
[event1,event2,time] Happens(event1,time) & Happens(event2,time) -> event1=event2.
[room,time]
Happens(Enter(room),time) -> ({{room1}} HoldsAt(Robot(room1),time) & (room=room1+1 | room1=room+1)).
[thing,time]
Happens(Grasp(thing),time) -> ({{room}} HoldsAt(Robot(room),time) & HoldsAt(LiesIn(thing,room),time)).
[thing1,thing2,time] Happens(Grasp(thing1),time) -> !HoldsAt(Carries(thing2),time).
[thing,time] Happens(Drop(thing),time) -> HoldsAt(Carries(thing),time).

[room] HoldsAt(Robot(room),0) <-> room=1.
[thing] !HoldsAt(Carries(thing),0).
)";

}  // namespace

std::string roaming_model(int rooms, int things, int horizon) {
  std::string text =
      fmt::format(kRobotWorld, things, rooms, horizon, numbered_names("Thing", things));
  for (int thing = 1; thing <= things; ++thing) {
    text += fmt::format("[room] HoldsAt(LiesIn(Thing{},room),0) <-> room={}.\n", thing,
                        first_room(thing, rooms));
  }
  return text;
}

std::string robot_model(int rooms, int things, int slack) {
  const int horizon = things * (rooms + 1) + slack;
  std::string text = roaming_model(rooms, things, horizon);
  text += fmt::format("\n; The goal.\n[thing] !HoldsAt(Carries(thing),{}).\n", horizon);
  for (int thing = 1; thing <= things; ++thing) {
    text += fmt::format("HoldsAt(LiesIn(Thing{},{}),{}).\n", thing,
                        rooms + 1 - first_room(thing, rooms), horizon);
  }
  return text;
}

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
