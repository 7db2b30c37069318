#include <fmt/core.h>

#include "tools/bench/families/families.h"

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

}  // namespace parallax::tools
