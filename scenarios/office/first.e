; The office as its modeller first saw it on the floor plan.

; A closed door bars the way through it. An open one bars nothing.
[base1,base2,time]
  HoldsAt(Barred(base1,base2),time) <->
    (base1=front & base2=room | base1=room & base2=front) & ({door} !HoldsAt(DoorOpen(door),time)).

; The handle is within reach from before the door and from beside it.
[base,door] Beside(base,door) <-> base=front | base=aside.

; A desk is 0.8 m deep, and an arm reaches 0.9 m.
[base,spot]
  Serves(base,spot) <->
    base=desk & spot=deskFront |
    base=desk & spot=deskBack |
    base=window & spot=deskFront |
    base=window & spot=deskBack |
    base=kitchen & spot=counterTop.
