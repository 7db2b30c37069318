; A carrier with a battery between a dock, a yard and a shed behind a gate.
sort spot
spot dock, yard, shed
sort crate
crate red, blue
sort charge: integer
range charge 0 4

function Way(spot,spot): charge

fluent RobotAt(spot)
fluent CrateAt(crate,spot)
fluent Carried(crate)
fluent Charge(charge)
fluent Plugged()
fluent GateOpen()
fluent Warned()
fluent Low()
noninertial Low

event Drive(spot,spot)
event Plug()
event Unplug()
event Lift(crate)
event Drop(crate)
event Knock()
event Wait()
event Fill()
event Beep()
event Close()
