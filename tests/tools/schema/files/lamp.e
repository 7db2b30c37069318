sort lamp
lamp A, B

fluent On(lamp)
event Press(lamp)
predicate Old(lamp)

[lamp,time] !HoldsAt(On(lamp),time) -> Initiates(Press(lamp),On(lamp),time).
[lamp,time] HoldsAt(On(lamp),time) & Old(lamp) -> Terminates(Press(lamp),On(lamp),time).
[lamp] !HoldsAt(On(lamp),0).
[lamp] !ReleasedAt(On(lamp),0).

range time 0 2
range offset 1 1
