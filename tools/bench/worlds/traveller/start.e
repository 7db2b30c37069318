; At the market, on no bus, without a ticket.

HoldsAt(At(Market),0).
[bus] !HoldsAt(Aboard(bus),0).
!HoldsAt(Ticket(),0).
