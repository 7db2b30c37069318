; Forgotten: at the back of the cupboard the can is out of reach.

[time] HoldsAt(Perceived(),time) & !HoldsAt(Full(),time) -> Initiates(PickUp(),Holding(),time).
[spot,time]
  HoldsAt(Perceived(),time) & !HoldsAt(Full(),time) -> Terminates(PickUp(),CanAt(spot),time).
[time] HoldsAt(Perceived(),time) -> Terminates(PickUp(),Parked(),time).
