; At the front of the cupboard the can is within reach. Full it is too heavy: it slips.

[spot,time]
  HoldsAt(Perceived(),time) & HoldsAt(CanAt(spot),time) & spot=front & !HoldsAt(Full(),time) ->
    Initiates(PickUp(),Holding(),time).
[spot,time]
  HoldsAt(Perceived(),time) & HoldsAt(CanAt(spot),time) & spot=front & !HoldsAt(Full(),time) ->
    Terminates(PickUp(),CanAt(spot),time).
[spot,time]
  HoldsAt(Perceived(),time) & HoldsAt(CanAt(spot),time) & spot=front ->
    Terminates(PickUp(),Parked(),time).
