; A board with six squares: a die is rolled and kept, pawns step, slide back and are captured.
sort player
player red, green
sort square: integer
range square 0 5
sort eye: integer
range eye 1 3
sort card
card shield, swap

fluent Pawn(player,square)
fluent Shown(eye)
fluent Kept()
fluent Holds(player,card)
fluent Deck(card)
fluent Shielded(player)
fluent Home(player)
fluent Turn(player)
fluent Leads(player)
noninertial Leads

event Roll()
event Keep()
event Step(player,eye)
event Draw(player,card)
event Play(player,card)
event Trade(player,player)
event Pass(player,player)
event Wait()
event Slide(player)
event Capture(player,player)
event Arrive(player)
