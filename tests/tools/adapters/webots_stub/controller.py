"""What of Webots' Python module `controller` an adapter uses, over a small world of its own: a slider on a
rail along x pushes a box up to a wall. Written for tests from Webots' documentation.

As in Webots, motors and fields are written at the next step, a reset happens at the end of the step, and undoes
what was written in it; sensors say nothing before they are switched on and a step has passed; what is not there
is None. STUB_STEPS is after how many steps Webots closes.
"""

import math
import os
import sys

WALL_X, HALF_BOX_M, STEP_MS = 2.0, 0.05, 16


class _World:
    def __init__(self):
        self.steps, self.writes, self.is_reset = 0, [], False
        self.begin()

    def begin(self):
        self.rail, self.target, self.speed = 0.0, 0.0, 1.0
        self.box, self.turn = [0.7, 0.0, 0.05], [0.0, 0.0, 1.0, 0.0]

    def step(self, milliseconds):
        for write in self.writes:
            write()
        self.writes = []
        if self.is_reset:
            self.is_reset = False
            self.begin()
            return
        way = self.speed * milliseconds / 1000.0
        rail = self.rail + max(-way, min(way, self.target - self.rail))
        self.rail = min(rail, WALL_X - 2 * HALF_BOX_M)
        self.box[0] = max(self.box[0], self.rail + HALF_BOX_M)


_world = _World()


class Field:
    def __init__(self, name):
        self._name = name

    def _value(self):
        return _world.box if self._name == "translation" else _world.turn

    def getSFVec3f(self):
        return list(self._value())

    def setSFVec3f(self, values):
        values = [float(value) for value in values]
        _world.writes.append(lambda: _world.box.__setitem__(slice(None), values))

    def setSFRotation(self, values):
        values = [float(value) for value in values]
        _world.writes.append(lambda: _world.turn.__setitem__(slice(None), values))


class Node:
    def __init__(self, name):
        self._name = name

    def getField(self, name):
        return Field(name)

    def getPosition(self):
        return list(_world.box)

    def getOrientation(self):
        c, s = math.cos(_world.turn[3]), math.sin(_world.turn[3])
        return [c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0]

    def resetPhysics(self):
        pass

    def setJointPosition(self, position, index=1):
        _world.writes.append(lambda: setattr(_world, "rail", position))


class LinearMotor:
    def setPosition(self, position):
        _world.writes.append(lambda: setattr(_world, "target", position))

    def setVelocity(self, velocity):
        _world.writes.append(lambda: setattr(_world, "speed", velocity))


class PositionSensor:
    def __init__(self):
        self._since = None

    def enable(self, period):
        self._since = _world.steps

    def getSamplingPeriod(self):
        return 0 if self._since is None else STEP_MS

    def getValue(self):
        if self._since is None or _world.steps == self._since:
            return math.nan
        return _world.rail


class Supervisor:
    _created = False

    def __init__(self):
        if Supervisor._created:
            sys.exit("only one Robot can be made in a process")
        Supervisor._created = True
        print("a word on standard output, as the real one may say")
        self._devices = {"rail motor": LinearMotor(), "rail sensor": PositionSensor()}
        self._ends_at = int(os.environ.get("STUB_STEPS", "0"))

    def getBasicTimeStep(self):
        return float(STEP_MS)

    def getFromDef(self, name):
        return Node(name) if name in ("BOX", "RAIL") else None

    def getDevice(self, name):
        return self._devices.get(name)

    def step(self, milliseconds):
        if _world.steps == self._ends_at and self._ends_at > 0:
            return -1
        _world.steps += 1
        _world.step(milliseconds)
        return 0

    def simulationReset(self):
        _world.is_reset = True
