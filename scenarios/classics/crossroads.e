; Traffic lights. Two roads cross. Each shows stop or go, never both roads go, and a light that has
; turned does not turn again at the next step.
;
; Source: safety of a crossing is a stock example of temporal logic (Z. Manna and A. Pnueli, The
; Temporal Logic of Reactive and Concurrent Systems, Springer, 1992); the formulation is ours.
;
; Expected: 11 traces up to timepoint 3. A light can turn at no timepoint, at 0, at 1, at 2, or at 0
; and 2. It then shows go never, at 1 to 3, at 2 to 3, at 3, or at 1 to 2. Of the 25 pairs those fit
; in which one never goes (5 + 5 - 1) and those of the disjoint sets {3} and {1,2} (2).
;
; Language: xor of fluents with an argument, a formula over two timepoints, arithmetic on time.

range time 0 3

sort road
road North, East

fluent Stop(road)
fluent Go(road)
xor Stop, Go

event Turn(road)

[road,time] HoldsAt(Stop(road),time) -> Initiates(Turn(road),Go(road),time).
[road,time] HoldsAt(Stop(road),time) -> Terminates(Turn(road),Stop(road),time).
[road,time] HoldsAt(Go(road),time) -> Initiates(Turn(road),Stop(road),time).
[road,time] HoldsAt(Go(road),time) -> Terminates(Turn(road),Go(road),time).

[road1,road2,time] HoldsAt(Go(road1),time) & HoldsAt(Go(road2),time) -> road1=road2.

[road,time1,time2]
  Happens(Turn(road),time1) & Happens(Turn(road),time2) & time1<time2 -> time2-time1>=2.

[road] HoldsAt(Stop(road),0).
