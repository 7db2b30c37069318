; As opens.e, and pulling takes the arm out of its parking place.

load opens.e

[drawer,time] Terminates(OpenDrawer(drawer),Parked(),time).
