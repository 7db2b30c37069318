; The walking turkey. A turkey that is shot dies; does it go on walking? That only what is alive walks
; is not enough: as a state constraint beside inertia it leaves no trace at all, for nothing ends the
; walk. The effect constraint says that whatever ends life ends walking too.
;
; Source: A. B. Baker, "Nonmonotonic reasoning in the framework of situation calculus", Artificial
; Intelligence 49, 1991; E. T. Mueller, Commonsense Reasoning, 2006, section 6.4.1.
;
; Expected: 1 trace. State and narrative are fixed: at 2 the turkey is neither alive nor walking.

load gun.e

range time 0 2

fluent Walking()

; Of any event, also of those that another file adds.
[event,time] Terminates(event,Alive(),time) -> Terminates(event,Walking(),time).

[time] HoldsAt(Walking(),time) -> HoldsAt(Alive(),time).

HoldsAt(Walking(),0).
!HoldsAt(Loaded(),0).

Happens(Load(),0).
Happens(Shoot(),1).

completion Happens
