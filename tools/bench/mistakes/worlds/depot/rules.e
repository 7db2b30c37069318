load domain.e
Way(dock,dock)=0.
Way(yard,yard)=0.
Way(shed,shed)=0.
Way(dock,yard)=1.
Way(yard,dock)=1.
Way(yard,shed)=1.
Way(shed,yard)=1.
Way(dock,shed)=2.
Way(shed,dock)=2.
[spot1,spot2,time] Happens(Drive(spot1,spot2),time) -> HoldsAt(RobotAt(spot1),time) & spot1!=spot2.
[spot1,spot2,time] Happens(Drive(spot1,spot2),time) -> !HoldsAt(Plugged(),time).
[spot1,spot2,charge,time] Happens(Drive(spot1,spot2),time) & HoldsAt(Charge(charge),time) -> charge>=Way(spot1,spot2).
[spot,time] Happens(Drive(spot,shed),time) -> HoldsAt(GateOpen(),time).
[spot1,spot2,time] Initiates(Drive(spot1,spot2),RobotAt(spot2),time).
[spot1,spot2,time] spot1!=spot2 -> Terminates(Drive(spot1,spot2),RobotAt(spot1),time).
[spot1,spot2,charge1,charge2,time] HoldsAt(Charge(charge1),time) & charge2=charge1-Way(spot1,spot2) -> Initiates(Drive(spot1,spot2),Charge(charge2),time).
[spot1,spot2,charge,time] HoldsAt(Charge(charge),time) & Way(spot1,spot2)>0 -> Terminates(Drive(spot1,spot2),Charge(charge),time).
[time] Happens(Plug(),time) -> HoldsAt(RobotAt(dock),time).
[time] Initiates(Plug(),Plugged(),time).
[time] Terminates(Unplug(),Plugged(),time).
[time] HoldsAt(Warned(),time) -> Terminates(Plug(),Warned(),time).
[charge,time] HoldsAt(Plugged(),time) & HoldsAt(Charge(charge),time) & charge<4 -> Happens(Fill(),time).
[charge1,charge2,time] HoldsAt(Charge(charge1),time) & charge2=charge1+1 -> Initiates(Fill(),Charge(charge2),time).
[charge,time] HoldsAt(Charge(charge),time) & charge<4 -> Terminates(Fill(),Charge(charge),time).
[crate,spot,time] Happens(Lift(crate),time) & HoldsAt(RobotAt(spot),time) -> HoldsAt(CrateAt(crate,spot),time).
[crate1,crate2,time] Happens(Lift(crate1),time) -> !HoldsAt(Carried(crate2),time).
[crate,time] Initiates(Lift(crate),Carried(crate),time).
[crate,spot,time] HoldsAt(CrateAt(crate,spot),time) -> Terminates(Lift(crate),CrateAt(crate,spot),time).
[crate,time] Happens(Drop(crate),time) -> HoldsAt(Carried(crate),time).
[crate,time] Terminates(Drop(crate),Carried(crate),time).
[crate,spot,time] HoldsAt(RobotAt(spot),time) -> Initiates(Drop(crate),CrateAt(crate,spot),time).
[time] HoldsAt(RobotAt(yard),time) -> Initiates(Knock(),GateOpen(),time).
[time] HoldsAt(GateOpen(),time) & HoldsAt(RobotAt(shed),time) -> Happens(Close(),time).
[time] Terminates(Close(),GateOpen(),time).
[time] HoldsAt(Low(),time) & !HoldsAt(Warned(),time) -> Happens(Beep(),time).
[time] Initiates(Beep(),Warned(),time).
[time] HoldsAt(Low(),time) <-> {charge} HoldsAt(Charge(charge),time) & charge<2.
[charge1,charge2,time] HoldsAt(Charge(charge1),time) & HoldsAt(Charge(charge2),time) -> charge1=charge2.
[spot1,spot2,time] HoldsAt(RobotAt(spot1),time) & HoldsAt(RobotAt(spot2),time) -> spot1=spot2.
[crate,spot,time] HoldsAt(Carried(crate),time) -> !HoldsAt(CrateAt(crate,spot),time).
