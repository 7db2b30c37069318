; What there is, what happens, and what it changes: an arm that carries a box from spot to spot.

sort spot
spot onLeft, onRight

fluent LookingAt(spot)
fluent BoxAt(spot)
fluent Holding()
fluent Seen()
fluent Parked()

event LookAt(spot)
event Detect()
event PickUp()
event Park()
event Put(spot)

; One place for the gaze, one for the box.
[spot1,spot2,time] HoldsAt(LookingAt(spot1),time) & HoldsAt(LookingAt(spot2),time) -> spot1=spot2.
[time] HoldsAt(Holding(),time) | {spot} HoldsAt(BoxAt(spot),time).
[spot,time] HoldsAt(Holding(),time) -> !HoldsAt(BoxAt(spot),time).
[spot1,spot2,time] HoldsAt(BoxAt(spot1),time) & HoldsAt(BoxAt(spot2),time) -> spot1=spot2.

; The gaze is on one spot.
[spot,time] Initiates(LookAt(spot),LookingAt(spot),time).
[spot1,spot2,time] spot1!=spot2 -> Terminates(LookAt(spot1),LookingAt(spot2),time).

; The box is seen where the robot looks, and picked up when it has been seen.
[spot,time]
  HoldsAt(BoxAt(spot),time) & HoldsAt(LookingAt(spot),time) -> Initiates(Detect(),Seen(),time).
[spot,time]
  HoldsAt(BoxAt(spot),time) & !HoldsAt(LookingAt(spot),time) -> Terminates(Detect(),Seen(),time).
[spot,time] HoldsAt(Seen(),time) & HoldsAt(BoxAt(spot),time) -> Initiates(PickUp(),Holding(),time).
[spot,time]
  HoldsAt(Seen(),time) & HoldsAt(BoxAt(spot),time) -> Terminates(PickUp(),BoxAt(spot),time).

; The arm leaves the place where it is parked, and comes back.
[time] Initiates(Park(),Parked(),time).
[time] Terminates(PickUp(),Parked(),time).
[spot,time] Terminates(Put(spot),Parked(),time).

; What is held is put on a spot.
[spot,time] HoldsAt(Holding(),time) -> Initiates(Put(spot),BoxAt(spot),time).
[spot,time] HoldsAt(Holding(),time) -> Terminates(Put(spot),Holding(),time).
