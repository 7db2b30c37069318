; The supermarket trolley. Pushing a trolley moves it forwards, pulling it moves it backwards. Who
; does both at once cancels both effects and gets a third one: the trolley spins.
;
; Source: M. Shanahan, Solving the Frame Problem, MIT Press, 1997, on concurrent events with
; cumulative and cancelling effects.
;
; Expected: 1 trace: forwards at 1, backwards at 2, spinning at 3, still spinning at 4. The narrative
; is complete and each combination of events has one outcome.

range time 0 4

fluent Forwards()
fluent Backwards()
fluent Spinning()

event Push()
event Pull()

; Alone, each moves the trolley its own way and ends every other motion.
[time] !Happens(Pull(),time) -> Initiates(Push(),Forwards(),time).
[time] !Happens(Pull(),time) -> Terminates(Push(),Backwards(),time).
[time] !Happens(Pull(),time) -> Terminates(Push(),Spinning(),time).

[time] !Happens(Push(),time) -> Initiates(Pull(),Backwards(),time).
[time] !Happens(Push(),time) -> Terminates(Pull(),Forwards(),time).
[time] !Happens(Push(),time) -> Terminates(Pull(),Spinning(),time).

; Together they turn it on the spot.
[time] Happens(Pull(),time) -> Initiates(Push(),Spinning(),time).
[time] Happens(Pull(),time) -> Terminates(Push(),Forwards(),time).
[time] Happens(Pull(),time) -> Terminates(Push(),Backwards(),time).

!HoldsAt(Forwards(),0).
!HoldsAt(Backwards(),0).
!HoldsAt(Spinning(),0).

Happens(Push(),0).
Happens(Pull(),1).
Happens(Push(),2).
Happens(Pull(),2).

completion Happens
