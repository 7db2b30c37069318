sort thing
thing milk, table, kitchen
sort arm
arm left, right
fluent Holding(arm,thing)
fluent Reached(arm)
fluent LookedAt()
fluent Reachable()
event Look()
event Drive()
event MoveTorso()
event SetGripper(arm)
event Grip(arm,thing)
event MoveArms()
event Detect(thing)
event Release(arm)
[arm,thing,time] Initiates(Grip(arm,thing),Holding(arm,thing),time).
[arm,thing,time] Terminates(Release(arm),Holding(arm,thing),time).
[arm,thing] !HoldsAt(Holding(arm,thing),0).
