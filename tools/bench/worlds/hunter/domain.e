; The gun of scenarios/classics/yale with a hunter who pulls the trigger only of a loaded gun, and
; who may spin the chamber, after which nobody knows where the bullet is.

fluent Loaded()
fluent Alive()
fluent Aimed()

event Load()
event Spin()
event Aim()
event Shoot()

[time] Initiates(Load(),Loaded(),time).
[time] Terminates(Load(),Aimed(),time).
[time] Releases(Spin(),Loaded(),time).
[time] HoldsAt(Alive(),time) -> Initiates(Aim(),Aimed(),time).
[time] HoldsAt(Loaded(),time) & HoldsAt(Aimed(),time) -> Terminates(Shoot(),Alive(),time).
[time] Terminates(Shoot(),Loaded(),time).
[time] Happens(Shoot(),time) -> HoldsAt(Aimed(),time).
