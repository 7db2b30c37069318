; The kitchen after the discrepancies: a base can be reached only while all drawers are closed, and
; an item that is not gripped firmly may or may not arrive.

load common.e

fluent PathClear(base)
fluent Secured(arm)
noninertial PathClear

event Regrip(arm)

[base,time] HoldsAt(PathClear(base),time) <-> !({drawer} HoldsAt(DrawerOpen(drawer),time)).

[base,time]
  HoldsAt(Parked(left),time) & HoldsAt(Parked(right),time) & HoldsAt(PathClear(base),time) ->
    Initiates(Go(base),RobotAt(base),time).
[base1,base2,time]
  HoldsAt(Parked(left),time) &
  HoldsAt(Parked(right),time) &
  HoldsAt(PathClear(base1),time) &
  base1!=base2 ->
    Terminates(Go(base1),RobotAt(base2),time).
[base,place,time]
  HoldsAt(Parked(left),time) &
  HoldsAt(Parked(right),time) &
  HoldsAt(PathClear(base),time) &
  !HoldsAt(RobotAt(base),time) ->
    Terminates(Go(base),LookingAt(place),time).

; Gripping again secures what is held; letting go ends that.
[arm,item,time] HoldsAt(Holding(arm,item),time) -> Initiates(Regrip(arm),Secured(arm),time).
[arm,item,place,time] Terminates(PlaceAt(arm,item,place),Secured(arm),time).
[arm,time] Terminates(OpenGripper(arm),Secured(arm),time).

; On the way an item that is not secured stays in the hand or falls to the floor: that it is at one
; of the two is a sentence of the common part.
[base,arm,item,time]
  HoldsAt(Holding(arm,item),time) & !HoldsAt(Secured(arm),time) ->
    Releases(Go(base),Holding(arm,item),time).
[base,arm,item,place,time]
  HoldsAt(Holding(arm,item),time) & !HoldsAt(Secured(arm),time) & place=pFloor ->
    Releases(Go(base),ItemAt(item,place),time).
