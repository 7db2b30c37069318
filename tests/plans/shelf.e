; A robot with two arms between a shelf of three boards and a crate. Two fresh products belong on the
; shelf; a stale one may stand there and belongs into the crate.

sort arm
sort product
sort spot
sort board: spot
arm left, right
product fresh1, fresh2, stale1
spot crate
board upper, middle, lower

fluent FacingShelf()
fluent At(product,spot)
fluent Held(arm,product)
fluent Taken(spot)
fluent WithinReach(spot)
noninertial Taken, WithinReach

event FaceShelf()
event FaceCrate()
event Inspect(board)
event Grasp(arm,product)
event Put(arm,product,spot)

[product,time] {spot} HoldsAt(At(product,spot),time) | {arm} HoldsAt(Held(arm,product),time).
[product,spot1,spot2,time]
  HoldsAt(At(product,spot1),time) & HoldsAt(At(product,spot2),time) -> spot1=spot2.
[arm,product,spot,time] HoldsAt(Held(arm,product),time) -> !HoldsAt(At(product,spot),time).
[arm1,arm2,product,time]
  HoldsAt(Held(arm1,product),time) & HoldsAt(Held(arm2,product),time) -> arm1=arm2.
[arm,product1,product2,time]
  HoldsAt(Held(arm,product1),time) & HoldsAt(Held(arm,product2),time) -> product1=product2.
[board,product1,product2,time]
  HoldsAt(At(product1,board),time) & HoldsAt(At(product2,board),time) -> product1=product2.

; The crate has room for all.
[spot,time] HoldsAt(Taken(spot),time) <-> spot!=crate & ({product} HoldsAt(At(product,spot),time)).
[board,time] HoldsAt(WithinReach(board),time) <-> HoldsAt(FacingShelf(),time).
[time] HoldsAt(WithinReach(crate),time) <-> !HoldsAt(FacingShelf(),time).

[time] Initiates(FaceShelf(),FacingShelf(),time).
[time] Terminates(FaceCrate(),FacingShelf(),time).
[arm,product,spot,time]
  HoldsAt(At(product,spot),time) &
  HoldsAt(WithinReach(spot),time) &
  !({product1} HoldsAt(Held(arm,product1),time)) ->
    Initiates(Grasp(arm,product),Held(arm,product),time).
[arm,product,spot,time]
  HoldsAt(At(product,spot),time) &
  HoldsAt(WithinReach(spot),time) &
  !({product1} HoldsAt(Held(arm,product1),time)) ->
    Terminates(Grasp(arm,product),At(product,spot),time).
[arm,product,spot,time]
  HoldsAt(Held(arm,product),time) & HoldsAt(WithinReach(spot),time) & !HoldsAt(Taken(spot),time) ->
    Initiates(Put(arm,product,spot),At(product,spot),time).
[arm,product,spot,time]
  HoldsAt(Held(arm,product),time) & HoldsAt(WithinReach(spot),time) & !HoldsAt(Taken(spot),time) ->
    Terminates(Put(arm,product,spot),Held(arm,product),time).

; At the start nothing is held; the products are anywhere.
[arm,product] !HoldsAt(Held(arm,product),0).
!HoldsAt(FacingShelf(),0).
HoldsAt(At(fresh2,crate),0).
