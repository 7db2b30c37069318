; How it begins. What is not said here is left open, and traces are found for all of it.

HoldsAt(BoxAt(onLeft),0).
HoldsAt(Parked(),0).
!HoldsAt(Seen(),0).
[spot] !HoldsAt(LookingAt(spot),0).
