; The bus ride, observed: the traveller of bus_ride.e turns up at the museum.
;
; Expected: 2 traces. Of the three rides those by the red and the blue bus end there.

load bus_ride.e

HoldsAt(At(Museum),3).
