[parcel] HoldsAt(OnTable(parcel),0).
[parcel] !HoldsAt(OnBelt(parcel),0).
[parcel,chute] !HoldsAt(InBin(parcel,chute),0).
[parcel,chute] HoldsAt(Label(parcel,chute),0) <-> parcel=roll & chute=south.
[parcel] HoldsAt(Stamped(parcel),0) <-> parcel=sack.
[parcel] !HoldsAt(Loose(parcel),0).
[stamp] HoldsAt(Stamps(stamp),0) <-> stamp=2.
!HoldsAt(Belt(),0).
[chute] !HoldsAt(Blocked(chute),0).
