; A crate in one bin, a drum in the other, empty hands.

HoldsAt(RobotAt(atBins),0).
HoldsAt(PartAt(crate,binA),0).
HoldsAt(PartAt(drum,binB),0).
[arm,part] !HoldsAt(Holding(arm,part),0).
[part] !HoldsAt(Perceived(part),0).
[spot] !HoldsAt(LookingAt(spot),0).
[arm] HoldsAt(Parked(arm),0).
