load domain.e
[time] Happens(Raise(),time) -> !HoldsAt(Curtain(),time).
[time] Initiates(Raise(),Curtain(),time).
[time] Terminates(Lower(),Curtain(),time).
[actor,mark1,mark2,time] Happens(Walk(actor,mark1,mark2),time) -> HoldsAt(On(actor,mark1),time) & mark1!=mark2.
[actor,mark1,mark2,time] Happens(Walk(actor,mark1,mark2),time) -> !HoldsAt(Bowing(actor),time).
[actor1,actor2,mark1,mark2,time] Happens(Walk(actor1,mark1,mark2),time) -> !HoldsAt(On(actor2,mark2),time).
[actor,mark1,mark2,time] HoldsAt(On(actor,mark1),time) -> Initiates(Walk(actor,mark1,mark2),On(actor,mark2),time).
[actor,mark1,mark2,time] Terminates(Walk(actor,mark1,mark2),On(actor,mark1),time).
[mark,time] Initiates(Spot(mark),Light(mark),time).
[mark,time] Terminates(Dim(mark),Light(mark),time).
[time] Happens(Lever(),time) -> !HoldsAt(TrapOpen(),time).
[time] Initiates(Lever(),TrapOpen(),time).
[actor,time] HoldsAt(TrapOpen(),time) & HoldsAt(On(actor,hatch),time) -> Happens(Fall(actor),time).
[actor,time] Initiates(Fall(actor),Below(actor),time).
[actor,time] Terminates(Fall(actor),On(actor,hatch),time).
[actor,time] HoldsAt(TrapOpen(),time) & HoldsAt(Below(actor),time) -> Happens(Snap(),time).
[time] Terminates(Snap(),TrapOpen(),time).
[actor,time] HoldsAt(Below(actor),time) & !HoldsAt(TrapOpen(),time) -> Initiates(Climb(actor),On(actor,left),time).
[actor,time] !HoldsAt(TrapOpen(),time) -> Terminates(Climb(actor),Below(actor),time).
[time] Releases(Puff(),Fog(),time).
[time] Terminates(Vent(),Fog(),time).
[time] Happens(Call(),time) -> HoldsAt(Curtain(),time).
[cue1,cue2,time] HoldsAt(Cue(cue1),time) & cue2=cue1+1 -> Initiates(Call(),Cue(cue2),time).
[cue,time] HoldsAt(Cue(cue),time) & cue<4 -> Terminates(Call(),Cue(cue),time).
[cue1,cue2,cue3,time] HoldsAt(Cue(cue1),time) & cue3=cue1+cue2 -> Initiates(Skip(cue2),Cue(cue3),time).
[cue1,cue2,time] HoldsAt(Cue(cue1),time) & cue2>0 & cue1+cue2<5 -> Terminates(Skip(cue2),Cue(cue1),time).
[actor,cue,time] Happens(Bow(actor),time) & HoldsAt(Cue(cue),time) -> cue>1.
[actor,mark,time] HoldsAt(On(actor,mark),time) & mark!=hatch -> Initiates(Bow(actor),Bowing(actor),time).
[actor,time] Terminates(Rise(actor),Bowing(actor),time).
[actor,time] HoldsAt(Bowing(actor),time) & HoldsAt(Seen(actor),time) & !HoldsAt(Applause(),time) -> Happens(Clap(),time).
[time] Initiates(Clap(),Applause(),time).
[time] HoldsAt(Applause(),time) -> Terminates(Lower(),Applause(),time).
[actor,time] HoldsAt(Seen(actor),time) <-> HoldsAt(Curtain(),time) & ({mark} HoldsAt(On(actor,mark),time) & HoldsAt(Light(mark),time)).
[cue1,cue2,time] HoldsAt(Cue(cue1),time) & HoldsAt(Cue(cue2),time) -> cue1=cue2.
[actor,mark1,mark2,time] HoldsAt(On(actor,mark1),time) & HoldsAt(On(actor,mark2),time) -> mark1=mark2.
[actor,mark,time] HoldsAt(Below(actor),time) -> !HoldsAt(On(actor,mark),time).
[actor1,actor2,mark,time] HoldsAt(On(actor1,mark),time) & HoldsAt(On(actor2,mark),time) -> actor1=actor2.
