; The robot stands at the counter with parked, empty, open hands and its torso down. It has seen
; nothing, and all drawers are closed. Milk, cereal and bowl are each on a cell of the counter, the
; spoon is in some drawer: which ones is left open.

HoldsAt(RobotAt(bWork),0).
HoldsAt(TorsoAt(torsoLow),0).
[arm] HoldsAt(Parked(arm),0).
[arm] HoldsAt(GripperOpen(arm),0).
[arm,item] !HoldsAt(Holding(arm,item),0).
[drawer] !HoldsAt(DrawerOpen(drawer),0).
[place] !HoldsAt(LookingAt(place),0).
[item] !HoldsAt(Perceived(item),0).
[item,place] !HoldsAt(BelievedAt(item,place),0).
[item]
  item!=spoon1 ->
    HoldsAt(ItemAt(item,pw1),0) | HoldsAt(ItemAt(item,pw2),0) | HoldsAt(ItemAt(item,pw3),0).
{drawer} HoldsAt(ItemAt(spoon1,drawer),0).
