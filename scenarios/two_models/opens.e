; Pulling opens a drawer.

load domain.e

[drawer,time] Initiates(OpenDrawer(drawer),Open(drawer),time).
