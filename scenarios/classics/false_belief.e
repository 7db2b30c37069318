; Beliefs and plans. Ann keeps a key on the shelf and leaves the room. Bo puts it into the drawer.
; Ann comes back, needs the key and plans by what she believes: she looks on the shelf first, finds
; nothing there, and then looks in the drawer. Bo, who saw it all, knows what Ann thinks.
;
; Source: the false-belief task of S. Baron-Cohen, A. Leslie and U. Frith ("Does the autistic child
; have a theory of mind?", Cognition 21, 1985); plans chosen from beliefs and goals as in E. Mueller,
; Commonsense Reasoning, Morgan Kaufmann, 2006, on the mental states of agents.
;
; Expected: 1 trace. Nothing is left open: plans follow from beliefs, events from plans, and the
; narrative is complete. Ann looks on the shelf at 3, in the drawer at 4, and holds the key at 5.
;
; Language: reified sorts of our own, one inside the other (an attitude is about a belief); equality
; of their terms; a user predicate completed under one label while events are under another.

range time 0 5

sort agent
agent Ann, Bo

sort thing
thing Key

sort place
place Shelf, Drawer

reified sort belief
belief Located(thing,place)

reified sort attitude
attitude Thinks(agent,belief)

fluent In(thing,place)
fluent Has(agent,thing)
fluent Present(agent)
fluent Wants(agent,thing)
fluent Believes(agent,belief)
fluent Knows(agent,attitude)

event Leave(agent)
event Return(agent)
event Need(agent,thing)
event Stow(agent,thing,place)
event Look(agent,thing,place)

predicate Plan(agent,thing,place,time)

[agent,time] Terminates(Leave(agent),Present(agent),time).
[agent,time] Initiates(Return(agent),Present(agent),time).
[agent,thing,time] Initiates(Need(agent,thing),Wants(agent,thing),time).

; The world: a stowed thing is where it was put.
[agent,thing,place,time] Initiates(Stow(agent,thing,place),In(thing,place),time).
[agent,thing,place1,place2,time]
  place1!=place2 -> Terminates(Stow(agent,thing,place1),In(thing,place2),time).

; Who is present sees where a thing is put, and sees who else sees it.
[agent1,agent2,thing,place,belief,time]
  belief=Located(thing,place) & HoldsAt(Present(agent2),time) ->
    Initiates(Stow(agent1,thing,place),Believes(agent2,belief),time).
[agent1,agent2,thing,place1,place2,belief,time]
  belief=Located(thing,place2) & place1!=place2 & HoldsAt(Present(agent2),time) ->
    Terminates(Stow(agent1,thing,place1),Believes(agent2,belief),time).
[agent,agent1,agent2,thing,place,attitude,time]
  attitude=Thinks(agent2,Located(thing,place)) &
  HoldsAt(Present(agent1),time) &
  HoldsAt(Present(agent2),time) ->
    Initiates(Stow(agent,thing,place),Knows(agent1,attitude),time).
[agent,agent1,agent2,thing,place1,place2,attitude,time]
  attitude=Thinks(agent2,Located(thing,place2)) &
  place1!=place2 &
  HoldsAt(Present(agent1),time) &
  HoldsAt(Present(agent2),time) ->
    Terminates(Stow(agent,thing,place1),Knows(agent1,attitude),time).

; Looking in the right place ends the wish; looking in a wrong one changes the mind.
[agent,thing,place,time]
  HoldsAt(In(thing,place),time) -> Initiates(Look(agent,thing,place),Has(agent,thing),time).
[agent,thing,place,time]
  HoldsAt(In(thing,place),time) -> Terminates(Look(agent,thing,place),In(thing,place),time).
[agent,thing,place,time]
  HoldsAt(In(thing,place),time) -> Terminates(Look(agent,thing,place),Wants(agent,thing),time).
[agent,thing,place,belief,time]
  belief=Located(thing,place) -> Terminates(Look(agent,thing,place),Believes(agent,belief),time).
[agent,thing,place1,place2,belief,time]
  belief=Located(thing,place2) & place1!=place2 & !HoldsAt(In(thing,place1),time) ->
    Initiates(Look(agent,thing,place1),Believes(agent,belief),time).

; A plan has one reason only: a wish and a belief, in the room.
Theta: [agent,thing,place,time]
  HoldsAt(Present(agent),time) &
  HoldsAt(Wants(agent,thing),time) &
  HoldsAt(Believes(agent,Located(thing,place)),time) ->
    Plan(agent,thing,place,time).
completion Theta Plan

; What is planned is done.
Delta: [agent,thing,place,time]
  Plan(agent,thing,place,time) -> Happens(Look(agent,thing,place),time).
Delta: Happens(Leave(Ann),0).
Delta: Happens(Stow(Bo,Key,Drawer),1).
Delta: Happens(Return(Ann),2).
Delta: Happens(Need(Ann,Key),2).
completion Delta Happens

; Both have seen the key on the shelf, and that the other one saw it. Nobody wants it yet.
[agent] HoldsAt(Present(agent),0).
[thing,place] HoldsAt(In(thing,place),0) <-> place=Shelf.
[agent,thing] !HoldsAt(Has(agent,thing),0).
[agent,thing] !HoldsAt(Wants(agent,thing),0).
[agent,belief] HoldsAt(Believes(agent,belief),0) <-> belief=Located(Key,Shelf).
[agent1,attitude]
  HoldsAt(Knows(agent1,attitude),0) <-> ({agent2} attitude=Thinks(agent2,Located(Key,Shelf))).
