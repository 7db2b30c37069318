load lamp.e

[lamp,time] !Happens(Press(lamp),time).
HoldsAt(On(A),2).
