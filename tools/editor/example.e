; A lamp and its switch: every kind of token once.
option encoding 3
load foundations/EC.e ; ours
range time 0 4
range offset 1 4

reified sort thought
sort agent, level: integer
sort child: agent
range level 0 9
agent James, r2
child! James
thought Wants(agent,level)
function Limit(agent): level
predicate Ab1(agent,time)
fluent On()
fluent Level(level)
event Press(agent)
event Wait()

noninertial Level
mutex Press, Wait
Limit(James)=7.
Limit(r2)=0.

[agent,time]
  HoldsAt(On(),time) & !Ab1(agent,time) | level1!=2 <->
    {level} level<=Limit(agent)*2-1 & (level%3>0 | -level>=+1/2). ; a comment behind
Theta: [time] Ab1(James,time).
Theta: Ab1(r2,3).
Delta: Happens(Press(James),0).
[agent,time] Initiates(Press(agent),On(),time).
[level,time,offset]
  HoldsAt(Level(level),time) & level<9 -> Trajectory(On(),time,Level(level),offset).
3: HoldsAt(On(),2).
[time] time=0.5 -> 1<2.
completion Theta Ab1
completion Happens
