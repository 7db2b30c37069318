load domain.e
[parcel,time] Happens(Stamp(parcel),time) -> HoldsAt(OnTable(parcel),time) & !HoldsAt(Stamps(0),time).
[parcel,time] Initiates(Stamp(parcel),Stamped(parcel),time).
[parcel,stamp1,stamp2,time] HoldsAt(Stamps(stamp1),time) & stamp2=stamp1-1 -> Initiates(Stamp(parcel),Stamps(stamp2),time).
[parcel,stamp,time] HoldsAt(Stamps(stamp),time) & stamp>0 -> Terminates(Stamp(parcel),Stamps(stamp),time).
[parcel,chute,time] HoldsAt(OnTable(parcel),time) -> Initiates(Tag(parcel,chute),Label(parcel,chute),time).
[parcel,chute1,chute2,time] HoldsAt(OnTable(parcel),time) & chute1!=chute2 -> Terminates(Tag(parcel,chute1),Label(parcel,chute2),time).
[parcel,time] Happens(Put(parcel),time) -> HoldsAt(OnTable(parcel),time).
[parcel,time] HoldsAt(Stamped(parcel),time) -> Initiates(Put(parcel),OnBelt(parcel),time).
[parcel,time] HoldsAt(Stamped(parcel),time) -> Terminates(Put(parcel),OnTable(parcel),time).
[parcel,time] Releases(Shake(parcel),Loose(parcel),time).
[parcel,time] Terminates(Tie(parcel),Loose(parcel),time).
[chute,time] Happens(SwitchOn(),time) -> !HoldsAt(Blocked(chute),time).
[time] Initiates(SwitchOn(),Belt(),time).
[time] Terminates(SwitchOff(),Belt(),time).
[parcel,chute,time] HoldsAt(Belt(),time) & HoldsAt(OnBelt(parcel),time) & HoldsAt(Label(parcel,chute),time) & !HoldsAt(Blocked(chute),time) -> Happens(Slide(parcel,chute),time).
[parcel,chute,time] Initiates(Slide(parcel,chute),InBin(parcel,chute),time).
[parcel,chute,time] Terminates(Slide(parcel,chute),OnBelt(parcel),time).
[parcel1,parcel2,chute,time] HoldsAt(InBin(parcel1,chute),time) & HoldsAt(InBin(parcel2,chute),time) & parcel1!=parcel2 & !HoldsAt(Blocked(chute),time) -> Happens(Jam(chute),time).
[chute,time] Initiates(Jam(chute),Blocked(chute),time).
[chute,time] HoldsAt(Blocked(chute),time) & HoldsAt(Belt(),time) -> Happens(Trip(),time).
[time] Terminates(Trip(),Belt(),time).
[parcel,chute,time] HoldsAt(InBin(parcel,chute),time) -> Terminates(Empty(chute),InBin(parcel,chute),time).
[chute,time] HoldsAt(Blocked(chute),time) -> Terminates(Empty(chute),Blocked(chute),time).
[event,parcel,chute,time] Terminates(event,InBin(parcel,chute),time) -> Terminates(event,Label(parcel,chute),time).
[event,parcel,chute,time] Terminates(event,InBin(parcel,chute),time) -> Initiates(event,OnTable(parcel),time).
[chute,time] HoldsAt(Heap(chute),time) <-> {parcel} HoldsAt(InBin(parcel,chute),time).
[stamp1,stamp2,time] HoldsAt(Stamps(stamp1),time) & HoldsAt(Stamps(stamp2),time) -> stamp1=stamp2.
[parcel,time] HoldsAt(OnBelt(parcel),time) -> HoldsAt(Stamped(parcel),time).
[parcel,chute,time] HoldsAt(OnTable(parcel),time) -> !HoldsAt(InBin(parcel,chute),time).
[parcel,chute1,chute2,time] HoldsAt(Label(parcel,chute1),time) & HoldsAt(Label(parcel,chute2),time) -> chute1=chute2.
