[square] HoldsAt(Pawn(red,square),0) <-> square=1.
[square] HoldsAt(Pawn(green,square),0) <-> square=0.
[eye] HoldsAt(Shown(eye),0) <-> eye=1.
!HoldsAt(Kept(),0).
[player,card] !HoldsAt(Holds(player,card),0).
[card] HoldsAt(Deck(card),0).
[player] !HoldsAt(Shielded(player),0).
[player] !HoldsAt(Home(player),0).
[player] HoldsAt(Turn(player),0) <-> player=red.
