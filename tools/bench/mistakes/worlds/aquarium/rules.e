load domain.e
[basin1,basin2,time] Happens(Join(basin1,basin2),time) -> basin1!=basin2 & !HoldsAt(Pumping(),time).
[basin1,basin2,time] Initiates(Join(basin1,basin2),Hose(basin1,basin2),time).
[basin1,basin2,time] Terminates(Join(basin1,basin2),Hose(basin2,basin1),time).
[basin1,basin2,time] Terminates(Detach(basin1,basin2),Hose(basin1,basin2),time).
[basin1,basin2,time] Happens(Detach(basin1,basin2),time) -> HoldsAt(Hose(basin1,basin2),time).
[time] Happens(PumpOn(),time) -> !HoldsAt(Pumping(),time).
[time] Initiates(PumpOn(),Pumping(),time).
[time] Terminates(PumpOff(),Pumping(),time).
[basin1,basin2,time] HoldsAt(Pumping(),time) & HoldsAt(Hose(basin1,basin2),time) & !HoldsAt(Depth(basin1,0),time) & !HoldsAt(Depth(basin2,4),time) -> Happens(Flow(basin1,basin2),time).
[basin1,basin2,depth1,depth2,time] HoldsAt(Depth(basin1,depth1),time) & depth2=depth1-1 -> Initiates(Flow(basin1,basin2),Depth(basin1,depth2),time).
[basin1,basin2,depth,time] HoldsAt(Depth(basin1,depth),time) -> Terminates(Flow(basin1,basin2),Depth(basin1,depth),time).
[basin1,basin2,depth1,depth2,time] HoldsAt(Depth(basin2,depth1),time) & depth2=depth1+1 -> Initiates(Flow(basin1,basin2),Depth(basin2,depth2),time).
[basin1,basin2,depth,time] HoldsAt(Depth(basin2,depth),time) -> Terminates(Flow(basin1,basin2),Depth(basin2,depth),time).
[basin1,basin2,time] HoldsAt(Pumping(),time) & HoldsAt(Hose(basin1,basin2),time) & HoldsAt(Depth(basin1,0),time) -> Happens(Stall(),time).
[time] Terminates(Stall(),Pumping(),time).
[basin,depth,time] Happens(Pour(basin,depth),time) -> !HoldsAt(Pumping(),time).
[basin,depth1,depth2,depth3,time] HoldsAt(Depth(basin,depth1),time) & depth3=depth1+depth2 -> Initiates(Pour(basin,depth2),Depth(basin,depth3),time).
[basin,depth1,depth2,time] HoldsAt(Depth(basin,depth1),time) & depth2>0 & depth1+depth2<5 -> Terminates(Pour(basin,depth2),Depth(basin,depth1),time).
[basin,time] !HoldsAt(Lit(basin),time) -> Initiates(Lamp(basin),Lit(basin),time).
[basin,time] HoldsAt(Lit(basin),time) -> Terminates(Lamp(basin),Lit(basin),time).
[basin,time] Happens(Feed(basin),time) -> !HoldsAt(Fed(basin),time).
[basin,time] Initiates(Feed(basin),Fed(basin),time).
[basin,time] HoldsAt(Lit(basin),time) & HoldsAt(Fed(basin),time) & !HoldsAt(Algae(basin),time) -> Happens(Bloom(basin),time).
[basin,time] Initiates(Bloom(basin),Algae(basin),time).
[basin,time] Terminates(Bloom(basin),Fed(basin),time).
[basin,time] HoldsAt(Algae(basin),time) & !HoldsAt(Lit(basin),time) -> Terminates(Scrub(basin),Algae(basin),time).
[fish1,fish2,time] Happens(Net(fish1),time) -> !HoldsAt(Netted(fish2),time).
[fish,time] Initiates(Net(fish),Netted(fish),time).
[fish,basin,time] HoldsAt(FishIn(fish,basin),time) -> Terminates(Net(fish),FishIn(fish,basin),time).
[fish,basin,time] HoldsAt(Netted(fish),time) -> Initiates(Free(fish,basin),FishIn(fish,basin),time).
[fish,basin,time] Terminates(Free(fish,basin),Netted(fish),time).
[fish,basin,depth,time] HoldsAt(FishIn(fish,basin),time) & HoldsAt(Depth(basin,depth),time) & depth<2 & !HoldsAt(Stressed(fish),time) -> Happens(Gasp(fish),time).
[fish,time] Initiates(Gasp(fish),Stressed(fish),time).
[fish,basin,depth,time] HoldsAt(Stressed(fish),time) & HoldsAt(Depth(basin,depth),time) & depth>=2 -> Terminates(Free(fish,basin),Stressed(fish),time).
[time] HoldsAt(Murky(),time) <-> {basin} HoldsAt(Algae(basin),time) & HoldsAt(Lit(basin),time).
[time] HoldsAt(Calm(),time) <-> !({fish} HoldsAt(Stressed(fish),time)).
[basin,depth1,depth2,time] HoldsAt(Depth(basin,depth1),time) & HoldsAt(Depth(basin,depth2),time) -> depth1=depth2.
[fish,basin,time] HoldsAt(Netted(fish),time) -> !HoldsAt(FishIn(fish,basin),time).
[fish,basin1,basin2,time] HoldsAt(FishIn(fish,basin1),time) & HoldsAt(FishIn(fish,basin2),time) -> basin1=basin2.
