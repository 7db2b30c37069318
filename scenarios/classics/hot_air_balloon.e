; A hot-air balloon. With the burner on the balloon rises, with the burner off it sinks: one fluent
; develops one way while another holds and the other way while it does not. The pilot lights the
; burner on the ground, turns it off two steps up, and lights it again one step above the ground.
;
; Source: M. Shanahan and R. Miller on antitrajectories ("Some alternative formulations of the event
; calculus", 2002); the balloon is an example in E. Mueller, Commonsense Reasoning, Morgan Kaufmann,
; 2006.
;
; Expected: 1 trace: heights 0, 1, 2, 1, 2 at 0 to 4. Each height follows from the last event before
; it: StoppedIn and StartedIn cut every trajectory at the next event of the burner.

range time 0 4
range offset 1 4

sort height: integer
range height 0 4

fluent Burning()
fluent Height(height)
noninertial Height

event Light()
event Douse()

[time] {height} HoldsAt(Height(height),time).
[time,height1,height2]
  HoldsAt(Height(height1),time) & HoldsAt(Height(height2),time) -> height1=height2.

[time] Initiates(Light(),Burning(),time).
[time] Terminates(Douse(),Burning(),time).

[time,offset,height1,height2]
  HoldsAt(Height(height1),time) & height2=height1+offset ->
    Trajectory(Burning(),time,Height(height2),offset).
[time,offset,height1,height2]
  HoldsAt(Height(height1),time) & height2=height1-offset ->
    AntiTrajectory(Burning(),time,Height(height2),offset).

!HoldsAt(Burning(),0).
HoldsAt(Height(0),0).

Happens(Light(),0).
Happens(Douse(),2).
Happens(Light(),3).

completion Happens
