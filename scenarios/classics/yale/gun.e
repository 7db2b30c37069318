; The Yale domain: a gun, a turkey and what can be done with them. The problems in this folder load
; this file and add what was seen and done.
;
; Source: S. Hanks and D. McDermott, "Nonmonotonic logic and temporal projection", Artificial
; Intelligence 33, 1987.

fluent Loaded()
fluent Alive()

event Load()
event Wait()
event Shoot()

[time] Initiates(Load(),Loaded(),time).

; A shot kills if there is a bullet; pulling the trigger leaves the gun empty in any case. Waiting
; does nothing, so it has no axiom.
[time] HoldsAt(Loaded(),time) -> Terminates(Shoot(),Alive(),time).
[time] Terminates(Shoot(),Loaded(),time).
