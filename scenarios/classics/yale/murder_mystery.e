; The Stanford murder mystery. A shot was heard and the turkey, alive before, is dead. What was the
; gun like? Reasoning runs backwards from an observation.
;
; Source: A. Baker, "A simple solution to the Yale shooting problem", Proceedings of KR 1989.
;
; Expected: 1 trace. Only a loaded gun explains the death, and Loaded at 0 is all that was unknown.

load gun.e

range time 0 1

HoldsAt(Alive(),0).
!HoldsAt(Alive(),1).

Happens(Shoot(),0).

completion Happens
