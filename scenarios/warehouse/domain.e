; A shelf with two slots is filled from two bins by a robot with two arms.

sort part
sort spot
sort base
sort arm

part crate, drum
spot binA, binB, slot1, slot2
base atBins, atShelf
arm left, right

predicate Serves(base,spot)

fluent RobotAt(base)
fluent LookingAt(spot)
fluent PartAt(part,spot)
fluent Holding(arm,part)
fluent Perceived(part)
fluent Parked(arm)

event Go(base)
event LookAt(spot)
event Detect(part)
event ParkArm(arm)
event PickUp(arm,part)
event Put(arm,part,spot)

[spot] Serves(atBins,spot) <-> spot=binA | spot=binB.
[spot] Serves(atShelf,spot) <-> spot=slot1 | spot=slot2.

; One place for the robot, one for its gaze, one for each part.
[time] {base} HoldsAt(RobotAt(base),time).
[base1,base2,time] HoldsAt(RobotAt(base1),time) & HoldsAt(RobotAt(base2),time) -> base1=base2.
[spot1,spot2,time] HoldsAt(LookingAt(spot1),time) & HoldsAt(LookingAt(spot2),time) -> spot1=spot2.
[part,time] {spot} HoldsAt(PartAt(part,spot),time) | {arm} HoldsAt(Holding(arm,part),time).
[part,spot1,spot2,time]
  HoldsAt(PartAt(part,spot1),time) & HoldsAt(PartAt(part,spot2),time) -> spot1=spot2.
[arm,part,spot,time] HoldsAt(Holding(arm,part),time) -> !HoldsAt(PartAt(part,spot),time).

[base,time] Initiates(Go(base),RobotAt(base),time).
[base1,base2,time] base1!=base2 -> Terminates(Go(base1),RobotAt(base2),time).
[base,spot,time] !HoldsAt(RobotAt(base),time) -> Terminates(Go(base),LookingAt(spot),time).

[base,spot,time]
  HoldsAt(RobotAt(base),time) & Serves(base,spot) -> Initiates(LookAt(spot),LookingAt(spot),time).
[base,spot1,spot2,time]
  HoldsAt(RobotAt(base),time) & Serves(base,spot1) & spot1!=spot2 ->
    Terminates(LookAt(spot1),LookingAt(spot2),time).

[part,spot,time]
  HoldsAt(PartAt(part,spot),time) & HoldsAt(LookingAt(spot),time) ->
    Initiates(Detect(part),Perceived(part),time).

[arm,part,base,spot,time]
  HoldsAt(Perceived(part),time) &
  HoldsAt(PartAt(part,spot),time) &
  HoldsAt(RobotAt(base),time) &
  Serves(base,spot) ->
    Initiates(PickUp(arm,part),Holding(arm,part),time).
[arm,part,base,spot,time]
  HoldsAt(Perceived(part),time) &
  HoldsAt(PartAt(part,spot),time) &
  HoldsAt(RobotAt(base),time) &
  Serves(base,spot) ->
    Terminates(PickUp(arm,part),PartAt(part,spot),time).

[arm,part,spot,base,time]
  HoldsAt(Holding(arm,part),time) & HoldsAt(RobotAt(base),time) & Serves(base,spot) ->
    Initiates(Put(arm,part,spot),PartAt(part,spot),time).
[arm,part,spot,base,time]
  HoldsAt(Holding(arm,part),time) & HoldsAt(RobotAt(base),time) & Serves(base,spot) ->
    Terminates(Put(arm,part,spot),Holding(arm,part),time).

[arm,time] Initiates(ParkArm(arm),Parked(arm),time).
[arm,part,time] Terminates(PickUp(arm,part),Parked(arm),time).
[arm,part,spot,time] Terminates(Put(arm,part,spot),Parked(arm),time).
