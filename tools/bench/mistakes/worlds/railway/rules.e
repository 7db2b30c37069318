load domain.e
Mass(coal)=2.
Mass(milk)=1.
[track1,track2,time] Happens(Move(track1,track2),time) -> HoldsAt(EngineAt(track1),time) & HoldsAt(Set(track1,track2),time).
[track,time] Happens(Move(track,spur),time) -> !HoldsAt(Heavy(),time).
[track1,track2,wagon,time] Happens(Move(track1,track2),time) & HoldsAt(Coupled(wagon),time) -> !HoldsAt(Braked(wagon),time).
[track1,track2,time] Initiates(Move(track1,track2),EngineAt(track2),time).
[track1,track2,time] track1!=track2 -> Terminates(Move(track1,track2),EngineAt(track1),time).
[event,wagon,track,time] Initiates(event,EngineAt(track),time) & HoldsAt(Coupled(wagon),time) -> Initiates(event,WagonAt(wagon,track),time).
[event,wagon,track,time] Terminates(event,EngineAt(track),time) & HoldsAt(Coupled(wagon),time) -> Terminates(event,WagonAt(wagon,track),time).
[track1,track2,time] Happens(Throw(track1,track2),time) -> track1!=track2 & !HoldsAt(Barrier(),time).
[track1,track2,time] Initiates(Throw(track1,track2),Set(track1,track2),time).
[track1,track2,time] Initiates(Throw(track1,track2),Set(track2,track1),time).
[track1,track2,track3,track4,time] HoldsAt(Set(track3,track4),time) & track3!=track1 & track3!=track2 -> Terminates(Throw(track1,track2),Set(track3,track4),time).
[track1,track2,track3,track4,time] HoldsAt(Set(track3,track4),time) & track4!=track1 & track4!=track2 -> Terminates(Throw(track1,track2),Set(track3,track4),time).
[wagon,track,time] HoldsAt(EngineAt(track),time) & HoldsAt(WagonAt(wagon,track),time) & !HoldsAt(Coupled(wagon),time) -> Initiates(Couple(wagon),Coupled(wagon),time).
[wagon,track,load1,load2,time] HoldsAt(EngineAt(track),time) & HoldsAt(WagonAt(wagon,track),time) & !HoldsAt(Coupled(wagon),time) & HoldsAt(Load(load1),time) & load2=load1+Mass(wagon) -> Initiates(Couple(wagon),Load(load2),time).
[wagon,track,load,time] HoldsAt(EngineAt(track),time) & HoldsAt(WagonAt(wagon,track),time) & !HoldsAt(Coupled(wagon),time) & HoldsAt(Load(load),time) -> Terminates(Couple(wagon),Load(load),time).
[wagon,time] Happens(Uncouple(wagon),time) -> HoldsAt(Coupled(wagon),time).
[wagon,time] Terminates(Uncouple(wagon),Coupled(wagon),time).
[wagon,load1,load2,time] HoldsAt(Load(load1),time) & load2=load1-Mass(wagon) -> Initiates(Uncouple(wagon),Load(load2),time).
[wagon,load,time] HoldsAt(Load(load),time) -> Terminates(Uncouple(wagon),Load(load),time).
[wagon,time] Initiates(Brake(wagon),Braked(wagon),time).
[wagon,time] Terminates(Loosen(wagon),Braked(wagon),time).
[wagon,time] HoldsAt(WagonAt(wagon,spur),time) & !HoldsAt(Coupled(wagon),time) & !HoldsAt(Braked(wagon),time) -> Happens(Roll(wagon),time).
[wagon,time] Initiates(Roll(wagon),WagonAt(wagon,siding),time).
[wagon,time] Terminates(Roll(wagon),WagonAt(wagon,spur),time).
[time] HoldsAt(EngineAt(main),time) & !HoldsAt(Barrier(),time) -> Happens(Drop(),time).
[time] Initiates(Drop(),Barrier(),time).
[time] Initiates(Drop(),Bell(),time).
[time] !HoldsAt(EngineAt(main),time) & HoldsAt(Barrier(),time) -> Happens(Lift(),time).
[time] Terminates(Lift(),Barrier(),time).
[event,time] Terminates(event,Barrier(),time) -> Terminates(event,Bell(),time).
[time] HoldsAt(Heavy(),time) <-> {load} HoldsAt(Load(load),time) & load>2.
[track,time] HoldsAt(Clear(track),time) <-> !HoldsAt(EngineAt(track),time) & !({wagon} HoldsAt(WagonAt(wagon,track),time)).
[track1,track2,time] HoldsAt(EngineAt(track1),time) & HoldsAt(EngineAt(track2),time) -> track1=track2.
[wagon,track1,track2,time] HoldsAt(WagonAt(wagon,track1),time) & HoldsAt(WagonAt(wagon,track2),time) -> track1=track2.
[load1,load2,time] HoldsAt(Load(load1),time) & HoldsAt(Load(load2),time) -> load1=load2.
[wagon,track,time] HoldsAt(Coupled(wagon),time) & HoldsAt(EngineAt(track),time) -> HoldsAt(WagonAt(wagon,track),time).
