; What there is, what happens, and what it changes: a robot that carries a box from spot to spot.

sort spot
sort base
spot onTable, onShelf
base atTable, atShelf

predicate Serves(base,spot)
[base,spot] Serves(base,spot) <-> (base=atTable & spot=onTable) | (base=atShelf & spot=onShelf).

fluent RobotAt(base)
fluent LookingAt(spot)
fluent BoxAt(spot)
fluent Holding()
fluent Seen()
fluent Parked()

event Go(base)
event LookAt(spot)
event Detect()
event PickUp()
event Park()
event Put(spot)

; One place for the robot, one for its gaze, one for the box.
[time] {base} HoldsAt(RobotAt(base),time).
[base1,base2,time] HoldsAt(RobotAt(base1),time) & HoldsAt(RobotAt(base2),time) -> base1=base2.
[spot1,spot2,time] HoldsAt(LookingAt(spot1),time) & HoldsAt(LookingAt(spot2),time) -> spot1=spot2.
[time] HoldsAt(Holding(),time) | {spot} HoldsAt(BoxAt(spot),time).
[spot,time] HoldsAt(Holding(),time) -> !HoldsAt(BoxAt(spot),time).
[spot1,spot2,time] HoldsAt(BoxAt(spot1),time) & HoldsAt(BoxAt(spot2),time) -> spot1=spot2.

; Driving arrives, and the gaze is lost.
[base,time] Initiates(Go(base),RobotAt(base),time).
[base1,base2,time] base1!=base2 -> Terminates(Go(base1),RobotAt(base2),time).
[base,spot,time] !HoldsAt(RobotAt(base),time) -> Terminates(Go(base),LookingAt(spot),time).

; The robot looks at what its base serves.
[base,spot,time]
  HoldsAt(RobotAt(base),time) & Serves(base,spot) -> Initiates(LookAt(spot),LookingAt(spot),time).
[base,spot1,spot2,time]
  HoldsAt(RobotAt(base),time) & Serves(base,spot1) & spot1!=spot2 ->
    Terminates(LookAt(spot1),LookingAt(spot2),time).

; The box is seen where the robot looks, and picked up when it has been seen.
[spot,time]
  HoldsAt(BoxAt(spot),time) & HoldsAt(LookingAt(spot),time) -> Initiates(Detect(),Seen(),time).
[base,spot,time]
  HoldsAt(Seen(),time) &
  HoldsAt(BoxAt(spot),time) &
  HoldsAt(RobotAt(base),time) &
  Serves(base,spot) ->
    Initiates(PickUp(),Holding(),time).
[base,spot,time]
  HoldsAt(Seen(),time) &
  HoldsAt(BoxAt(spot),time) &
  HoldsAt(RobotAt(base),time) &
  Serves(base,spot) ->
    Terminates(PickUp(),BoxAt(spot),time).

[spot,time]
  HoldsAt(BoxAt(spot),time) & !HoldsAt(LookingAt(spot),time) -> Terminates(Detect(),Seen(),time).

; The arm is parked for driving.
[time] Initiates(Park(),Parked(),time).
[time] Terminates(PickUp(),Parked(),time).
[spot,time] Terminates(Put(spot),Parked(),time).

; What is held is put where the base serves.
[base,spot,time]
  HoldsAt(Holding(),time) & HoldsAt(RobotAt(base),time) & Serves(base,spot) ->
    Initiates(Put(spot),BoxAt(spot),time).
[base,spot,time]
  HoldsAt(Holding(),time) & HoldsAt(RobotAt(base),time) & Serves(base,spot) ->
    Terminates(Put(spot),Holding(),time).
