; How it begins. What is not said here is left open, and traces are found for all of it.

HoldsAt(RobotAt(atCounter),0).
HoldsAt(TinAt(inDrawer),0).
HoldsAt(Parked(),0).
!HoldsAt(DrawerOpen(),0).
!HoldsAt(Seen(),0).
[spot] !HoldsAt(LookingAt(spot),0).
