; Carried things. Ada walks from the hall to the kitchen with a bag on her arm. Where is the bag, and
; where is the apple? What is carried comes along, and what is in it: an effect that follows from an
; effect, as far as it goes.
;
; Source: after the carried book of E. T. Mueller, Commonsense Reasoning, 2006, section 6.4.
;
; Expected: 2 traces. Nobody said whether the apple was in the bag: if so it is in the kitchen at 1,
; else still in the hall. Everything else is fixed.

range time 0 1

sort thing
sort room
thing Ada, Bag, Apple
room Hall, Kitchen

fluent In(thing,room)
fluent Carries(thing,thing)
event Walk(room)

[room,time] Initiates(Walk(room),In(Ada,room),time).
[room1,room2,time]
  HoldsAt(In(Ada,room1),time) & room1!=room2 -> Terminates(Walk(room2),In(Ada,room1),time).

; The effect constraints.
[event,thing1,thing2,room,time]
  Initiates(event,In(thing1,room),time) & HoldsAt(Carries(thing1,thing2),time) ->
    Initiates(event,In(thing2,room),time).
[event,thing1,thing2,room,time]
  Terminates(event,In(thing1,room),time) & HoldsAt(Carries(thing1,thing2),time) ->
    Terminates(event,In(thing2,room),time).

[thing,room] HoldsAt(In(thing,room),0) <-> room=Hall.
HoldsAt(Carries(Ada,Bag),0).
[thing1,thing2]
  HoldsAt(Carries(thing1,thing2),0) -> (thing1=Ada & thing2=Bag) | (thing1=Bag & thing2=Apple).

Happens(Walk(Kitchen),0).

completion Happens
