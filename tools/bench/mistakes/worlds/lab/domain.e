; Two tubes that are filled, spun, poured together and frozen.
sort tube
tube alpha, beta
sort place
place bench, spinner, cold
sort dose: integer
range dose 0 3

fluent At(tube,place)
fluent Filled(tube,dose)
fluent Capped(tube)
fluent Parted(tube)
fluent Frozen(tube)
fluent Spinning()
fluent Dirty()
fluent Busy()
noninertial Busy

event Pipette(tube,dose)
event Merge(tube,tube)
event Cap(tube)
event Uncap(tube)
event Carry(tube,place)
event Start()
event Stop()
event Wipe()
event Wait()
event Settle(tube)
event Spill(tube)
event Freeze(tube)
event Thaw(tube)
