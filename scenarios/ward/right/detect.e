; The can is seen, unless the linen stands before it.

[view,time]
  HoldsAt(LookingAt(view),time) & !HoldsAt(LinenAt(before),time) ->
    Initiates(Detect(),Perceived(),time).
