; The stuffy room. A room has two vents. A box on a vent blocks it, and with both blocked the air is
; stuffy. Putting boxes down says nothing of vents or air: these are indirect effects, by state
; constraints that tie fluents without inertia to the others.
;
; Source: M. Ginsberg and D. Smith, "Reasoning about action I: a possible worlds approach",
; Artificial Intelligence 35, 1988.
;
; Expected: 1 trace. Stuffy holds at 1 only: the second vent is blocked at 0, the first is freed at 1.
;
; Language: a vent is a place (subsort), so On takes both; Stuffy and Blocked are noninertial.

range time 0 2

sort box
box Crate, Trunk

sort place
sort vent: place
place Floor
vent North, South

fluent On(box,place)
fluent Blocked(vent)
fluent Stuffy()
noninertial Blocked, Stuffy

event Put(box,place)

; A box stands in one place, and a place other than the floor bears one box.
[time,box] {place} HoldsAt(On(box,place),time).
[time,box,place1,place2]
  HoldsAt(On(box,place1),time) & HoldsAt(On(box,place2),time) -> place1=place2.
[time,box1,box2,place]
  HoldsAt(On(box1,place),time) & HoldsAt(On(box2,place),time) & place!=Floor -> box1=box2.

; The indirect effects.
[time,vent] HoldsAt(Blocked(vent),time) <-> ({box} HoldsAt(On(box,vent),time)).
[time] HoldsAt(Stuffy(),time) <-> ([vent] HoldsAt(Blocked(vent),time)).

[box,place,time] Initiates(Put(box,place),On(box,place),time).
[box,place1,place2,time] place1!=place2 -> Terminates(Put(box,place1),On(box,place2),time).

HoldsAt(On(Crate,North),0).
HoldsAt(On(Trunk,Floor),0).

Happens(Put(Trunk,South),0).
Happens(Put(Crate,Floor),1).

completion Happens
