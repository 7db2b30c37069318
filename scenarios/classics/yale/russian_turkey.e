; The Russian turkey. Between loading and shooting somebody spins the chamber, after which nobody
; knows whether the bullet is in place: spinning releases Loaded from inertia.
;
; Source: E. Sandewall, Features and Fluents, Oxford University Press, 1994, where it is one of the
; test scenarios; release of fluents as in M. Shanahan, Solving the Frame Problem, MIT Press, 1997.
;
; Expected: 2 traces. Loaded is free at 2, and everything else follows from it: the turkey dies or
; lives. At 3 the shot has made Loaded false again, so the release adds nothing there.

load gun.e

range time 0 3

event Spin()

[time] Releases(Spin(),Loaded(),time).

HoldsAt(Alive(),0).
!HoldsAt(Loaded(),0).

Happens(Load(),0).
Happens(Spin(),1).
Happens(Shoot(),2).

completion Happens
