// Worlds of many bodies: what planning contests ask, as models of the calculus.

#include <fmt/core.h>

#include <algorithm>
#include <vector>

#include "tools/bench/families/families.h"
#include "tools/bench/families/tuned.h"

namespace parallax::tools {
namespace {

/// Goals at timepoint `when`, one after the other.
std::string all_at(const std::vector<std::string>& fluents, const std::string& when) {
  std::string text;
  for (const auto& fluent : fluents) {
    text += fmt::format("{}HoldsAt({},{})", text.empty() ? "" : " & ", fluent, when);
  }
  return text;
}

std::string with_goal(const std::string& world, const std::vector<std::string>& goals,
                      int horizon) {
  auto text = world + "\n; The goal.\n";
  for (const auto& goal : goals) text += fmt::format("HoldsAt({},{}).\n", goal, horizon);
  return text;
}

constexpr const char* kGridWorld =
    R"(; {0} robots on a grid of {1} times {1} cells, which lie row by row. Any number of them moves
; at a time; no two stand on one cell, and none pass through each other.

range time 0 {2}
sort robot
robot {3}
sort cell: integer
range cell 1 {4}
predicate Near(cell,cell)
fluent At(robot,cell)
event Move(robot,cell)

[cell1,cell2]
Near(cell1,cell2) <->
(cell2=cell1+{1} | cell1=cell2+{1} | (cell2=cell1+1 & cell1%{1}!=0) | (cell1=cell2+1 & cell2%{1}!=0)).

[robot,cell,time] Initiates(Move(robot,cell),At(robot,cell),time).
[robot,cell1,cell2,time]
HoldsAt(At(robot,cell1),time) & cell1!=cell2 -> Terminates(Move(robot,cell2),At(robot,cell1),time).

[robot,cell,time]
Happens(Move(robot,cell),time) -> ({{cell1}} HoldsAt(At(robot,cell1),time) & Near(cell1,cell)).
[robot,cell1,cell2,time]
Happens(Move(robot,cell1),time) & Happens(Move(robot,cell2),time) -> cell1=cell2.
[robot1,robot2,cell,time]
HoldsAt(At(robot1,cell),time) & HoldsAt(At(robot2,cell),time) -> robot1=robot2.
[robot1,robot2,cell1,cell2,time]
Happens(Move(robot1,cell2),time) & HoldsAt(At(robot1,cell1),time) &
Happens(Move(robot2,cell1),time) & HoldsAt(At(robot2,cell2),time) -> robot1=robot2.

)";

/// The robots start evenly spread over the cells, in their order.
int start_cell(int robot, int width, int robots) {
  return (robot - 1) * width * width / robots + 1;
}

/// Opposite of where it starts.
int goal_cell(int robot, int width, int robots) {
  return width * width + 1 - start_cell(robot, width, robots);
}

std::vector<std::string> grid_goals(int width, int robots) {
  std::vector<std::string> goals;
  for (int robot = 1; robot <= robots; ++robot) {
    goals.push_back(fmt::format("At(R{},{})", robot, goal_cell(robot, width, robots)));
  }
  return goals;
}

constexpr const char* kHanoiWorld = R"(; {0} discs on three pegs, {1} steps.

range time 0 {1}
sort disc: integer
range disc 1 {0}
sort peg
peg Left, Middle, Right
fluent On(disc,peg)
event Move(disc,peg)

[disc,peg,time] Initiates(Move(disc,peg),On(disc,peg),time).
[disc,peg1,peg2,time]
HoldsAt(On(disc,peg1),time) & peg1!=peg2 -> Terminates(Move(disc,peg2),On(disc,peg1),time).

; One disc is moved at a time, onto another peg; no smaller one lies on it or on that peg.
[event1,event2,time] Happens(event1,time) & Happens(event2,time) -> event1=event2.
[disc,peg,time] Happens(Move(disc,peg),time) -> !HoldsAt(On(disc,peg),time).
[disc1,disc2,peg,time]
Happens(Move(disc1,peg),time) & disc2<disc1 -> !HoldsAt(On(disc2,peg),time).
[disc1,disc2,peg1,peg2,time]
Happens(Move(disc1,peg1),time) & disc2<disc1 & HoldsAt(On(disc1,peg2),time) ->
!HoldsAt(On(disc2,peg2),time).

[disc,peg] HoldsAt(On(disc,peg),0) <-> peg=Left.
)";

std::vector<std::string> hanoi_goals(int discs) {
  std::vector<std::string> goals;
  for (int disc = 1; disc <= discs; ++disc) goals.push_back(fmt::format("On({},Right)", disc));
  return goals;
}

constexpr const char* kLogisticsWorld =
    R"(; {0} packages, {1} trucks that carry one each, {2} places, {3} steps. Trucks go at once.

range time 0 {3}
sort package
package {4}
sort truck
truck {5}
sort place
place {6}
fluent Lies(package,place)
fluent In(package,truck)
fluent Parks(truck,place)
event Drive(truck,place)
event Load(package,truck)
event Unload(package,truck)

[truck,place,time] Initiates(Drive(truck,place),Parks(truck,place),time).
[truck,place1,place2,time]
HoldsAt(Parks(truck,place1),time) & place1!=place2 ->
Terminates(Drive(truck,place2),Parks(truck,place1),time).
[package,truck,time] Initiates(Load(package,truck),In(package,truck),time).
[package,truck,place,time]
HoldsAt(Lies(package,place),time) -> Terminates(Load(package,truck),Lies(package,place),time).
[package,truck,time] Terminates(Unload(package,truck),In(package,truck),time).
[package,truck,place,time]
HoldsAt(Parks(truck,place),time) -> Initiates(Unload(package,truck),Lies(package,place),time).

; A truck does one thing at a time.
[truck,place,time] Happens(Drive(truck,place),time) -> !HoldsAt(Parks(truck,place),time).
[truck,place1,place2,time]
Happens(Drive(truck,place1),time) & Happens(Drive(truck,place2),time) -> place1=place2.
[package,truck,place,time] Happens(Drive(truck,place),time) -> !Happens(Load(package,truck),time).
[package,truck,place,time]
Happens(Drive(truck,place),time) -> !Happens(Unload(package,truck),time).
[package1,package2,truck,time]
Happens(Load(package1,truck),time) & Happens(Load(package2,truck),time) -> package1=package2.
[package,truck1,truck2,time]
Happens(Load(package,truck1),time) & Happens(Load(package,truck2),time) -> truck1=truck2.
[package,truck,time]
Happens(Unload(package,truck),time) -> HoldsAt(In(package,truck),time).
[package1,package2,truck,time]
Happens(Load(package1,truck),time) -> !HoldsAt(In(package2,truck),time).
[package,truck,time]
Happens(Load(package,truck),time) ->
({{place}} HoldsAt(Lies(package,place),time) & HoldsAt(Parks(truck,place),time)).

[package,truck] !HoldsAt(In(package,truck),0).
[truck,place] HoldsAt(Parks(truck,place),0) <-> place=Place1.
)";

/// Packages start at the places by turns.
int start_place(int package, int places) { return (package - 1) % places + 1; }

/// One place on; a second one from the same place goes two on, and so forth.
int goal_place(int package, int places) {
  return (start_place(package, places) + (package - 1) / places) % places + 1;
}

std::vector<std::string> logistics_goals(int packages, int places) {
  std::vector<std::string> goals;
  for (int package = 1; package <= packages; ++package) {
    goals.push_back(fmt::format("Lies(Package{},Place{})", package, goal_place(package, places)));
  }
  return goals;
}

}  // namespace

FamilyTask grid_task(int width, int robots, int horizon) {
  auto world =
      fmt::format(kGridWorld, robots, width, horizon, numbered_names("R", robots), width * width);
  for (int robot = 1; robot <= robots; ++robot) {
    world += fmt::format("[cell] HoldsAt(At(R{},cell),0) <-> cell={}.\n", robot,
                         start_cell(robot, width, robots));
  }
  const auto goals = grid_goals(width, robots);
  return {world, all_at(goals, "time"), with_goal(world, goals, horizon)};
}

FamilyTask hanoi_task(int discs, int horizon) {
  const auto world = fmt::format(kHanoiWorld, discs, horizon);
  const auto goals = hanoi_goals(discs);
  return {world, all_at(goals, "time"), with_goal(world, goals, horizon)};
}

FamilyTask logistics_task(int packages, int trucks, int places, int horizon) {
  auto world = fmt::format(kLogisticsWorld, packages, trucks, places, horizon,
                           numbered_names("Package", packages), numbered_names("Truck", trucks),
                           numbered_names("Place", places));
  for (int package = 1; package <= packages; ++package) {
    world += fmt::format("[place] HoldsAt(Lies(Package{},place),0) <-> place=Place{}.\n", package,
                         start_place(package, places));
  }
  const auto goals = logistics_goals(packages, places);
  return {world, all_at(goals, "time"), with_goal(world, goals, horizon)};
}

// As one would write them for clingo: the start as facts, so that the grounder derives atoms that
// can be reached only.

std::string tuned_grid(int width, int robots, int horizon) {
  constexpr const char* kText = R"(#const horizon = {3}.
step(0..horizon-1).
cell(1..{0}).
near(C,C+{1}) :- cell(C), cell(C+{1}).
near(C,C+1) :- cell(C), cell(C+1), C\{1} != 0.
near(C,D) :- near(D,C).
{{ happens(move(R,C),T) : near(D,C) }} 1 :- holds(at(R,D),T), step(T).
moves(R,T) :- happens(move(R,C),T).
holds(at(R,C),T+1) :- happens(move(R,C),T).
holds(at(R,C),T+1) :- holds(at(R,C),T), step(T), not moves(R,T).
:- holds(at(R,C),T), holds(at(S,C),T), R < S.
:- near(C,D), happens(move(R,C),T), holds(at(R,D),T), happens(move(S,D),T), holds(at(S,C),T),
   R < S.
#show holds/2.
#show happens/2.
)";
  auto text = fmt::format(kText, width * width, width, robots, horizon);
  for (int robot = 1; robot <= robots; ++robot) {
    text += fmt::format("holds(at({0},{1}),0).\n:- not holds(at({0},{2}),horizon).\n", robot,
                        start_cell(robot, width, robots), goal_cell(robot, width, robots));
  }
  return text;
}

std::string tuned_hanoi(int discs, int horizon) {
  constexpr const char* kText = R"(#const horizon = {1}.
step(0..horizon-1).
disc(1..{0}).
peg(1..3).
{{ happens(move(D,P),T) : disc(D), peg(P) }} 1 :- step(T).
moves(D,T) :- happens(move(D,P),T).
holds(on(D,P),T+1) :- happens(move(D,P),T).
holds(on(D,P),T+1) :- holds(on(D,P),T), step(T), not moves(D,T).
:- happens(move(D,P),T), holds(on(D,P),T).
:- happens(move(D,P),T), holds(on(E,P),T), E < D.
:- happens(move(D,P),T), holds(on(D,Q),T), holds(on(E,Q),T), E < D.
holds(on(D,1),0) :- disc(D).
:- disc(D), not holds(on(D,3),horizon).
#show holds/2.
#show happens/2.
)";
  return fmt::format(kText, discs, horizon);
}

std::string tuned_logistics(int packages, int trucks, int places, int horizon) {
  constexpr const char* kText = R"(#const horizon = {3}.
step(0..horizon-1).
package(1..{0}).
truck(1..{1}).
place(1..{2}).
{{ happens(drive(K,L),T) : place(L) }} 1 :- truck(K), step(T).
{{ happens(load(P,K),T) : holds(lies(P,L),T) }} 1 :- holds(parks(K,L),T), step(T).
{{ happens(unload(P,K),T) }} :- holds(in(P,K),T), step(T).
drives(K,T) :- happens(drive(K,L),T).
loaded(P,T) :- happens(load(P,K),T).
holds(parks(K,L),T+1) :- happens(drive(K,L),T).
holds(parks(K,L),T+1) :- holds(parks(K,L),T), step(T), not drives(K,T).
holds(in(P,K),T+1) :- happens(load(P,K),T).
holds(in(P,K),T+1) :- holds(in(P,K),T), step(T), not happens(unload(P,K),T).
holds(lies(P,L),T+1) :- happens(unload(P,K),T), holds(parks(K,L),T).
holds(lies(P,L),T+1) :- holds(lies(P,L),T), step(T), not loaded(P,T).
:- happens(drive(K,L),T), holds(parks(K,L),T).
:- happens(drive(K,L),T), happens(load(P,K),T).
:- happens(drive(K,L),T), happens(unload(P,K),T).
:- happens(load(P,K),T), happens(load(P,M),T), K < M.
:- happens(load(P,K),T), holds(in(Q,K),T).
:- happens(load(P,K),T), holds(parks(K,L),T), not holds(lies(P,L),T).
holds(parks(K,1),0) :- truck(K).
#show holds/2.
#show happens/2.
)";
  auto text = fmt::format(kText, packages, trucks, places, horizon);
  for (int package = 1; package <= packages; ++package) {
    text += fmt::format("holds(lies({0},{1}),0).\n:- not holds(lies({0},{2}),horizon).\n", package,
                        start_place(package, places), goal_place(package, places));
  }
  return text;
}

}  // namespace parallax::tools
