; The kitchen after the discrepancies: a base can be reached only while all drawers are closed, and
; an item that is not gripped firmly may or may not arrive.

load common.e

fluent PathClear(base)
fluent Secured(arm)
noninertial PathClear

predicate Beside(place,place)

event Regrip(arm)

; The camera sees what is where it looks, and may see what is on the next cell of the counter.
[item,place,time]
  HoldsAt(LookingAt(place),time) &
  HoldsAt(ItemAt(item,place),time) &
  HoldsAt(Accessible(place),time) &
  ({base} HoldsAt(RobotAt(base),time) & Serves(base,place)) ->
    HoldsAt(Visible(item),time).
[item,time]
  HoldsAt(Visible(item),time) ->
    ({base,place1,place2}
     HoldsAt(RobotAt(base),time) &
     HoldsAt(ItemAt(item,place1),time) &
     Serves(base,place1) &
     HoldsAt(Accessible(place1),time) &
     HoldsAt(LookingAt(place2),time) &
     (place1=place2 | Beside(place1,place2))).
[place1,place2]
  Beside(place1,place2) <->
    place1=pw1 & place2=pw2 |
    place1=pw2 & place2=pw1 |
    place1=pw2 & place2=pw3 |
    place1=pw3 & place2=pw2.

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
