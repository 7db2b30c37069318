; The turkey lives; the gun is empty and aimed at nothing.

HoldsAt(Alive(),0).
!HoldsAt(Loaded(),0).
!HoldsAt(Aimed(),0).
