load domain.e
[time] Happens(Roll(),time) -> !HoldsAt(Kept(),time).
[eye,time] Releases(Roll(),Shown(eye),time).
[eye,time] HoldsAt(Shown(eye),time) -> Initiates(Keep(),Shown(eye),time).
[eye,time] !HoldsAt(Shown(eye),time) -> Terminates(Keep(),Shown(eye),time).
[time] Initiates(Keep(),Kept(),time).
[player,eye,time] Happens(Step(player,eye),time) -> HoldsAt(Turn(player),time) & HoldsAt(Kept(),time).
[player,square1,square2,eye,time] HoldsAt(Pawn(player,square1),time) & square2=square1+eye -> Initiates(Step(player,eye),Pawn(player,square2),time).
[player,square,eye,time] HoldsAt(Pawn(player,square),time) & square+eye<6 -> Terminates(Step(player,eye),Pawn(player,square),time).
[player,eye,time] Terminates(Step(player,eye),Kept(),time).
[player,card,time] Happens(Draw(player,card),time) -> HoldsAt(Turn(player),time) & HoldsAt(Deck(card),time).
[player,card,time] Initiates(Draw(player,card),Holds(player,card),time).
[player,card,time] Terminates(Draw(player,card),Deck(card),time).
[player,card,time] Happens(Play(player,card),time) -> HoldsAt(Holds(player,card),time).
[player,card,time] Terminates(Play(player,card),Holds(player,card),time).
[player,card,time] Initiates(Play(player,card),Deck(card),time).
[player,time] Initiates(Play(player,shield),Shielded(player),time).
[player1,player2,square,time] player1!=player2 & HoldsAt(Pawn(player2,square),time) -> Initiates(Trade(player1,player2),Pawn(player1,square),time).
[player1,player2,square1,square2,time] player1!=player2 & HoldsAt(Pawn(player1,square1),time) & HoldsAt(Pawn(player2,square2),time) & square1!=square2 -> Terminates(Trade(player1,player2),Pawn(player1,square1),time).
[player1,player2,square,time] player1!=player2 & HoldsAt(Pawn(player1,square),time) -> Initiates(Trade(player1,player2),Pawn(player2,square),time).
[player1,player2,square1,square2,time] player1!=player2 & HoldsAt(Pawn(player1,square1),time) & HoldsAt(Pawn(player2,square2),time) & square1!=square2 -> Terminates(Trade(player1,player2),Pawn(player2,square2),time).
[player1,player2,time] Happens(Trade(player1,player2),time) -> HoldsAt(Holds(player1,swap),time) & !HoldsAt(Shielded(player2),time).
[player1,player2,time] Initiates(Pass(player1,player2),Turn(player2),time).
[player1,player2,time] player1!=player2 -> Terminates(Pass(player1,player2),Turn(player1),time).
[player1,player2,time] Happens(Pass(player1,player2),time) -> HoldsAt(Turn(player1),time).
[player1,player2,time] HoldsAt(Shielded(player2),time) -> Terminates(Pass(player1,player2),Shielded(player2),time).
[player,time] HoldsAt(Pawn(player,3),time) -> Happens(Slide(player),time).
[player,square1,square2,time] HoldsAt(Pawn(player,square1),time) & square2=square1-2 -> Initiates(Slide(player),Pawn(player,square2),time).
[player,square,time] HoldsAt(Pawn(player,square),time) -> Terminates(Slide(player),Pawn(player,square),time).
[player1,player2,time] HoldsAt(Turn(player1),time) & HoldsAt(Pawn(player1,2),time) & HoldsAt(Pawn(player2,2),time) & player1!=player2 & !HoldsAt(Shielded(player2),time) -> Happens(Capture(player1,player2),time).
[player1,player2,time] Initiates(Capture(player1,player2),Pawn(player2,0),time).
[player1,player2,time] Terminates(Capture(player1,player2),Pawn(player2,2),time).
[player,time] HoldsAt(Pawn(player,5),time) & !HoldsAt(Home(player),time) -> Happens(Arrive(player),time).
[player,time] Initiates(Arrive(player),Home(player),time).
[player1,time] HoldsAt(Leads(player1),time) <-> {player2,square1,square2} HoldsAt(Pawn(player1,square1),time) & HoldsAt(Pawn(player2,square2),time) & square1>square2.
[player,square1,square2,time] HoldsAt(Pawn(player,square1),time) & HoldsAt(Pawn(player,square2),time) -> square1=square2.
[eye1,eye2,time] HoldsAt(Shown(eye1),time) & HoldsAt(Shown(eye2),time) -> eye1=eye2.
[time] {eye} HoldsAt(Shown(eye),time).
[player1,player2,time] HoldsAt(Turn(player1),time) & HoldsAt(Turn(player2),time) -> player1=player2.
[player,card,time] HoldsAt(Deck(card),time) -> !HoldsAt(Holds(player,card),time).
