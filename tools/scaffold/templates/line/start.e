; How it begins. What is not said here is left open, and traces are found for all of it.

HoldsAt(RobotIn(near),0).
HoldsAt(BoxIn(far),0).
