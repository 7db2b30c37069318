; Two actors on a stage with a curtain, a trapdoor, lights, fog and numbered cues.
sort actor
actor ada, ben
sort mark
mark left, centre, hatch
sort cue: integer
range cue 0 4

fluent On(actor,mark)
fluent Below(actor)
fluent Curtain()
fluent Light(mark)
fluent Cue(cue)
fluent TrapOpen()
fluent Fog()
fluent Bowing(actor)
fluent Applause()
fluent Seen(actor)
noninertial Seen

event Raise()
event Lower()
event Walk(actor,mark,mark)
event Spot(mark)
event Dim(mark)
event Lever()
event Puff()
event Vent()
event Call()
event Skip(cue)
event Bow(actor)
event Rise(actor)
event Climb(actor)
event Wait()
event Fall(actor)
event Clap()
event Snap()
