; The commuter. Going to work means to walk to the station, to ride to the city and to walk to the
; office, with nothing in between that takes the commuter away again: an event that takes time and is
; made of others. Events of this kind are a predicate of the model, `Happens3(event,time,time)`, from
; when to when; their effects are those of their parts.
;
; Source: M. Shanahan, "The event calculus explained", Artificial Intelligence Today, 1999, section 3.
;
; Expected: 1 trace. The narrative is fixed; GoToWork() lasts from 0 to 3.

load foundations/DEC.e

range time 0 4

sort place
place Home, Station, City, Office

fluent At(place)
event WalkTo(place)
event RideTo(place)
event GoToWork()

predicate Happens3(event,time,time)

[place,time] Initiates(WalkTo(place),At(place),time).
[place1,place2,time]
  HoldsAt(At(place1),time) & place1!=place2 -> Terminates(WalkTo(place2),At(place1),time).
[place,time] Initiates(RideTo(place),At(place),time).
[place1,place2,time]
  HoldsAt(At(place1),time) & place1!=place2 -> Terminates(RideTo(place2),At(place1),time).

; What takes no time, and the compound event.
[event,time] Happens(event,time) -> Happens3(event,time,time).
[time1,time2,time3]
  Happens3(WalkTo(Station),time1,time1) &
  Happens3(RideTo(City),time2,time2) &
  Happens3(WalkTo(Office),time3,time3) &
  time1<time2 &
  time2<time3 &
  !Clipped(time1,At(Station),time2) &
  !Clipped(time2,At(City),time3) ->
    Happens3(GoToWork(),time1,time3).
completion Happens3

[place] HoldsAt(At(place),0) <-> place=Home.
Happens(WalkTo(Station),0).
Happens(RideTo(City),2).
Happens(WalkTo(Office),3).
completion Happens
