; What there is, what happens, and what it changes: a robot that drives between two regions and
; carries a box.

sort region
region near, far

fluent RobotIn(region)
fluent BoxIn(region)
fluent Holding()

event Go(region)
event PickUp()
event Place(region)

; The robot is in one region.
[time] {region} HoldsAt(RobotIn(region),time).
[region1,region2,time]
  HoldsAt(RobotIn(region1),time) & HoldsAt(RobotIn(region2),time) -> region1=region2.

; The box lies in one region, or it is held.
[time] HoldsAt(Holding(),time) | {region} HoldsAt(BoxIn(region),time).
[region,time] HoldsAt(Holding(),time) -> !HoldsAt(BoxIn(region),time).
[region1,region2,time]
  HoldsAt(BoxIn(region1),time) & HoldsAt(BoxIn(region2),time) -> region1=region2.

; Going arrives.
[region,time] Initiates(Go(region),RobotIn(region),time).
[region1,region2,time] region1!=region2 -> Terminates(Go(region1),RobotIn(region2),time).

; The box is picked up where the robot is.
[region,time]
  HoldsAt(RobotIn(region),time) & HoldsAt(BoxIn(region),time) -> Initiates(PickUp(),Holding(),time).
[region,time]
  HoldsAt(RobotIn(region),time) & HoldsAt(BoxIn(region),time) ->
    Terminates(PickUp(),BoxIn(region),time).

; What is held is placed where the robot is.
[region,time]
  HoldsAt(Holding(),time) & HoldsAt(RobotIn(region),time) ->
    Initiates(Place(region),BoxIn(region),time).
[region,time]
  HoldsAt(Holding(),time) & HoldsAt(RobotIn(region),time) ->
    Terminates(Place(region),Holding(),time).
