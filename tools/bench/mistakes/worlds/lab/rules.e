load domain.e
[tube,dose,time] Happens(Pipette(tube,dose),time) -> HoldsAt(At(tube,bench),time) & !HoldsAt(Capped(tube),time).
[tube,dose,time] Happens(Pipette(tube,dose),time) -> !HoldsAt(Frozen(tube),time).
[tube,dose1,dose2,dose3,time] HoldsAt(Filled(tube,dose1),time) & dose3=dose1+dose2 -> Initiates(Pipette(tube,dose2),Filled(tube,dose3),time).
[tube,dose1,dose2,time] HoldsAt(Filled(tube,dose1),time) & dose2>0 & dose1+dose2<4 -> Terminates(Pipette(tube,dose2),Filled(tube,dose1),time).
[tube1,tube2,time] Happens(Merge(tube1,tube2),time) -> !HoldsAt(Capped(tube1),time) & !HoldsAt(Capped(tube2),time).
[tube1,tube2,dose1,dose2,time] Happens(Merge(tube1,tube2),time) & HoldsAt(Filled(tube1,dose1),time) & HoldsAt(Filled(tube2,dose2),time) -> tube1!=tube2 & dose1+dose2<4.
[tube1,tube2,dose1,dose2,dose3,time] HoldsAt(Filled(tube1,dose1),time) & HoldsAt(Filled(tube2,dose2),time) & dose3=dose1+dose2 -> Initiates(Merge(tube1,tube2),Filled(tube2,dose3),time).
[tube1,tube2,dose1,dose2,time] HoldsAt(Filled(tube1,dose1),time) & HoldsAt(Filled(tube2,dose2),time) & dose1>0 -> Terminates(Merge(tube1,tube2),Filled(tube2,dose2),time).
[tube1,tube2,time] Initiates(Merge(tube1,tube2),Filled(tube1,0),time).
[tube1,tube2,dose,time] HoldsAt(Filled(tube1,dose),time) & dose>0 -> Terminates(Merge(tube1,tube2),Filled(tube1,dose),time).
[tube,time] Initiates(Cap(tube),Capped(tube),time).
[tube,time] Terminates(Uncap(tube),Capped(tube),time).
[tube,place,time] Happens(Carry(tube,place),time) -> !HoldsAt(Spinning(),time).
[tube,place,time] Initiates(Carry(tube,place),At(tube,place),time).
[tube,place1,place2,time] place1!=place2 -> Terminates(Carry(tube,place1),At(tube,place2),time).
[time] Happens(Start(),time) -> {tube} HoldsAt(At(tube,spinner),time).
[time] Initiates(Start(),Spinning(),time).
[time] Terminates(Stop(),Spinning(),time).
[tube,time] HoldsAt(Spinning(),time) & HoldsAt(At(tube,spinner),time) & HoldsAt(Capped(tube),time) & !HoldsAt(Parted(tube),time) & !HoldsAt(Filled(tube,0),time) -> Happens(Settle(tube),time).
[tube,time] Initiates(Settle(tube),Parted(tube),time).
[tube,time] HoldsAt(Spinning(),time) & HoldsAt(At(tube,spinner),time) & !HoldsAt(Capped(tube),time) & !HoldsAt(Filled(tube,0),time) -> Happens(Spill(tube),time).
[tube,time] Initiates(Spill(tube),Filled(tube,0),time).
[tube,dose,time] HoldsAt(Filled(tube,dose),time) & dose>0 -> Terminates(Spill(tube),Filled(tube,dose),time).
[tube,time] Initiates(Spill(tube),Dirty(),time).
[time] Happens(Wipe(),time) -> !HoldsAt(Spinning(),time).
[time] Terminates(Wipe(),Dirty(),time).
[tube,time] HoldsAt(At(tube,cold),time) & !HoldsAt(Frozen(tube),time) & !HoldsAt(Filled(tube,0),time) -> Happens(Freeze(tube),time).
[tube,time] Initiates(Freeze(tube),Frozen(tube),time).
[tube,time] HoldsAt(At(tube,bench),time) & HoldsAt(Frozen(tube),time) -> Happens(Thaw(tube),time).
[tube,time] Terminates(Thaw(tube),Frozen(tube),time).
[event,tube,time] Initiates(event,Filled(tube,0),time) -> Terminates(event,Parted(tube),time).
[time] HoldsAt(Busy(),time) <-> HoldsAt(Spinning(),time) & ({tube} HoldsAt(At(tube,spinner),time)).
[tube,dose1,dose2,time] HoldsAt(Filled(tube,dose1),time) & HoldsAt(Filled(tube,dose2),time) -> dose1=dose2.
[tube,place1,place2,time] HoldsAt(At(tube,place1),time) & HoldsAt(At(tube,place2),time) -> place1=place2.
[tube1,tube2,time] HoldsAt(At(tube1,spinner),time) & HoldsAt(At(tube2,spinner),time) -> tube1=tube2.
