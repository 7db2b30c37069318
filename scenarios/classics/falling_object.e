; A falling object. A vase is pushed off a shelf nine steps high. It falls by the square of the time,
; and it breaks when it comes to the floor. Pushing is done, landing happens by itself.
;
; Source: E. Mueller, Commonsense Reasoning, Morgan Kaufmann, 2006, on gradual change; the square is
; that of any school book.
;
; Expected: 1 trace. Heights 9, 8, 5, 0 at 0 to 3; Land at 3; broken on the floor at 4.

range time 0 4
range offset 1 4

sort height: integer
range height 0 9

fluent Falling()
fluent Broken()
fluent Height(height)

event Push()
event Land()

[time] {height} HoldsAt(Height(height),time).
[time,height1,height2]
  HoldsAt(Height(height1),time) & HoldsAt(Height(height2),time) -> height1=height2.

[time] Initiates(Push(),Falling(),time).
[time,height] Releases(Push(),Height(height),time).
[time,offset,height1,height2]
  HoldsAt(Height(height1),time) & height2=height1-offset*offset ->
    Trajectory(Falling(),time,Height(height2),offset).

[time] HoldsAt(Falling(),time) & HoldsAt(Height(0),time) -> Happens(Land(),time).
[time] Terminates(Land(),Falling(),time).
[time] Initiates(Land(),Broken(),time).
[time,height] HoldsAt(Height(height),time) -> Initiates(Land(),Height(height),time).

HoldsAt(Height(9),0).
!HoldsAt(Falling(),0).
!HoldsAt(Broken(),0).

Happens(Push(),0).

completion Happens
