; A ward: a cupboard with a can of saline on it, a corridor and a bed with a table. A robot with one arm
; brings the can to the bed. What stands where is open: a trolley in the corridor, a box of linen on
; the cupboard, a vase. What Go, Detect, PickUp and Put do is said by files of their own, right in
; `right/` and with a forgotten condition in `wrong/`. A commanded action always happens; where its
; condition does not hold it changes nothing.

sort base
sort view
sort spot
sort bay
sort side
sort stand

base stock, bed
view cupboard
spot back, front, table
bay onWay, byWall, byWindow
side before, beside
stand onTable, onSill

fluent RobotAt(base)
fluent LookingAt(view)
fluent CanAt(spot)
fluent Full()
fluent Holding()
fluent Perceived()
fluent Parked()
fluent TrolleyAt(bay)
fluent LinenAt(side)
fluent VaseAt(stand)

event Go(base)
event LookAt(view)
event Detect()
event ParkArm()
event PickUp()
event Put(spot)

; Everything is at one place.
[time] {base} HoldsAt(RobotAt(base),time).
[base1,base2,time] HoldsAt(RobotAt(base1),time) & HoldsAt(RobotAt(base2),time) -> base1=base2.
[time] {spot} HoldsAt(CanAt(spot),time) | HoldsAt(Holding(),time).
[spot1,spot2,time] HoldsAt(CanAt(spot1),time) & HoldsAt(CanAt(spot2),time) -> spot1=spot2.
[spot,time] HoldsAt(Holding(),time) -> !HoldsAt(CanAt(spot),time).
[time] {bay} HoldsAt(TrolleyAt(bay),time).
[bay1,bay2,time] HoldsAt(TrolleyAt(bay1),time) & HoldsAt(TrolleyAt(bay2),time) -> bay1=bay2.
[time] {side} HoldsAt(LinenAt(side),time).
[side1,side2,time] HoldsAt(LinenAt(side1),time) & HoldsAt(LinenAt(side2),time) -> side1=side2.
[time] {stand} HoldsAt(VaseAt(stand),time).
[stand1,stand2,time] HoldsAt(VaseAt(stand1),time) & HoldsAt(VaseAt(stand2),time) -> stand1=stand2.

[view,time] HoldsAt(RobotAt(stock),time) -> Initiates(LookAt(view),LookingAt(view),time).
[time] Initiates(ParkArm(),Parked(),time).
