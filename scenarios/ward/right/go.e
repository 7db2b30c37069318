; Driving, where no trolley stands on the way.

[base1,base2,time]
  HoldsAt(RobotAt(base1),time) & !HoldsAt(TrolleyAt(onWay),time) ->
    Initiates(Go(base2),RobotAt(base2),time).
[base1,base2,time]
  base1!=base2 & !HoldsAt(TrolleyAt(onWay),time) -> Terminates(Go(base2),RobotAt(base1),time).
[base,view,time]
  !HoldsAt(RobotAt(base),time) & !HoldsAt(TrolleyAt(onWay),time) ->
    Terminates(Go(base),LookingAt(view),time).
