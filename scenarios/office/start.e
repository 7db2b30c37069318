; The robot in the tea kitchen with a parked, empty hand; the door is shut, the mug on the desk.

HoldsAt(RobotAt(kitchen),0).
HoldsAt(Parked(),0).
[view] !HoldsAt(LookingAt(view),0).
[item] !HoldsAt(Holding(item),0).
[item] !HoldsAt(Perceived(item),0).
[door] !HoldsAt(DoorOpen(door),0).
[item] HoldsAt(ItemAt(item,deskFront),0) | HoldsAt(ItemAt(item,deskBack),0).
