; Yale shooting. The gun is loaded, then one waits, then one shoots at the turkey. Does it die?
; A naive minimisation of change also lets the gun lose its bullet while one waits; inertia
; restricted by known effects (DEC5 to DEC12) does not.
;
; Source: see gun.e.
;
; Expected: 1 trace. State and narrative are fixed and no effect is indeterminate: Loaded holds at 1
; and 2, the turkey is dead at 3.

load gun.e

range time 0 3

HoldsAt(Alive(),0).
!HoldsAt(Loaded(),0).

Happens(Load(),0).
Happens(Wait(),1).
Happens(Shoot(),2).

completion Happens
