; The model of that plan.
sort region
region bTable, bDrawers
sort drawer
drawer dMid, dLow
sort kind
kind spoon, cup
sort item
item spoon1, cup1
sort arm
arm left, right
fluent RobotAt(region)
fluent Open(drawer)
fluent ItemAt(item,drawer)
fluent Visible(item)
fluent Perceived(item)
fluent Holding(arm,item)
predicate TypeOf(item,kind)
event Go(region)
event OpenDrawer(drawer)
event Detect(kind)
event PickUp(arm,item)
event PlaceAt(arm,item,drawer)
TypeOf(spoon1,spoon) & TypeOf(cup1,cup) & !TypeOf(spoon1,cup) & !TypeOf(cup1,spoon).
[drawer,time] Initiates(OpenDrawer(drawer),Open(drawer),time).
[arm,item,time] Initiates(PickUp(arm,item),Holding(arm,item),time).
[arm,item,drawer,time] Initiates(PlaceAt(arm,item,drawer),ItemAt(item,drawer),time).
[arm,item,drawer,time] Terminates(PlaceAt(arm,item,drawer),Holding(arm,item),time).
[item,kind,time]
  HoldsAt(Visible(item),time) & TypeOf(item,kind) -> Initiates(Detect(kind),Perceived(item),time).
[time] Initiates(OpenDrawer(dLow),Visible(spoon1),time).
[item] !HoldsAt(Visible(item),0).
[drawer] !HoldsAt(Open(drawer),0).
[arm,item] !HoldsAt(Holding(arm,item),0).
[item] !HoldsAt(Perceived(item),0).
[item,drawer] !HoldsAt(ItemAt(item,drawer),0).
[region] HoldsAt(RobotAt(region),0) <-> region=bTable.
