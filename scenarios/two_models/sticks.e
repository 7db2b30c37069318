; Pulling opens a drawer unless it sticks, which it does or does not at every timepoint.

load domain.e

fluent Sticks()
noninertial Sticks

[drawer,time] !HoldsAt(Sticks(),time) -> Initiates(OpenDrawer(drawer),Open(drawer),time).
