; A mail protocol. A letter and its receipt travel over a network that delivers or loses what it
; carries, a step after it was sent. Who gets the letter sends the receipt a step later. Who sent
; the letter and has no receipt four steps later sends it again.
;
; Source: stop and wait, as in K. Bartlett, R. Scantlebury and P. Wilkinson, "A note on reliable
; full-duplex transmission over half-duplex links", Communications of the ACM 12, 1969; protocols
; between agents in the event calculus: E. Mueller, Commonsense Reasoning, Morgan Kaufmann, 2006.
;
; Expected: 5 traces up to timepoint 6, by what the network does:
;   1. letter and receipt arrive; nothing is sent again;
;   2., 3. the receipt is lost at 3, the letter is sent again at 4, and arrives or is lost at 5;
;   4., 5. the letter is lost at 1, is sent again at 4, and arrives or is lost at 5.
;
; Language: disjunctive events that follow from a state, triggers that reach to a later timepoint
; (at the last one there is none, and the rule says nothing), all reasons under one label.

range time 0 6

sort item
item Letter, Receipt

fluent Underway(item)
fluent Arrived(item)

event Send(item)
event Deliver(item)
event Lose(item)

[item,time] Initiates(Send(item),Underway(item),time).
[item,time] Terminates(Deliver(item),Underway(item),time).
[item,time] Terminates(Lose(item),Underway(item),time).
[item,time] Initiates(Deliver(item),Arrived(item),time).

; The network: one of the two, as neither has another reason.
Delta: [item,time]
  HoldsAt(Underway(item),time) -> Happens(Deliver(item),time) | Happens(Lose(item),time).

; The two ends.
Delta: [time] Happens(Deliver(Letter),time) -> Happens(Send(Receipt),time+1).
Delta: [time]
  Happens(Send(Letter),time) & !HoldsAt(Arrived(Receipt),time+4) -> Happens(Send(Letter),time+4).

Delta: Happens(Send(Letter),0).

completion Delta Happens

[item] !HoldsAt(Underway(item),0).
[item] !HoldsAt(Arrived(item),0).
