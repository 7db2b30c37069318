; Faulty lamps. Lamps light when they are switched on, unless something is wrong with them. The bulb
; of the red lamp is known to be burnt out, and the green one is known to be unplugged; of the blue
; one nothing is known, and what is not known to be abnormal is normal.
;
; Source: cancellation of effects by abnormality predicates, J. McCarthy, "Applications of
; circumscription to formalizing common-sense knowledge", Artificial Intelligence 28, 1986.
;
; Expected: 1 trace. Only the blue lamp lights. Without `completion Theta Abnormal` the blue lamp could
; be abnormal too: 2 traces that tell it.
;
; Language: formulas under labels, each completed for its own predicate; a user predicate in the
; condition of an effect.

range time 0 1

sort lamp
lamp Red, Green, Blue

fluent Lit(lamp)
fluent BurntOut(lamp)
fluent Unplugged(lamp)

event SwitchOn(lamp)

predicate Abnormal(lamp,time)

[lamp,time] !Abnormal(lamp,time) -> Initiates(SwitchOn(lamp),Lit(lamp),time).

Theta: [lamp,time] HoldsAt(BurntOut(lamp),time) -> Abnormal(lamp,time).
Theta: [lamp,time] HoldsAt(Unplugged(lamp),time) -> Abnormal(lamp,time).
completion Theta Abnormal

Delta: [lamp] Happens(SwitchOn(lamp),0).
completion Delta Happens

[lamp] !HoldsAt(Lit(lamp),0).
[lamp] HoldsAt(BurntOut(lamp),0) <-> lamp=Red.
[lamp] HoldsAt(Unplugged(lamp),0) <-> lamp=Green.
