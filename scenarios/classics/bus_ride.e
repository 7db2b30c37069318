; A bus ride. A traveller buys a ticket and takes a bus, but we do not know which of the three that
; stop here. Two of the lines go to the museum, one goes to the harbour.
;
; Source: G. N. Kartha, "Two counterexamples related to Baker's approach to the frame problem",
; Artificial Intelligence 69, 1994; disjunctive events as in M. Shanahan, Solving the Frame Problem,
; MIT Press, 1997.
;
; Expected: 3 traces, one for each bus. The disjunction is the only reason for an event at 1, and
; completion wants no more events than it needs, so that no two buses are taken at once.
; bus_ride_arrival.e: 2 traces, as the traveller turns up at the museum.
;
; Language: a disjunction of events under `completion Happens`; a function as a table.

range time 0 3

sort stop
stop Market, Museum, Harbour

sort bus
bus Red, Yellow, Blue

function Line(bus): stop
Line(Red)=Museum.
Line(Yellow)=Harbour.
Line(Blue)=Museum.

fluent At(stop)
fluent Aboard(bus)
fluent Ticket()

event Buy()
event Board(bus)
event Arrive(bus)

[time] Initiates(Buy(),Ticket(),time).

[bus,time] Initiates(Board(bus),Aboard(bus),time).
[bus,stop,time] HoldsAt(At(stop),time) -> Terminates(Board(bus),At(stop),time).
[bus,time] Happens(Board(bus),time) -> HoldsAt(Ticket(),time).

[bus,time] Terminates(Arrive(bus),Aboard(bus),time).
[bus,stop,time] stop=Line(bus) -> Initiates(Arrive(bus),At(stop),time).

; Who is on a bus arrives with it at the next timepoint.
[bus,time] HoldsAt(Aboard(bus),time) -> Happens(Arrive(bus),time).

[stop] HoldsAt(At(stop),0) <-> stop=Market.
[bus] !HoldsAt(Aboard(bus),0).
!HoldsAt(Ticket(),0).

Happens(Buy(),0).
{bus} Happens(Board(bus),1).

completion Happens
