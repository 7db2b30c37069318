; Two rooms, a robot, a crate. The model believes that the way between the rooms is free wherever
; the robot stands.

sort room
room front, back

fluent RobotIn(room)
fluent CrateIn(room)
fluent Holding()

event Go(room)
event PickUp()
event Place(room)

[time] {room} HoldsAt(RobotIn(room),time).
[room1,room2,time] HoldsAt(RobotIn(room1),time) & HoldsAt(RobotIn(room2),time) -> room1=room2.
[time] HoldsAt(Holding(),time) | {room} HoldsAt(CrateIn(room),time).
[room,time] HoldsAt(Holding(),time) -> !HoldsAt(CrateIn(room),time).
[room1,room2,time] HoldsAt(CrateIn(room1),time) & HoldsAt(CrateIn(room2),time) -> room1=room2.

[room,time] Initiates(Go(room),RobotIn(room),time).
[room1,room2,time] room1!=room2 -> Terminates(Go(room1),RobotIn(room2),time).

[room,time]
  HoldsAt(RobotIn(room),time) & HoldsAt(CrateIn(room),time) -> Initiates(PickUp(),Holding(),time).
[room,time]
  HoldsAt(RobotIn(room),time) & HoldsAt(CrateIn(room),time) ->
    Terminates(PickUp(),CrateIn(room),time).

[room,time]
  HoldsAt(Holding(),time) & HoldsAt(RobotIn(room),time) ->
    Initiates(Place(room),CrateIn(room),time).
[room,time]
  HoldsAt(Holding(),time) & HoldsAt(RobotIn(room),time) -> Terminates(Place(room),Holding(),time).

HoldsAt(RobotIn(front),0).
HoldsAt(CrateIn(back),0).
