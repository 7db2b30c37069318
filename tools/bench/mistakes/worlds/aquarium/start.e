[depth] HoldsAt(Depth(reef,depth),0) <-> depth=3.
[depth] HoldsAt(Depth(pond,depth),0) <-> depth=1.
[basin1,basin2] !HoldsAt(Hose(basin1,basin2),0).
!HoldsAt(Pumping(),0).
[basin] HoldsAt(Lit(basin),0) <-> basin=pond.
[basin] !HoldsAt(Fed(basin),0).
[basin] !HoldsAt(Algae(basin),0).
[fish,basin] HoldsAt(FishIn(fish,basin),0) <-> basin=reef.
[fish] !HoldsAt(Stressed(fish),0).
[fish] !HoldsAt(Netted(fish),0).
