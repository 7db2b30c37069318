; The kitchen as its modeller first saw it. Driving needs parked arms and nothing else: neither an
; open drawer nor what is held in a hand matters.

load common.e

[base,time]
  HoldsAt(Parked(left),time) & HoldsAt(Parked(right),time) ->
    Initiates(Go(base),RobotAt(base),time).
[base1,base2,time]
  HoldsAt(Parked(left),time) & HoldsAt(Parked(right),time) & base1!=base2 ->
    Terminates(Go(base1),RobotAt(base2),time).
[base,place,time]
  HoldsAt(Parked(left),time) & HoldsAt(Parked(right),time) & !HoldsAt(RobotAt(base),time) ->
    Terminates(Go(base),LookingAt(place),time).

; The camera sees what is where it looks.
[item,time]
  HoldsAt(Visible(item),time) <->
    ({base,place}
     HoldsAt(RobotAt(base),time) &
     HoldsAt(ItemAt(item,place),time) &
     Serves(base,place) &
     HoldsAt(Accessible(place),time) &
     HoldsAt(LookingAt(place),time)).
