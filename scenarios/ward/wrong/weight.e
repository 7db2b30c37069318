; Forgotten: a full can is too heavy.

[spot,time]
  HoldsAt(Perceived(),time) & HoldsAt(CanAt(spot),time) & spot=front ->
    Initiates(PickUp(),Holding(),time).
[spot,time]
  HoldsAt(Perceived(),time) & HoldsAt(CanAt(spot),time) & spot=front ->
    Terminates(PickUp(),CanAt(spot),time).
[spot,time]
  HoldsAt(Perceived(),time) & HoldsAt(CanAt(spot),time) & spot=front ->
    Terminates(PickUp(),Parked(),time).
