sort thing
thing milk, table, kitchen
sort mode
mode allowAll, allowHand, allowArm, allowAttached, avoidAll, avoidCollisions
sort arm
arm left, right
fluent Holding(arm,thing)
fluent Reached(arm)
fluent LookedAt()
fluent Reachable()
fluent There()
fluent Seen()
event Look()
event Drive()
event MoveTorso()
event SetGripper(arm)
event Grip(arm,thing)
event MoveArms()
event MoveTcp(mode)
event Detect(thing)
event Release(arm)
[arm,thing,time] Initiates(Grip(arm,thing),Holding(arm,thing),time).
[arm,thing,time] Terminates(Release(arm),Holding(arm,thing),time).
[arm,thing] !HoldsAt(Holding(arm,thing),0).
