; What there is, what happens, and what it changes: a robot that fetches a tin from a drawer.

sort spot
sort base
spot inDrawer, onCounter
base atCounter, aside

fluent RobotAt(base)
fluent LookingAt(spot)
fluent TinAt(spot)
fluent Holding()
fluent Seen()
fluent Parked()
fluent DrawerOpen()

event Go(base)
event LookAt(spot)
event Detect()
event OpenDrawer()
event CloseDrawer()
event PickUp()
event Park()
event Put(spot)

; One place for the robot, one for its gaze, one for the tin.
[time] {base} HoldsAt(RobotAt(base),time).
[base1,base2,time] HoldsAt(RobotAt(base1),time) & HoldsAt(RobotAt(base2),time) -> base1=base2.
[spot1,spot2,time] HoldsAt(LookingAt(spot1),time) & HoldsAt(LookingAt(spot2),time) -> spot1=spot2.
[time] HoldsAt(Holding(),time) | {spot} HoldsAt(TinAt(spot),time).
[spot,time] HoldsAt(Holding(),time) -> !HoldsAt(TinAt(spot),time).
[spot1,spot2,time] HoldsAt(TinAt(spot1),time) & HoldsAt(TinAt(spot2),time) -> spot1=spot2.

; Driving arrives, and the gaze is lost.
[base,time] Initiates(Go(base),RobotAt(base),time).
[base1,base2,time] base1!=base2 -> Terminates(Go(base1),RobotAt(base2),time).
[base,spot,time] !HoldsAt(RobotAt(base),time) -> Terminates(Go(base),LookingAt(spot),time).

; The robot looks where it is told to, and works from the counter.
[spot,time] HoldsAt(RobotAt(atCounter),time) -> Initiates(LookAt(spot),LookingAt(spot),time).
[spot1,spot2,time]
  HoldsAt(RobotAt(atCounter),time) & spot1!=spot2 ->
    Terminates(LookAt(spot1),LookingAt(spot2),time).

; An empty hand opens the drawer; any hand pushes it shut.
[time]
  HoldsAt(RobotAt(atCounter),time) & !HoldsAt(Holding(),time) ->
    Initiates(OpenDrawer(),DrawerOpen(),time).
[time]
  HoldsAt(RobotAt(atCounter),time) & !HoldsAt(Holding(),time) ->
    Terminates(OpenDrawer(),Parked(),time).
[time] HoldsAt(RobotAt(atCounter),time) -> Terminates(CloseDrawer(),DrawerOpen(),time).
[time] HoldsAt(RobotAt(atCounter),time) -> Terminates(CloseDrawer(),Parked(),time).
[time] Initiates(Park(),Parked(),time).

; The tin is seen where the robot looks, in the drawer only if that is open.
[spot,time]
  HoldsAt(TinAt(spot),time) &
  HoldsAt(LookingAt(spot),time) &
  (spot=onCounter | HoldsAt(DrawerOpen(),time)) ->
    Initiates(Detect(),Seen(),time).
[spot,time]
  HoldsAt(TinAt(spot),time) & !HoldsAt(LookingAt(spot),time) -> Terminates(Detect(),Seen(),time).

; It is picked up when it has been seen, and put down anywhere.
[spot,time]
  HoldsAt(Seen(),time) &
  HoldsAt(RobotAt(atCounter),time) &
  HoldsAt(TinAt(spot),time) &
  (spot=onCounter | HoldsAt(DrawerOpen(),time)) ->
    Initiates(PickUp(),Holding(),time).
[spot,time]
  HoldsAt(Seen(),time) &
  HoldsAt(RobotAt(atCounter),time) &
  HoldsAt(TinAt(spot),time) &
  (spot=onCounter | HoldsAt(DrawerOpen(),time)) ->
    Terminates(PickUp(),TinAt(spot),time).
[time] Terminates(PickUp(),Parked(),time).
[spot,time]
  HoldsAt(Holding(),time) &
  HoldsAt(RobotAt(atCounter),time) &
  (spot=onCounter | HoldsAt(DrawerOpen(),time)) ->
    Initiates(Put(spot),TinAt(spot),time).
[spot,time]
  HoldsAt(Holding(),time) &
  HoldsAt(RobotAt(atCounter),time) &
  (spot=onCounter | HoldsAt(DrawerOpen(),time)) ->
    Terminates(Put(spot),Holding(),time).
[spot,time] Terminates(Put(spot),Parked(),time).
