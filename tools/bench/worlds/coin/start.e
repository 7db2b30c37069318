; The coin lies in the hand with its head up, and nobody looks.

HoldsAt(Heads(),0).
!HoldsAt(Spinning(),0).
!HoldsAt(Shown(),0).
