; The stolen car. A car is parked on the first evening and gone on the last morning. When was it
; taken? Nothing says, so no night may be preferred to another.
;
; Source: H. Kautz, "The logic of persistence", Proceedings of AAAI 1986.
;
; Expected: 3 traces, one for each of the timepoints 0, 1 and 2 at which the theft can lie. Events are
; not completed, so a theft may be assumed: reasoning from what was seen to what happened. There is
; only one, as a car that is gone cannot be taken.

range time 0 3

fluent Parked()

event Steal()

[time] Terminates(Steal(),Parked(),time).
[time] Happens(Steal(),time) -> HoldsAt(Parked(),time).

HoldsAt(Parked(),0).
!HoldsAt(Parked(),3).
