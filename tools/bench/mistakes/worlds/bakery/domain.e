; An oven with a knob, a timer and two trays of bread.
sort tray
tray white, rye
sort heat: integer
range heat 0 3
sort minute: integer
range minute 0 3

fluent OnRack(tray)
fluent Held(tray)
fluent InOven(tray)
fluent Baked(tray)
fluent Burnt(tray)
fluent Ready(tray)
fluent OvenOpen()
fluent Hot(heat)
fluent Timer(minute)
fluent Ringing()
fluent Smoke()
noninertial Ready

event Take(tray)
event Load(tray)
event Unload(tray)
event Rack(tray)
event Open()
event Shut()
event Turn(heat)
event Set(minute)
event Hush()
event Air()
event Wait()
event Cool()
event Bake(tray)
event Burn(tray)
event Tick()
