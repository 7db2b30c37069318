; Two falling objects. An apple is let go nine steps above the ground, a lemon four steps, a moment
; later. They fall alike, each counted from its own event, and come down together.
;
; Source: as falling_object.e; the arguments keep the two developments apart.
;
; Expected: 1 trace. Apple 9, 8, 5, 0; lemon 4, 4, 3, 0; both land at 3.
;
; Language: Height is noninertial here, so heights at rest need a formula of their own; the start
; heights are a function.

range time 0 4
range offset 1 4

sort fruit
fruit Apple, Lemon

sort height: integer
range height 0 9

function Start(fruit): height
Start(Apple)=9.
Start(Lemon)=4.

fluent Falling(fruit)
fluent Height(fruit,height)
noninertial Height

event LetGo(fruit)
event Land(fruit)

[time,fruit] {height} HoldsAt(Height(fruit,height),time).
[time,fruit,height1,height2]
  HoldsAt(Height(fruit,height1),time) & HoldsAt(Height(fruit,height2),time) -> height1=height2.

; What does not fall stays where it is, also in the moment in which it is let go or lands.
[time,fruit,height]
  !HoldsAt(Falling(fruit),time) &
  HoldsAt(Height(fruit,height),time) &
  !Happens(LetGo(fruit),time) ->
    HoldsAt(Height(fruit,height),time+1).
[time,fruit,height]
  Happens(Land(fruit),time) & HoldsAt(Height(fruit,height),time) ->
    HoldsAt(Height(fruit,height),time+1).

[time,fruit] Initiates(LetGo(fruit),Falling(fruit),time).
[time,fruit,offset,height1,height2]
  HoldsAt(Height(fruit,height1),time) & height2=height1-offset*offset ->
    Trajectory(Falling(fruit),time,Height(fruit,height2),offset).

[time,fruit]
  HoldsAt(Falling(fruit),time) & HoldsAt(Height(fruit,0),time) -> Happens(Land(fruit),time).
[time,fruit] Terminates(Land(fruit),Falling(fruit),time).

[fruit,height] HoldsAt(Height(fruit,height),0) <-> height=Start(fruit).
[fruit] !HoldsAt(Falling(fruit),0).

Happens(LetGo(Apple),0).
Happens(LetGo(Lemon),1).

completion Happens
