[track] HoldsAt(EngineAt(track),0) <-> track=siding.
[track] HoldsAt(WagonAt(coal,track),0) <-> track=siding.
[track] HoldsAt(WagonAt(milk,track),0) <-> track=main.
[wagon] !HoldsAt(Coupled(wagon),0).
[load] HoldsAt(Load(load),0) <-> load=0.
[track1,track2] HoldsAt(Set(track1,track2),0) <-> (track1=siding & track2=spur) | (track1=spur & track2=siding).
!HoldsAt(Barrier(),0).
!HoldsAt(Bell(),0).
[wagon] HoldsAt(Braked(wagon),0) <-> wagon=coal.
