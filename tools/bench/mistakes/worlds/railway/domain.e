; An engine shunts two wagons between three tracks; a barrier guards the main track.
sort track
track main, siding, spur
sort wagon
wagon coal, milk
sort load: integer
range load 0 3

function Mass(wagon): load

fluent EngineAt(track)
fluent WagonAt(wagon,track)
fluent Coupled(wagon)
fluent Load(load)
fluent Set(track,track)
fluent Barrier()
fluent Bell()
fluent Braked(wagon)
fluent Heavy()
fluent Clear(track)
noninertial Heavy, Clear

event Move(track,track)
event Throw(track,track)
event Couple(wagon)
event Uncouple(wagon)
event Brake(wagon)
event Loosen(wagon)
event Wait()
event Drop()
event Lift()
event Roll(wagon)
