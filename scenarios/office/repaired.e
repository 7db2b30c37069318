; The office after the discrepancies.

; A closed door bars the way through it; an open one stands across the way along the corridor.
[base1,base2,time]
  HoldsAt(Barred(base1,base2),time) <->
    (base1=front & base2=room | base1=room & base2=front) & ({door} !HoldsAt(DoorOpen(door),time)) |
    (base1=front & base2=kitchen | base1=kitchen & base2=front) &
      ({door} HoldsAt(DoorOpen(door),time)).

; Who stands before the door stands in its arc.
[base,door] Beside(base,door) <-> base=aside.

; What is far back on the desk is reached from the window.
[base,spot]
  Serves(base,spot) <->
    base=desk & spot=deskFront | base=window & spot=deskBack | base=kitchen & spot=counterTop.
