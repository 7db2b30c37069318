; The bus ride of scenarios/classics/bus_ride.e with a traveller who buys a ticket from a machine
; that may be empty, rides to where the line ends, and gets off.

sort stop
sort bus
stop Market, Museum, Harbour
bus Red, Yellow

predicate Ends(bus,stop)
[bus,stop] Ends(bus,stop) <-> bus=Red & stop=Museum | bus=Yellow & stop=Harbour.

fluent At(stop)
fluent Aboard(bus)
fluent Ticket()

event Buy()
event Board(bus)
event Ride(bus)

[stop1,stop2,time] HoldsAt(At(stop1),time) & HoldsAt(At(stop2),time) -> stop1=stop2.
[bus,stop,time] HoldsAt(Aboard(bus),time) -> !HoldsAt(At(stop),time).

[time] Releases(Buy(),Ticket(),time).

[bus,time] Happens(Board(bus),time) -> HoldsAt(Ticket(),time).
[bus,time] HoldsAt(At(Market),time) -> Initiates(Board(bus),Aboard(bus),time).
[bus,stop,time] HoldsAt(At(Market),time) -> Terminates(Board(bus),At(stop),time).

[bus,stop,time] Ends(bus,stop) & HoldsAt(Aboard(bus),time) -> Initiates(Ride(bus),At(stop),time).
[bus,time] Terminates(Ride(bus),Aboard(bus),time).
[bus,time] HoldsAt(Aboard(bus),time) -> Terminates(Ride(bus),Ticket(),time).
