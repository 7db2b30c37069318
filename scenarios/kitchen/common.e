; A kitchen: a counter with three cells beside a stack of three drawers, a table with four cells, a
; robot with two arms. Everything but what is visible and the three sentences about driving, which
; `domain.e` and `domain_modified.e` add in two versions. A commanded action always happens; where
; its condition does not hold it changes nothing.

sort item
sort itype
sort base
sort place
sort drawer: place
sort arm
sort torso

item milk1, cereal1, bowl1, spoon1
itype milk, breakfastCereal, bowl, spoon
base bWork, bTable, bHome
place pw1, pw2, pw3, pt1, pt2, pt3, pt4, pFloor
drawer dTop, dMid, dLow
arm left, right
torso torsoLow, torsoHigh

predicate TypeOf(item,itype)
predicate Serves(base,place)

fluent RobotAt(base)
fluent TorsoAt(torso)
fluent LookingAt(place)
fluent Parked(arm)
fluent GripperOpen(arm)
fluent Holding(arm,item)
fluent ItemAt(item,place)
fluent DrawerOpen(drawer)
fluent Perceived(item)
fluent BelievedAt(item,place)
fluent HandFree(arm)
fluent Occupied(place)
fluent Obstructed(drawer)
fluent Accessible(place)
fluent Visible(item)
fluent Reachable(item)
noninertial HandFree, Occupied, Obstructed, Accessible, Visible, Reachable

event Go(base)
event LookAt(place)
event MoveTorso(torso)
event ParkArm(arm)
event Detect(itype)
event PickUp(arm,item)
event PlaceAt(arm,item,place)
event OpenDrawer(arm,drawer)
event CloseDrawer(arm,drawer)
event OpenGripper(arm)

; The robot is at one base, its torso at one height, its gaze on at most one place.
[base1,base2,time] HoldsAt(RobotAt(base1),time) & HoldsAt(RobotAt(base2),time) -> base1=base2.
[time] {base} HoldsAt(RobotAt(base),time).
[torso1,torso2,time] HoldsAt(TorsoAt(torso1),time) & HoldsAt(TorsoAt(torso2),time) -> torso1=torso2.
[time] {torso} HoldsAt(TorsoAt(torso),time).
[place1,place2,time]
  HoldsAt(LookingAt(place1),time) & HoldsAt(LookingAt(place2),time) -> place1=place2.

; An item is at one place or in one hand, and a hand holds one item.
[item,place1,place2,time]
  HoldsAt(ItemAt(item,place1),time) & HoldsAt(ItemAt(item,place2),time) -> place1=place2.
[arm,item1,item2,time]
  HoldsAt(Holding(arm,item1),time) & HoldsAt(Holding(arm,item2),time) -> item1=item2.
[arm1,arm2,item,time]
  HoldsAt(Holding(arm1,item),time) & HoldsAt(Holding(arm2,item),time) -> arm1=arm2.
[item,time] {place} HoldsAt(ItemAt(item,place),time) | {arm} HoldsAt(Holding(arm,item),time).
[arm,item,place,time] HoldsAt(Holding(arm,item),time) -> !HoldsAt(ItemAt(item,place),time).
[item,place1,place2,time]
  HoldsAt(BelievedAt(item,place1),time) & HoldsAt(BelievedAt(item,place2),time) -> place1=place2.
[arm,item,time] HoldsAt(Holding(arm,item),time) -> !HoldsAt(GripperOpen(arm),time).

; Two items share no place but the floor.
[item1,item2,place,time]
  HoldsAt(ItemAt(item1,place),time) & HoldsAt(ItemAt(item2,place),time) & place!=pFloor ->
    item1=item2.

; What the defined fluents mean. An open drawer hides those below it.
[arm,time] HoldsAt(HandFree(arm),time) <-> !({item} HoldsAt(Holding(arm,item),time)).
[place,time] HoldsAt(Occupied(place),time) <-> ({item} HoldsAt(ItemAt(item,place),time)).
[time] !HoldsAt(Obstructed(dTop),time).
[time] HoldsAt(Obstructed(dMid),time) <-> HoldsAt(DrawerOpen(dTop),time).
[time]
  HoldsAt(Obstructed(dLow),time) <->
    HoldsAt(DrawerOpen(dTop),time) | HoldsAt(DrawerOpen(dMid),time).
[drawer,time]
  HoldsAt(Accessible(drawer),time) <->
    HoldsAt(DrawerOpen(drawer),time) & !HoldsAt(Obstructed(drawer),time).
[place,time] !({drawer} place=drawer) -> HoldsAt(Accessible(place),time).
; What is visible is said twice:
;  - in `domain.e` what lies where the camera looks;
;  - in `domain_modified.e` that, and perhaps what lies on the next cell of the counter, which the
;    cone of the camera takes in as well.
; Either way it lies at a place that the robot's base serves and that no drawer above hides, so that
; nothing is visible from elsewhere, and nothing in a closed drawer.
;
; Within reach is what lies at such a place, wherever the camera looks.
[item,time]
  HoldsAt(Reachable(item),time) <->
    ({base,place}
     HoldsAt(RobotAt(base),time) &
     HoldsAt(ItemAt(item,place),time) &
     Serves(base,place) &
     HoldsAt(Accessible(place),time)).

; What the items are, and which places a base serves.
TypeOf(milk1,milk).
TypeOf(cereal1,breakfastCereal).
TypeOf(bowl1,bowl).
TypeOf(spoon1,spoon).
[item,itype1,itype2] TypeOf(item,itype1) & TypeOf(item,itype2) -> itype1=itype2.
[place]
  Serves(bWork,place) <-> place=pw1 | place=pw2 | place=pw3 | place=dTop | place=dMid | place=dLow.
[place] Serves(bTable,place) <-> place=pt1 | place=pt2 | place=pt3 | place=pt4.
[place] !Serves(bHome,place).

; Looking.
[place,time]
  ({base} HoldsAt(RobotAt(base),time) & Serves(base,place)) ->
    Initiates(LookAt(place),LookingAt(place),time).
[place1,place2,time]
  ({base} HoldsAt(RobotAt(base),time) & Serves(base,place1)) & place1!=place2 ->
    Terminates(LookAt(place1),LookingAt(place2),time).

; The torso and the carry pose of the arms.
[torso,time] Initiates(MoveTorso(torso),TorsoAt(torso),time).
[torso1,torso2,time] torso1!=torso2 -> Terminates(MoveTorso(torso1),TorsoAt(torso2),time).
[arm,time] Initiates(ParkArm(arm),Parked(arm),time).

; Detecting all that is visible of a kind.
[item,itype,time]
  TypeOf(item,itype) & HoldsAt(Visible(item),time) -> Initiates(Detect(itype),Perceived(item),time).
[item,itype,place,time]
  TypeOf(item,itype) & HoldsAt(Visible(item),time) & HoldsAt(ItemAt(item,place),time) ->
    Initiates(Detect(itype),BelievedAt(item,place),time).
[item,itype,place1,place2,time]
  TypeOf(item,itype) &
  HoldsAt(Visible(item),time) &
  HoldsAt(ItemAt(item,place1),time) &
  place1!=place2 ->
    Terminates(Detect(itype),BelievedAt(item,place2),time).
[item,itype,time]
  TypeOf(item,itype) & !HoldsAt(Visible(item),time) ->
    Terminates(Detect(itype),Perceived(item),time).

; Picking up what was perceived and is within reach.
[arm,item,time]
  HoldsAt(Perceived(item),time) & HoldsAt(Reachable(item),time) & HoldsAt(HandFree(arm),time) ->
    Initiates(PickUp(arm,item),Holding(arm,item),time).
[arm,item,place,time]
  HoldsAt(Perceived(item),time) &
  HoldsAt(Reachable(item),time) &
  HoldsAt(HandFree(arm),time) &
  HoldsAt(ItemAt(item,place),time) ->
    Terminates(PickUp(arm,item),ItemAt(item,place),time).
[arm,item,time]
  HoldsAt(Perceived(item),time) & HoldsAt(Reachable(item),time) & HoldsAt(HandFree(arm),time) ->
    Terminates(PickUp(arm,item),GripperOpen(arm),time).
[arm,item,time] Terminates(PickUp(arm,item),Parked(arm),time).
[arm,item,place,time]
  HoldsAt(Perceived(item),time) &
  HoldsAt(Reachable(item),time) &
  HoldsAt(HandFree(arm),time) &
  HoldsAt(BelievedAt(item,place),time) ->
    Terminates(PickUp(arm,item),BelievedAt(item,place),time).

; Placing what is held where there is room.
[arm,item,place,time]
  HoldsAt(Holding(arm,item),time) &
  ({base} HoldsAt(RobotAt(base),time) & Serves(base,place)) &
  HoldsAt(Accessible(place),time) &
  !HoldsAt(Occupied(place),time) ->
    Initiates(PlaceAt(arm,item,place),ItemAt(item,place),time).
[arm,item,place,time]
  HoldsAt(Holding(arm,item),time) &
  ({base} HoldsAt(RobotAt(base),time) & Serves(base,place)) &
  HoldsAt(Accessible(place),time) &
  !HoldsAt(Occupied(place),time) ->
    Terminates(PlaceAt(arm,item,place),Holding(arm,item),time).
[arm,item,place,time]
  HoldsAt(Holding(arm,item),time) &
  ({base} HoldsAt(RobotAt(base),time) & Serves(base,place)) &
  HoldsAt(Accessible(place),time) &
  !HoldsAt(Occupied(place),time) ->
    Initiates(PlaceAt(arm,item,place),GripperOpen(arm),time).
[arm,item,place,time] Terminates(PlaceAt(arm,item,place),Parked(arm),time).
[arm,item,place,time]
  HoldsAt(Holding(arm,item),time) &
  ({base} HoldsAt(RobotAt(base),time) & Serves(base,place)) &
  HoldsAt(Accessible(place),time) &
  !HoldsAt(Occupied(place),time) ->
    Initiates(PlaceAt(arm,item,place),BelievedAt(item,place),time).

; Drawers are opened by a free hand unless one above is open, and pushed shut by either hand, also one
; that holds something.
[arm,drawer,time]
  ({base} HoldsAt(RobotAt(base),time) & Serves(base,drawer)) &
  HoldsAt(HandFree(arm),time) &
  !HoldsAt(Obstructed(drawer),time) ->
    Initiates(OpenDrawer(arm,drawer),DrawerOpen(drawer),time).
[arm,drawer,time]
  ({base} HoldsAt(RobotAt(base),time) & Serves(base,drawer)) &
  HoldsAt(HandFree(arm),time) &
  !HoldsAt(Obstructed(drawer),time) ->
    Terminates(OpenDrawer(arm,drawer),Parked(arm),time).
[arm,drawer,time]
  ({base} HoldsAt(RobotAt(base),time) & Serves(base,drawer)) ->
    Terminates(CloseDrawer(arm,drawer),DrawerOpen(drawer),time).
[arm,drawer,time]
  ({base} HoldsAt(RobotAt(base),time) & Serves(base,drawer)) ->
    Terminates(CloseDrawer(arm,drawer),Parked(arm),time).

; An opened gripper drops what it holds.
[arm,time] Initiates(OpenGripper(arm),GripperOpen(arm),time).
[arm,item,time]
  HoldsAt(Holding(arm,item),time) -> Terminates(OpenGripper(arm),Holding(arm,item),time).
[arm,item,place,time]
  HoldsAt(Holding(arm,item),time) & place=pFloor ->
    Initiates(OpenGripper(arm),ItemAt(item,place),time).
