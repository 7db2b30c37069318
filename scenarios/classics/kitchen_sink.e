; The kitchen sink. A tap is opened under a plugged sink. The water rises a step at a time, which is a
; trajectory, and when it reaches the rim it begins to spill, which is a triggered event: nobody does
; it, the level does.
;
; Source: M. Shanahan, "Representing continuous change in the event calculus", ECAI 1990, and Solving
; the Frame Problem, MIT Press, 1997.
;
; Expected: 1 trace. Levels 0, 1, 2, 3 at 0 to 3; Overflow at 3, after which the level stays at 3 and
; the floor gets wet.

range time 0 5
range offset 1 5

sort level: integer
range level 0 3

fluent Filling()
fluent Spilling()
fluent Level(level)

event Open()
event Overflow()

; The sink has one level at a time.
[time] {level} HoldsAt(Level(level),time).
[time,level1,level2] HoldsAt(Level(level1),time) & HoldsAt(Level(level2),time) -> level1=level2.

; With the tap open the level is no longer inert: the trajectory says what it is.
[time] Initiates(Open(),Filling(),time).
[time,level] Releases(Open(),Level(level),time).
[time,offset,level1,level2]
  HoldsAt(Level(level1),time) & level2=level1+offset ->
    Trajectory(Filling(),time,Level(level2),offset).

; At the rim the water runs over, and the level is inert again.
[time] HoldsAt(Filling(),time) & HoldsAt(Level(3),time) -> Happens(Overflow(),time).
[time] Terminates(Overflow(),Filling(),time).
[time] Initiates(Overflow(),Spilling(),time).
[time,level] HoldsAt(Level(level),time) -> Initiates(Overflow(),Level(level),time).

HoldsAt(Level(0),0).
!HoldsAt(Filling(),0).
!HoldsAt(Spilling(),0).

Happens(Open(),0).

completion Happens
