; Two basins, a hose with a pump, lamps, algae, and fish that are moved by a net.
sort basin
basin reef, pond
sort fish
fish carp, tetra
sort depth: integer
range depth 0 4

fluent Depth(basin,depth)
fluent Hose(basin,basin)
fluent Pumping()
fluent Lit(basin)
fluent Fed(basin)
fluent Algae(basin)
fluent FishIn(fish,basin)
fluent Stressed(fish)
fluent Netted(fish)
fluent Murky()
fluent Calm()
noninertial Murky, Calm

event Join(basin,basin)
event Detach(basin,basin)
event PumpOn()
event PumpOff()
event Pour(basin,depth)
event Lamp(basin)
event Feed(basin)
event Scrub(basin)
event Net(fish)
event Free(fish,basin)
event Wait()
event Flow(basin,basin)
event Stall()
event Bloom(basin)
event Gasp(fish)
