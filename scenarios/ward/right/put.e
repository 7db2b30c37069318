; What is held is put on the table of the bed, unless the vase stands there.

[spot,time]
  HoldsAt(Holding(),time) & HoldsAt(RobotAt(bed),time) & !HoldsAt(VaseAt(onTable),time) ->
    Initiates(Put(spot),CanAt(spot),time).
[spot,time]
  HoldsAt(Holding(),time) & HoldsAt(RobotAt(bed),time) & !HoldsAt(VaseAt(onTable),time) ->
    Terminates(Put(spot),Holding(),time).
[spot,time]
  HoldsAt(Holding(),time) & HoldsAt(RobotAt(bed),time) & !HoldsAt(VaseAt(onTable),time) ->
    Terminates(Put(spot),Parked(),time).
