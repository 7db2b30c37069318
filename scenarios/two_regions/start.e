; Example 1: the robot in r1, the box in r2, nothing held.

HoldsAt(RobotIn(r1),0).
HoldsAt(BoxIn(r2),0).
