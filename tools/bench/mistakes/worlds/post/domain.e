; Parcels are stamped, labelled and put on a belt that slides them into bins.
sort parcel
parcel box, roll, sack
sort chute
chute north, south
sort stamp: integer
range stamp 0 3

fluent OnTable(parcel)
fluent OnBelt(parcel)
fluent InBin(parcel,chute)
fluent Label(parcel,chute)
fluent Stamped(parcel)
fluent Loose(parcel)
fluent Stamps(stamp)
fluent Belt()
fluent Blocked(chute)
fluent Heap(chute)
noninertial Heap

event Stamp(parcel)
event Tag(parcel,chute)
event Put(parcel)
event Shake(parcel)
event Tie(parcel)
event SwitchOn()
event SwitchOff()
event Empty(chute)
event Wait()
event Slide(parcel,chute)
event Jam(chute)
event Trip()
