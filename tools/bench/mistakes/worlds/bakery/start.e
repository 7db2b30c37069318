[tray] HoldsAt(OnRack(tray),0).
[tray] !HoldsAt(Held(tray),0).
[tray] !HoldsAt(InOven(tray),0).
[tray] !HoldsAt(Baked(tray),0).
[tray] !HoldsAt(Burnt(tray),0).
!HoldsAt(OvenOpen(),0).
[heat] HoldsAt(Hot(heat),0) <-> heat=0.
[minute] HoldsAt(Timer(minute),0) <-> minute=0.
!HoldsAt(Ringing(),0).
!HoldsAt(Smoke(),0).
