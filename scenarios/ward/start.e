; The robot at the cupboard with a parked, empty hand. All else stands at any of its places, and the can
; is empty or full.

HoldsAt(RobotAt(stock),0).
HoldsAt(Parked(),0).
!HoldsAt(Holding(),0).
!HoldsAt(Perceived(),0).
[view] !HoldsAt(LookingAt(view),0).
!HoldsAt(CanAt(table),0).
