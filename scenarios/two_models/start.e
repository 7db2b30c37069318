; The drawer is closed and the arm parked.

[drawer] !HoldsAt(Open(drawer),0).
HoldsAt(Parked(),0).
