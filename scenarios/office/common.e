; An office: a tea kitchen at the end of a corridor, and a room behind a door that turns on a hinge. A
; robot with one arm fetches a mug from the desk in the room. Everything but which ways are barred,
; where the door is opened from and what is within reach, which `first.e` and `repaired.e` add in two
; versions. A commanded action always happens; where its condition does not hold it changes nothing.

sort base
sort spot
sort view
sort item
sort door

base kitchen, corridor, front, aside, room, desk, lane, window
spot deskFront, deskBack, counterTop, ground
view deskTop
item mug1
door officeDoor

predicate Leads(base,base)
predicate Way(base,base)
predicate Serves(base,spot)
predicate Sees(base,view)
predicate Shows(view,spot)
predicate Beside(base,door)

fluent RobotAt(base)
fluent LookingAt(view)
fluent ItemAt(item,spot)
fluent Holding(item)
fluent Perceived(item)
fluent Parked()
fluent DoorOpen(door)
fluent Barred(base,base)
noninertial Barred

event Go(base)
event LookAt(view)
event Detect(item)
event ParkArm()
event PickUp(item)
event Put(item,spot)
event OpenDoor(door)
event CloseDoor(door)

; The straight ways of the floor plan, in either direction.
[base1,base2]
  Leads(base1,base2) <->
    base1=kitchen & base2=corridor |
    base1=kitchen & base2=front |
    base1=corridor & base2=front |
    base1=corridor & base2=aside |
    base1=front & base2=aside |
    base1=front & base2=room |
    base1=room & base2=desk |
    base1=room & base2=lane |
    base1=lane & base2=window.
[base1,base2] Way(base1,base2) <-> Leads(base1,base2) | Leads(base2,base1).

; What is to be seen from where.
[base,view] Sees(base,view) <-> base=desk | base=window.
[view,spot] Shows(view,spot) <-> spot=deskFront | spot=deskBack.

; The robot is at one base, its gaze on at most one view, the mug at one spot or in the hand.
[time] {base} HoldsAt(RobotAt(base),time).
[base1,base2,time] HoldsAt(RobotAt(base1),time) & HoldsAt(RobotAt(base2),time) -> base1=base2.
[view1,view2,time] HoldsAt(LookingAt(view1),time) & HoldsAt(LookingAt(view2),time) -> view1=view2.
[item,time] {spot} HoldsAt(ItemAt(item,spot),time) | HoldsAt(Holding(item),time).
[item,spot1,spot2,time]
  HoldsAt(ItemAt(item,spot1),time) & HoldsAt(ItemAt(item,spot2),time) -> spot1=spot2.
[item,spot,time] HoldsAt(Holding(item),time) -> !HoldsAt(ItemAt(item,spot),time).

; Driving, with a parked arm, along a way that nothing bars.
[base1,base2,time]
  HoldsAt(Parked(),time) &
  HoldsAt(RobotAt(base1),time) &
  Way(base1,base2) &
  !HoldsAt(Barred(base1,base2),time) ->
    Initiates(Go(base2),RobotAt(base2),time).
[base1,base2,time]
  HoldsAt(Parked(),time) &
  HoldsAt(RobotAt(base1),time) &
  Way(base1,base2) &
  !HoldsAt(Barred(base1,base2),time) ->
    Terminates(Go(base2),RobotAt(base1),time).
[base1,base2,view,time]
  HoldsAt(Parked(),time) &
  HoldsAt(RobotAt(base1),time) &
  Way(base1,base2) &
  !HoldsAt(Barred(base1,base2),time) ->
    Terminates(Go(base2),LookingAt(view),time).

; Looking.
[base,view,time]
  HoldsAt(RobotAt(base),time) & Sees(base,view) -> Initiates(LookAt(view),LookingAt(view),time).
[item,spot,view,time]
  HoldsAt(ItemAt(item,spot),time) & HoldsAt(LookingAt(view),time) & Shows(view,spot) ->
    Initiates(Detect(item),Perceived(item),time).
[item,time]
  !({spot,view}
    HoldsAt(ItemAt(item,spot),time) & HoldsAt(LookingAt(view),time) & Shows(view,spot)) ->
    Terminates(Detect(item),Perceived(item),time).

; The hand.
[time] Initiates(ParkArm(),Parked(),time).
[item,spot,base,time]
  HoldsAt(Perceived(item),time) &
  HoldsAt(ItemAt(item,spot),time) &
  HoldsAt(RobotAt(base),time) &
  Serves(base,spot) ->
    Initiates(PickUp(item),Holding(item),time).
[item,spot,base,time]
  HoldsAt(Perceived(item),time) &
  HoldsAt(ItemAt(item,spot),time) &
  HoldsAt(RobotAt(base),time) &
  Serves(base,spot) ->
    Terminates(PickUp(item),ItemAt(item,spot),time).
[item,spot,base,time]
  HoldsAt(Perceived(item),time) &
  HoldsAt(ItemAt(item,spot),time) &
  HoldsAt(RobotAt(base),time) &
  Serves(base,spot) ->
    Terminates(PickUp(item),Parked(),time).
[item,spot,base,time]
  HoldsAt(Holding(item),time) & HoldsAt(RobotAt(base),time) & Serves(base,spot) ->
    Initiates(Put(item,spot),ItemAt(item,spot),time).
[item,spot,base,time]
  HoldsAt(Holding(item),time) & HoldsAt(RobotAt(base),time) & Serves(base,spot) ->
    Terminates(Put(item,spot),Holding(item),time).
[item,spot,base,time]
  HoldsAt(Holding(item),time) & HoldsAt(RobotAt(base),time) & Serves(base,spot) ->
    Terminates(Put(item,spot),Parked(),time).

; The door. It is opened by an empty hand, and shut by any: one that holds something pushes it.
[door,base,time]
  HoldsAt(RobotAt(base),time) & Beside(base,door) & !({item} HoldsAt(Holding(item),time)) ->
    Initiates(OpenDoor(door),DoorOpen(door),time).
[door,base,time]
  HoldsAt(RobotAt(base),time) &
  Beside(base,door) &
  !({item} HoldsAt(Holding(item),time)) &
  !HoldsAt(DoorOpen(door),time) ->
    Terminates(OpenDoor(door),Parked(),time).
[door,base,time]
  HoldsAt(RobotAt(base),time) & Beside(base,door) ->
    Terminates(CloseDoor(door),DoorOpen(door),time).
[door,base,time]
  HoldsAt(RobotAt(base),time) & Beside(base,door) & HoldsAt(DoorOpen(door),time) ->
    Terminates(CloseDoor(door),Parked(),time).
