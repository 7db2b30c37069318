; A drawer that opens and closes, and an arm that is parked.

sort drawer
drawer top

fluent Open(drawer)
fluent Parked()

event OpenDrawer(drawer)
event CloseDrawer(drawer)
event Park()
event Reach()

[drawer,time] Terminates(CloseDrawer(drawer),Open(drawer),time).
[time] Initiates(Park(),Parked(),time).
[time] Terminates(Reach(),Parked(),time).
