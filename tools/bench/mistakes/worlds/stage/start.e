[mark] HoldsAt(On(ada,mark),0) <-> mark=left.
[mark] HoldsAt(On(ben,mark),0) <-> mark=centre.
[actor] !HoldsAt(Below(actor),0).
!HoldsAt(Curtain(),0).
[mark] HoldsAt(Light(mark),0) <-> mark=left.
[cue] HoldsAt(Cue(cue),0) <-> cue=0.
!HoldsAt(TrapOpen(),0).
!HoldsAt(Fog(),0).
[actor] !HoldsAt(Bowing(actor),0).
!HoldsAt(Applause(),0).
