; What a modeller would first say of the PR2 in the kitchen of CRAM's projection: driving always arrives,
; and what lies where the base serves is seen and reached. Nothing is said of how near the robot
; stands, nor of the open drawer as an obstacle.

sort base
sort place
sort item
base bSink, bIsland
place pSink, pIsland, dTop, pFloor
item bowl, spoon

predicate Serves(base,place)
[base,place]
  Serves(base,place) <-> (base=bSink & (place=pSink | place=dTop)) | (base=bIsland & place=pIsland).

fluent RobotAt(base)
fluent ItemAt(item,place)
fluent Holding(item)
fluent Perceived(item)
fluent DrawerOpen()
fluent HandFree()
fluent InReach(item)
noninertial HandFree, InReach

event Go(base)
event LookAt(place)
event Park()
event Detect(item)
event PickUp(item)
event PlaceAt(item,place)
event OpenDrawer()
event CloseDrawer()

; The robot stands at one base. Each item lies at one place or is held; one hand holds one item.
[time] {base} HoldsAt(RobotAt(base),time).
[base1,base2,time] HoldsAt(RobotAt(base1),time) & HoldsAt(RobotAt(base2),time) -> base1=base2.
[item,time] HoldsAt(Holding(item),time) | {place} HoldsAt(ItemAt(item,place),time).
[item,place,time] HoldsAt(Holding(item),time) -> !HoldsAt(ItemAt(item,place),time).
[item,place1,place2,time]
  HoldsAt(ItemAt(item,place1),time) & HoldsAt(ItemAt(item,place2),time) -> place1=place2.
[item1,item2,time] HoldsAt(Holding(item1),time) & HoldsAt(Holding(item2),time) -> item1=item2.
[time] HoldsAt(HandFree(),time) <-> !({item} HoldsAt(Holding(item),time)).

; In reach is what lies where the base serves; in the drawer only while that is open.
[item,time]
  HoldsAt(InReach(item),time) <->
    ({base,place}
     HoldsAt(RobotAt(base),time) &
     HoldsAt(ItemAt(item,place),time) &
     Serves(base,place) &
     (place!=dTop | HoldsAt(DrawerOpen(),time))).

; Driving.
[base,time] Initiates(Go(base),RobotAt(base),time).
[base1,base2,time] base1!=base2 -> Terminates(Go(base1),RobotAt(base2),time).

; Seeing, taking, putting down.
[item,time] HoldsAt(InReach(item),time) -> Initiates(Detect(item),Perceived(item),time).
[item,time]
  HoldsAt(InReach(item),time) & HoldsAt(Perceived(item),time) & HoldsAt(HandFree(),time) ->
    Initiates(PickUp(item),Holding(item),time).
[item,place,time]
  HoldsAt(InReach(item),time) &
  HoldsAt(Perceived(item),time) &
  HoldsAt(HandFree(),time) &
  HoldsAt(ItemAt(item,place),time) ->
    Terminates(PickUp(item),ItemAt(item,place),time).
[item,base,place,time]
  HoldsAt(Holding(item),time) & HoldsAt(RobotAt(base),time) & Serves(base,place) ->
    Initiates(PlaceAt(item,place),ItemAt(item,place),time).
[item,base,place,time]
  HoldsAt(Holding(item),time) & HoldsAt(RobotAt(base),time) & Serves(base,place) ->
    Terminates(PlaceAt(item,place),Holding(item),time).

; The drawer is opened and closed from the sink with a free hand.
[time]
  HoldsAt(RobotAt(bSink),time) & HoldsAt(HandFree(),time) ->
    Initiates(OpenDrawer(),DrawerOpen(),time).
[time]
  HoldsAt(RobotAt(bSink),time) & HoldsAt(HandFree(),time) ->
    Terminates(CloseDrawer(),DrawerOpen(),time).

; How it begins: the spoon lies in the closed drawer, and nothing has been seen yet.
HoldsAt(RobotAt(bSink),0).
HoldsAt(ItemAt(bowl,pSink),0).
HoldsAt(ItemAt(spoon,dTop),0).
!HoldsAt(DrawerOpen(),0).
[item] !HoldsAt(Perceived(item),0).
