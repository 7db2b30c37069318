; Two regions on a line, a robot and a box. The robot drives from region to region, picks the
; box up where it stands, and places what it holds.

sort region
region r1, r2

fluent RobotIn(region)
fluent BoxIn(region)
fluent Holding()

event Go(region)
event PickUp()
event Place(region)

; The robot is in exactly one region.
[time] {region} HoldsAt(RobotIn(region),time).
[region1,region2,time]
  HoldsAt(RobotIn(region1),time) & HoldsAt(RobotIn(region2),time) -> region1=region2.

; The box lies in exactly one region, or it is held.
[time] HoldsAt(Holding(),time) | {region} HoldsAt(BoxIn(region),time).
[region,time] HoldsAt(Holding(),time) -> !HoldsAt(BoxIn(region),time).
[region1,region2,time]
  HoldsAt(BoxIn(region1),time) & HoldsAt(BoxIn(region2),time) -> region1=region2.

; Going always arrives.
[region,time] Initiates(Go(region),RobotIn(region),time).
[region1,region2,time] region1!=region2 -> Terminates(Go(region1),RobotIn(region2),time).

; The box can be picked up by a robot in the same region whose gripper is empty.
[region,time]
  HoldsAt(RobotIn(region),time) & HoldsAt(BoxIn(region),time) -> Initiates(PickUp(),Holding(),time).
[region,time]
  HoldsAt(RobotIn(region),time) & HoldsAt(BoxIn(region),time) ->
    Terminates(PickUp(),BoxIn(region),time).

; Placing puts what is held down in the region that the target lies in, if the robot is there.
[region,time]
  HoldsAt(Holding(),time) & HoldsAt(RobotIn(region),time) ->
    Initiates(Place(region),BoxIn(region),time).
[region,time]
  HoldsAt(Holding(),time) & HoldsAt(RobotIn(region),time) ->
    Terminates(Place(region),Holding(),time).
