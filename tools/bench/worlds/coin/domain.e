; The coin of scenarios/classics/coin_toss.e in somebody's hand: while it is in the air its side is
; open, and who has caught it may show it or turn it over.

fluent Heads()
fluent Spinning()
fluent Shown()

event Toss()
event Catch()
event Turn()
event Show()

[time] Initiates(Toss(),Spinning(),time).
[time] Terminates(Toss(),Shown(),time).
[time] Releases(Toss(),Heads(),time).

[time] Happens(Catch(),time) -> HoldsAt(Spinning(),time).
[time] Terminates(Catch(),Spinning(),time).
[time] HoldsAt(Heads(),time) -> Initiates(Catch(),Heads(),time).
[time] !HoldsAt(Heads(),time) -> Terminates(Catch(),Heads(),time).

[time] HoldsAt(Heads(),time) & !HoldsAt(Spinning(),time) -> Terminates(Turn(),Heads(),time).
[time] !HoldsAt(Heads(),time) & !HoldsAt(Spinning(),time) -> Initiates(Turn(),Heads(),time).

[time] !HoldsAt(Spinning(),time) -> Initiates(Show(),Shown(),time).
