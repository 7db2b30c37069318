sort lamp
lamp A
fluent On(lamp)
event Press(lamp)
[lamp,time] Initiates(Pres(lamp),On(lamp),time).
range time 0 2
