[spot] HoldsAt(RobotAt(spot),0) <-> spot=dock.
[spot] HoldsAt(CrateAt(red,spot),0) <-> spot=yard.
[spot] HoldsAt(CrateAt(blue,spot),0) <-> spot=shed.
[crate] !HoldsAt(Carried(crate),0).
[charge] HoldsAt(Charge(charge),0) <-> charge=4.
!HoldsAt(Plugged(),0).
!HoldsAt(GateOpen(),0).
!HoldsAt(Warned(),0).
