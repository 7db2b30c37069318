; Animals and gates. A zoo has three yards in a row with a gate between neighbours. Animals walk
; through open gates as they like; the keeper opens one gate at the beginning and goes home. Two
; large animals do not share a yard, and a gate lets one animal through at a time.
;
; Source: the zoo world of the Logic Modelling Workshop (V. Akman, S. Erdogan, J. Lee, V. Lifschitz,
; H. Turner, "Representing the zoo world and the traffic world in the language of the causal
; calculator", Artificial Intelligence 153, 2004), much reduced.
;
; Expected: 10 traces. At 0 only the bison can walk, or not.
;   It stays: at 1 none of the large ones walks, or the bison walks, or the camel, but not both, for
;   they would meet in the pond. The hare walks or not unless the camel has its gate: 2 + 2 + 1.
;   It walks to the pond: at 1 none walks, or the bison walks back, or the bison walks back while
;   the camel follows into the pond. The hare likewise: 2 + 2 + 1. The bison cannot go on into the
;   den, where the camel is, nor can the two change places through one gate.
; Until the camel is in the pond for the first time: 2 traces, with and without the bison's walk at 0
; (events only; what the hare does at 1 is excluded by the camel's use of the gate).
;
; Language: subsorts, functions, fluents with several arguments, preconditions, mutex.

range time 0 2

sort yard
yard Meadow, Pond, Den

sort gate
gate Oak, Iron

function West(gate): yard
function East(gate): yard
West(Oak)=Meadow.
East(Oak)=Pond.
West(Iron)=Pond.
East(Iron)=Den.

sort animal
sort large: animal
large Bison, Camel
animal Hare

fluent In(animal,yard)
fluent Ajar(gate)

event Walk(animal,gate)
event Open(gate)
event Shut(gate)
mutex Open, Shut

; Every animal is in one yard, and no yard has two large ones.
[time,animal] {yard} HoldsAt(In(animal,yard),time).
[time,animal,yard1,yard2]
  HoldsAt(In(animal,yard1),time) & HoldsAt(In(animal,yard2),time) -> yard1=yard2.
[time,large1,large2,yard]
  HoldsAt(In(large1,yard),time) & HoldsAt(In(large2,yard),time) -> large1=large2.

; Walking leads to the other side of the gate.
[animal,gate,yard,time]
  yard=East(gate) & HoldsAt(In(animal,West(gate)),time) ->
    Initiates(Walk(animal,gate),In(animal,yard),time).
[animal,gate,yard,time]
  yard=West(gate) & HoldsAt(In(animal,East(gate)),time) ->
    Initiates(Walk(animal,gate),In(animal,yard),time).
[animal,gate,yard,time]
  HoldsAt(In(animal,yard),time) -> Terminates(Walk(animal,gate),In(animal,yard),time).

; An animal walks through an open gate beside it, alone, and through one gate at a time.
[animal,gate,time]
  Happens(Walk(animal,gate),time) ->
    HoldsAt(Ajar(gate),time) &
    (HoldsAt(In(animal,West(gate)),time) | HoldsAt(In(animal,East(gate)),time)).
[animal1,animal2,gate,time]
  Happens(Walk(animal1,gate),time) & Happens(Walk(animal2,gate),time) -> animal1=animal2.
[animal,gate1,gate2,time]
  Happens(Walk(animal,gate1),time) & Happens(Walk(animal,gate2),time) -> gate1=gate2.

[gate,time] Initiates(Open(gate),Ajar(gate),time).
[gate,time] Terminates(Shut(gate),Ajar(gate),time).

[gate,time] Happens(Open(gate),time) <-> gate=Iron & time=0.
[gate,time] !Happens(Shut(gate),time).

[gate] HoldsAt(Ajar(gate),0) <-> gate=Oak.
HoldsAt(In(Bison,Meadow),0).
HoldsAt(In(Camel,Den),0).
HoldsAt(In(Hare,Den),0).
