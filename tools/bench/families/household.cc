#include "tools/bench/families/household.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstddef>
#include <string_view>
#include <utility>
#include <vector>

namespace parallax::tools {
namespace {

constexpr std::string_view kDeclarations = R"(sort item
sort kind
sort room
sort place
sort arm

item @ITEMS@
kind milk, cereal, bowl, spoon
room @ROOMS@
place @PLACES@, pFloor
arm left, right
range time 0 @STEPS@

predicate KindOf(item,kind)
predicate In(place,room)

fluent RobotAt(room)
fluent LookingAt(place)
fluent Parked(arm)
fluent Holding(arm,item)
fluent ItemAt(item,place)
fluent Perceived(item)
fluent BelievedAt(item,place)
fluent HandFree(arm)
fluent Occupied(place)
fluent Visible(item)
fluent Reachable(item)
noninertial HandFree, Occupied, Visible, Reachable

event Go(room)
event LookAt(place)
event ParkArm(arm)
event Detect(kind)
event PickUp(arm,item)
event PlaceAt(arm,item,place)
)";

constexpr std::string_view kWorld =
    R"([room1,room2,time] HoldsAt(RobotAt(room1),time) & HoldsAt(RobotAt(room2),time) -> room1=room2.
[time] {room} HoldsAt(RobotAt(room),time).
[place1,place2,time]
  HoldsAt(LookingAt(place1),time) & HoldsAt(LookingAt(place2),time) -> place1=place2.
[item,place1,place2,time]
  HoldsAt(ItemAt(item,place1),time) & HoldsAt(ItemAt(item,place2),time) -> place1=place2.
[arm,item1,item2,time]
  HoldsAt(Holding(arm,item1),time) & HoldsAt(Holding(arm,item2),time) -> item1=item2.
[arm1,arm2,item,time]
  HoldsAt(Holding(arm1,item),time) & HoldsAt(Holding(arm2,item),time) -> arm1=arm2.
[item,time] {place} HoldsAt(ItemAt(item,place),time) | {arm} HoldsAt(Holding(arm,item),time).
[arm,item,place,time] HoldsAt(Holding(arm,item),time) -> !HoldsAt(ItemAt(item,place),time).
[item,place1,place2,time]
  HoldsAt(BelievedAt(item,place1),time) & HoldsAt(BelievedAt(item,place2),time) -> place1=place2.
[item1,item2,place,time]
  HoldsAt(ItemAt(item1,place),time) & HoldsAt(ItemAt(item2,place),time) & place!=pFloor ->
    item1=item2.

[arm,time] HoldsAt(HandFree(arm),time) <-> !({item} HoldsAt(Holding(arm,item),time)).
[place,time] HoldsAt(Occupied(place),time) <-> ({item} HoldsAt(ItemAt(item,place),time)).
[item,time]
  HoldsAt(Reachable(item),time) <->
    ({room,place}
     HoldsAt(RobotAt(room),time) & HoldsAt(ItemAt(item,place),time) & In(place,room)).
[item,time]
  HoldsAt(Visible(item),time) <->
    ({room,place}
     HoldsAt(RobotAt(room),time) &
     HoldsAt(ItemAt(item,place),time) &
     In(place,room) &
     HoldsAt(LookingAt(place),time)).

[room,time]
  HoldsAt(Parked(left),time) & HoldsAt(Parked(right),time) ->
    Initiates(Go(room),RobotAt(room),time).
[room1,room2,time]
  HoldsAt(Parked(left),time) & HoldsAt(Parked(right),time) & room1!=room2 ->
    Terminates(Go(room1),RobotAt(room2),time).
[room,place,time]
  HoldsAt(Parked(left),time) & HoldsAt(Parked(right),time) & !HoldsAt(RobotAt(room),time) ->
    Terminates(Go(room),LookingAt(place),time).
[place,time]
  ({room} HoldsAt(RobotAt(room),time) & In(place,room)) ->
    Initiates(LookAt(place),LookingAt(place),time).
[place1,place2,time]
  ({room} HoldsAt(RobotAt(room),time) & In(place1,room)) & place1!=place2 ->
    Terminates(LookAt(place1),LookingAt(place2),time).
[arm,time] Initiates(ParkArm(arm),Parked(arm),time).

[item,kind,time]
  KindOf(item,kind) & HoldsAt(Visible(item),time) -> Initiates(Detect(kind),Perceived(item),time).
[item,kind,place,time]
  KindOf(item,kind) & HoldsAt(Visible(item),time) & HoldsAt(ItemAt(item,place),time) ->
    Initiates(Detect(kind),BelievedAt(item,place),time).
[item,kind,place1,place2,time]
  KindOf(item,kind) &
  HoldsAt(Visible(item),time) &
  HoldsAt(ItemAt(item,place1),time) &
  place1!=place2 ->
    Terminates(Detect(kind),BelievedAt(item,place2),time).
[item,kind,time]
  KindOf(item,kind) & !HoldsAt(Visible(item),time) ->
    Terminates(Detect(kind),Perceived(item),time).

[arm,item,time]
  HoldsAt(Perceived(item),time) & HoldsAt(Reachable(item),time) & HoldsAt(HandFree(arm),time) ->
    Initiates(PickUp(arm,item),Holding(arm,item),time).
[arm,item,place,time]
  HoldsAt(Perceived(item),time) &
  HoldsAt(Reachable(item),time) &
  HoldsAt(HandFree(arm),time) &
  HoldsAt(ItemAt(item,place),time) ->
    Terminates(PickUp(arm,item),ItemAt(item,place),time).
[arm,item,time] Terminates(PickUp(arm,item),Parked(arm),time).
[arm,item,place,time]
  HoldsAt(Perceived(item),time) &
  HoldsAt(Reachable(item),time) &
  HoldsAt(HandFree(arm),time) &
  HoldsAt(BelievedAt(item,place),time) ->
    Terminates(PickUp(arm,item),BelievedAt(item,place),time).

[arm,item,place,time]
  HoldsAt(Holding(arm,item),time) &
  ({room} HoldsAt(RobotAt(room),time) & In(place,room)) &
  !HoldsAt(Occupied(place),time) ->
    Initiates(PlaceAt(arm,item,place),ItemAt(item,place),time).
[arm,item,place,time]
  HoldsAt(Holding(arm,item),time) &
  ({room} HoldsAt(RobotAt(room),time) & In(place,room)) &
  !HoldsAt(Occupied(place),time) ->
    Terminates(PlaceAt(arm,item,place),Holding(arm,item),time).
[arm,item,place,time] Terminates(PlaceAt(arm,item,place),Parked(arm),time).
[arm,item,place,time]
  HoldsAt(Holding(arm,item),time) &
  ({room} HoldsAt(RobotAt(room),time) & In(place,room)) &
  !HoldsAt(Occupied(place),time) ->
    Initiates(PlaceAt(arm,item,place),BelievedAt(item,place),time).

)";

constexpr std::string_view kStart = R"(HoldsAt(RobotAt(r1),0).
[arm] HoldsAt(Parked(arm),0).
[arm,item] !HoldsAt(Holding(arm,item),0).
[place] !HoldsAt(LookingAt(place),0).
[item] !HoldsAt(Perceived(item),0).
[item,place] !HoldsAt(BelievedAt(item,place),0).
)";

constexpr std::string_view kBinding = R"BIND(motion going (:target name ?r) -> Go(?r)
    ok: RobotAt(?r) @t+1  else navigation-pose-unreachable
motion looking (:target name ?p) -> LookAt(?p)
    ok: LookingAt(?p) @t+1  else ptu-goal-unreachable
motion detecting (:object type ?y) -> Detect(?y)
    ok: {item} KindOf(item,?y) & Visible(item) @t  returns item ; else perception-object-not-found
action parking-arms (:arm ?a) -> ParkArm(?a)
    ok: Parked(?a) @t+1  else manipulation-goal-not-reached
action picking-up (:arm ?a :object ?o) -> PickUp(?a,?o)
    ok: Holding(?a,?o) @t+1  else manipulation-pose-unreachable
action placing (:arm ?a :object ?o :target name ?p) -> PlaceAt(?a,?o,?p)
    ok: ItemAt(?o,?p) @t+1  else manipulation-goal-not-reached
)BIND";

constexpr std::string_view kPlan = R"LISP((in-package :household)

(def-cram-function drive-to (?room)
  (exe:perform (desig:a motion (type going) (target (desig:a location (name ?room))))))

(def-cram-function park (?arm)
  (exe:perform (desig:an action (type parking-arms) (arm ?arm))))

(def-cram-function bring (?kind ?from-room ?from ?to-room ?to)
  (drive-to ?from-room)
  (exe:perform (desig:a motion (type looking) (target (desig:a location (name ?from)))))
  (cpl:with-failure-handling
      ((common-fail:perception-low-level-failure (e)
         (roslisp:ros-info (household) "not there: ~a" e)
         (return)))
    (let ((?object (exe:perform (desig:a motion (type detecting)
                                         (object (desig:an object (type ?kind)))))))
      (exe:perform (desig:an action (type picking-up) (arm left) (object ?object)))
      (park :left)
      (drive-to ?to-room)
      (exe:perform (desig:an action (type placing) (arm left) (object ?object)
                             (target (desig:a location (name ?to)))))
      (park :left))))

(def-top-level-cram-function tidy ())LISP";

constexpr const char* kKinds[] = {"milk", "cereal", "bowl", "spoon"};

struct Place {
  int room = 0;
  int number = 0;
  std::string name() const { return fmt::format("p{}c{}", room, number); }
};

const char* kind_of(int item) { return kKinds[item % 4]; }

std::string filled_in(std::string text, std::string_view mark, std::string_view by) {
  return text.replace(text.find(mark), mark.size(), by);
}

}  // namespace

Household household(int items, int rooms, int steps) {
  const int each = (items + rooms - 1) / rooms + 1;  // places of a room
  std::vector<std::string> item_names, room_names, place_names;
  std::vector<Place> where, free;  // of the items, of none
  for (int item = 0; item < items; ++item) {
    item_names.push_back(fmt::format("thing{}", item + 1));
    where.push_back({item % rooms + 1, item / rooms + 1});
  }
  std::string start{kStart};
  for (int room = 1; room <= rooms; ++room) {
    room_names.push_back(fmt::format("r{}", room));
    std::vector<std::string> here;
    for (int number = 1; number <= each; ++number) {
      const Place place{room, number};
      place_names.push_back(place.name());
      here.push_back("place=" + place.name());
      if ((number - 1) * rooms + room > items) free.push_back(place);
    }
    start += fmt::format("[place] In(place,r{}) <-> {}.\n", room, fmt::join(here, " | "));
  }
  for (int item = 0; item < items; ++item) {
    start += fmt::format(
        "[kind] KindOf(thing{0},kind) <-> kind={1}.\n"
        "HoldsAt(ItemAt(thing{0},{2}),0).\n",
        item + 1, kind_of(item), where[static_cast<std::size_t>(item)].name());
  }
  std::string plan{kPlan};
  for (int way = 0; way < steps / 8; ++way) {
    auto& from = where[static_cast<std::size_t>(way % items)];
    auto& to = free[static_cast<std::size_t>(way) % free.size()];
    plan += fmt::format("\n  (bring :{} :r{} :{} :r{} :{})", kind_of(way % items), from.room,
                        from.name(), to.room, to.name());
    std::swap(from, to);
  }
  auto text = filled_in(std::string(kDeclarations), "@ITEMS@",
                        fmt::format("{}", fmt::join(item_names, ", ")));
  text = filled_in(std::move(text), "@ROOMS@", fmt::format("{}", fmt::join(room_names, ", ")));
  text = filled_in(std::move(text), "@PLACES@", fmt::format("{}", fmt::join(place_names, ", ")));
  text = filled_in(std::move(text), "@STEPS@", std::to_string(steps));
  return {text + '\n' + std::string(kWorld) + start, std::string(kBinding), plan + ")\n"};
}

}  // namespace parallax::tools
