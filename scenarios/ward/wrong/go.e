; Forgotten: a trolley may stand on the way.

[base1,base2,time] HoldsAt(RobotAt(base1),time) -> Initiates(Go(base2),RobotAt(base2),time).
[base1,base2,time] base1!=base2 -> Terminates(Go(base2),RobotAt(base1),time).
[base,view,time] !HoldsAt(RobotAt(base),time) -> Terminates(Go(base),LookingAt(view),time).
