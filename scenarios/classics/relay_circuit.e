; A circuit with a relay. The lamp gets current when the switches Feed and Branch are both closed. The
; relay pulls when Feed and Coil are closed, and a pulled relay opens Branch. All are drawn with
; Branch and Coil closed and Feed open; now Feed is closed. Does the lamp flash?
;
; Source: M. Thielscher, "Ramification and causality", Artificial Intelligence 89, 1997; the causal
; constraints follow M. Shanahan, "The ramification problem in the event calculus", IJCAI 1999.
;
; Expected: 1 trace. Closing Feed makes the relay pull and Branch open at the same timepoint, so that
; Branch is not initiated in the sense of foundations/ECCausal.e and nothing lights the lamp. At 1
; Feed, Coil and Pulled hold, Branch and Lit do not, and nothing more happens at 1.

load foundations/ECCausal.e

range time 0 2

sort switch
switch Feed, Branch, Coil

fluent Closed(switch)
fluent Pulled()
fluent Lit()

event Close(switch)
event Open(switch)
event Pull()
event Light()

[switch,time] Initiates(Close(switch),Closed(switch),time).
[switch,time] Terminates(Open(switch),Closed(switch),time).
[time] Initiates(Pull(),Pulled(),time).
[time] Initiates(Light(),Lit(),time).

; Causal constraints: what is made to be so brings about the next event at the same timepoint.
[time]
  Stopped(Pulled(),time) & Initiated(Closed(Feed),time) & Initiated(Closed(Coil),time) ->
    Happens(Pull(),time).
[time] Started(Closed(Branch),time) & Initiated(Pulled(),time) -> Happens(Open(Branch),time).
[time]
  Stopped(Lit(),time) & Initiated(Closed(Feed),time) & Initiated(Closed(Branch),time) ->
    Happens(Light(),time).

[switch] HoldsAt(Closed(switch),0) <-> switch!=Feed.
!HoldsAt(Pulled(),0).
!HoldsAt(Lit(),0).

Happens(Close(Feed),0).

completion Happens
