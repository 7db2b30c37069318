; As in start.e, and no hand has gripped anything firmly yet.

load start.e

[arm] !HoldsAt(Secured(arm),0).
