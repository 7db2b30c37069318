; Tossing a coin. While a coin spins in the air, which side is up is anybody's guess; the hand that
; catches it ends the guessing. A toss releases Heads from inertia, catching fixes it as it is.
;
; Source: non-determinism by release is due to A. Kartha and V. Lifschitz ("Actions with indirect
; effects", KR 1994); in the event calculus M. Shanahan, Solving the Frame Problem, MIT Press, 1997.
;
; Expected: 4 traces. Heads is free at 1 and at 2, when the coin is in the air; at 3 it is what it was
; at 2, since the catch happens there, and at 4 inertia keeps it: 2 x 2.

range time 0 4

fluent Heads()
fluent Spinning()

event Toss()
event Catch()

[time] Initiates(Toss(),Spinning(),time).
[time] Releases(Toss(),Heads(),time).

[time] Terminates(Catch(),Spinning(),time).
[time] HoldsAt(Heads(),time) -> Initiates(Catch(),Heads(),time).
[time] !HoldsAt(Heads(),time) -> Terminates(Catch(),Heads(),time).

HoldsAt(Heads(),0).
!HoldsAt(Spinning(),0).

Happens(Toss(),0).
Happens(Catch(),2).

completion Happens
