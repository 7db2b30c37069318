[tube,place] HoldsAt(At(tube,place),0) <-> place=bench.
[tube,dose] HoldsAt(Filled(tube,dose),0) <-> dose=0.
[tube] !HoldsAt(Capped(tube),0).
[tube] !HoldsAt(Parted(tube),0).
[tube] !HoldsAt(Frozen(tube),0).
!HoldsAt(Spinning(),0).
HoldsAt(Dirty(),0).
