load domain.e
[tray,time] Happens(Take(tray),time) -> HoldsAt(OnRack(tray),time).
[tray1,tray2,time] Happens(Take(tray1),time) -> !HoldsAt(Held(tray2),time).
[tray,time] Initiates(Take(tray),Held(tray),time).
[tray,time] Terminates(Take(tray),OnRack(tray),time).
[tray,time] Happens(Load(tray),time) -> HoldsAt(Held(tray),time) & HoldsAt(OvenOpen(),time).
[tray,time] Initiates(Load(tray),InOven(tray),time).
[tray,time] Terminates(Load(tray),Held(tray),time).
[tray,time] HoldsAt(InOven(tray),time) & HoldsAt(OvenOpen(),time) -> Initiates(Unload(tray),Held(tray),time).
[tray,time] HoldsAt(OvenOpen(),time) -> Terminates(Unload(tray),InOven(tray),time).
[tray,time] HoldsAt(Held(tray),time) -> Initiates(Rack(tray),OnRack(tray),time).
[tray,time] Terminates(Rack(tray),Held(tray),time).
[time] Initiates(Open(),OvenOpen(),time).
[time] Terminates(Shut(),OvenOpen(),time).
[heat,time] Happens(Turn(heat),time) -> !HoldsAt(OvenOpen(),time).
[heat,time] Initiates(Turn(heat),Hot(heat),time).
[heat1,heat2,time] heat1!=heat2 -> Terminates(Turn(heat1),Hot(heat2),time).
[heat,time] HoldsAt(OvenOpen(),time) & HoldsAt(Hot(heat),time) & heat>1 -> Happens(Cool(),time).
[heat1,heat2,time] HoldsAt(Hot(heat1),time) & heat2=heat1-1 -> Initiates(Cool(),Hot(heat2),time).
[heat,time] HoldsAt(Hot(heat),time) & heat>0 -> Terminates(Cool(),Hot(heat),time).
[tray,heat,time] HoldsAt(InOven(tray),time) & HoldsAt(Hot(heat),time) & heat>1 & !HoldsAt(OvenOpen(),time) & !HoldsAt(Baked(tray),time) -> Happens(Bake(tray),time).
[tray,time] Initiates(Bake(tray),Baked(tray),time).
[tray,time] HoldsAt(InOven(tray),time) & HoldsAt(Hot(3),time) & HoldsAt(Baked(tray),time) & !HoldsAt(Burnt(tray),time) -> Happens(Burn(tray),time).
[tray,time] Initiates(Burn(tray),Burnt(tray),time).
[event,tray,time] Initiates(event,Burnt(tray),time) -> Initiates(event,Smoke(),time).
[time] HoldsAt(OvenOpen(),time) & HoldsAt(Smoke(),time) -> Terminates(Air(),Smoke(),time).
[minute,time] Happens(Set(minute),time) -> HoldsAt(Timer(0),time).
[minute,time] Initiates(Set(minute),Timer(minute),time).
[minute,time] minute>0 -> Terminates(Set(minute),Timer(0),time).
[minute,time] HoldsAt(Timer(minute),time) & minute>0 -> Happens(Tick(),time).
[minute1,minute2,time] HoldsAt(Timer(minute1),time) & minute2=minute1-1 -> Initiates(Tick(),Timer(minute2),time).
[minute,time] HoldsAt(Timer(minute),time) & minute>0 -> Terminates(Tick(),Timer(minute),time).
[time] HoldsAt(Timer(1),time) -> Initiates(Tick(),Ringing(),time).
[time] HoldsAt(Ringing(),time) -> Terminates(Hush(),Ringing(),time).
[tray,time] HoldsAt(Ready(tray),time) <-> HoldsAt(Baked(tray),time) & !HoldsAt(Burnt(tray),time) & !HoldsAt(InOven(tray),time).
[heat1,heat2,time] HoldsAt(Hot(heat1),time) & HoldsAt(Hot(heat2),time) -> heat1=heat2.
[tray,time] HoldsAt(Held(tray),time) -> !HoldsAt(OnRack(tray),time).
[tray1,tray2,time] HoldsAt(Held(tray1),time) & HoldsAt(Held(tray2),time) -> tray1=tray2.
