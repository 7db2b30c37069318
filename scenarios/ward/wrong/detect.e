; Forgotten: the linen may stand before the can.

[view,time] HoldsAt(LookingAt(view),time) -> Initiates(Detect(),Perceived(),time).
