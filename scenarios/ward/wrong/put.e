; Forgotten: the vase may stand on the table.

[spot,time]
  HoldsAt(Holding(),time) & HoldsAt(RobotAt(bed),time) -> Initiates(Put(spot),CanAt(spot),time).
[spot,time]
  HoldsAt(Holding(),time) & HoldsAt(RobotAt(bed),time) -> Terminates(Put(spot),Holding(),time).
[spot,time]
  HoldsAt(Holding(),time) & HoldsAt(RobotAt(bed),time) -> Terminates(Put(spot),Parked(),time).
