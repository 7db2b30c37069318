; How it begins. What is not said here is left open, and traces are found for all of it.

HoldsAt(RobotAt(atTable),0).
HoldsAt(BoxAt(onTable),0).
HoldsAt(Parked(),0).
!HoldsAt(Seen(),0).
[spot] !HoldsAt(LookingAt(spot),0).
