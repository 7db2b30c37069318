"""Makes a Webots world one that `parallax` can run: nodes that are placed and looked at, joints, motors
and sensors, through the Supervisor of Webots' own Python module `controller` (R2022a or later). Needs
parallax_adapter.py beside it. docs/guide/simulators.md tells how.

NOT RUN AGAINST THE REAL WEBOTS: written from its documentation, and tested against a stub of the API.

    from parallax_webots import WebotsAdapter

    sim = WebotsAdapter("my world", world="room.wbt", robot="supervisor")
    sim.place("box.x", "BOX", "x", settable=True, default=1.0)
    sim.joint("lift.m", sensor="lift sensor", unit="m")

    @sim.action("raise", required={"height_m": "m"})
    def raise_lift(height_m):
        sim.drive("lift motor", "lift sensor", height_m)

    sim.run()

The robot named `robot` has `supervisor TRUE` and `controller "<extern>"` in the world. With `world` a Webots
of its own is started for each process, unless WEBOTS_CONTROLLER_URL names one that runs.
"""

import math
import os
import socket
import subprocess
import sys

from parallax_adapter import Adapter, Lost

_AXES = {"x": 0, "y": 1, "z": 2}
UP = (0.0, 0.0, 1.0)


def quaternion(m):
    """w-x-y-z of a turn that is told as nine numbers, row by row."""
    rows = ((1.0 + m[0] + m[4] + m[8], m[7] - m[5], m[2] - m[6], m[3] - m[1]),
            (m[7] - m[5], 1.0 + m[0] - m[4] - m[8], m[1] + m[3], m[2] + m[6]),
            (m[2] - m[6], m[1] + m[3], 1.0 - m[0] + m[4] - m[8], m[5] + m[7]),
            (m[3] - m[1], m[2] + m[6], m[5] + m[7], 1.0 - m[0] - m[4] + m[8]))
    best = max(range(4), key=lambda i: rows[i][i])  # each is a multiple of the same; this is no nought
    length = math.sqrt(sum(part * part for part in rows[best]))
    return tuple(part / length for part in rows[best])


class WebotsAdapter(Adapter):
    """`world` is started where it is given; `program` is Webots. `settle_steps` basic steps follow a
    start, the first of which puts it into effect."""

    def __init__(self, name, world=None, robot="supervisor", program="webots", settle_steps=1,
                 **claims):
        super().__init__(name, **claims)
        self._world, self._robot_name, self._program = world, robot, program
        self._settle_steps, self._webots = max(1, int(settle_steps)), None
        self._placed, self._joints, self._nodes, self._devices = {}, {}, {}, {}
        self._extra_reset = self._extra_observe = None
        self._reset, self._observe = self._put, self._look
        self.robot = None  # the Supervisor, from the first request on

    # Declarations of a program.

    def place(self, param, node, axis, **settable):
        """Where the node with this DEF name is: `x`, `y` or `z` in metres, or `yaw` in radians about the
        vertical. What can be set stands at the top of the scene tree."""
        if axis not in ("x", "y", "z", "yaw"):
            raise ValueError("`%s` is no axis: x, y, z or yaw" % axis)
        self.param(param, unit="rad" if axis == "yaw" else "m", **settable)
        self._placed[param] = (node, axis)

    def joint(self, param, sensor, joint=None, unit="rad", **settable):
        """What a position sensor says. To be set it needs the DEF name of its joint."""
        if settable.get("settable") and joint is None:
            raise ValueError("`%s` can be set, so it needs the DEF name of the joint" % param)
        self.param(param, unit=unit, **settable)
        self._joints[param] = (sensor, joint)

    def on_reset(self, function):
        """function(start), after nodes and joints were put into it: the rest of the world, motors."""
        self._extra_reset = function
        return function

    def on_observe(self, function):
        """function() -> dict of the params that are neither places nor joints."""
        self._extra_observe = function
        return function

    # Functions for actions.

    def device(self, name):
        """A device of the robot; sensors are switched on when they are first asked for."""
        if name not in self._devices:
            found = self.robot.getDevice(name)
            if found is None:
                raise RuntimeError("the robot has no device `%s`" % name)
            if hasattr(found, "getSamplingPeriod") and hasattr(found, "enable"):
                found.enable(self._step_ms)
            self._devices[name] = found
        return self._devices[name]

    def node(self, name):
        if name not in self._nodes:
            found = self.robot.getFromDef(name)
            if found is None:
                raise RuntimeError("the world has no node with the DEF name `%s`" % name)
            self._nodes[name] = found
        return self._nodes[name]

    def step(self, count=1):
        """Basic steps of the world. Ends the action where its time limit is reached."""
        for _ in range(count):
            self._step()
            self.advance(self._step_ms / 1000.0)

    def drive(self, motor, sensor, target, tolerance=0.001, velocity=None, steps=None):
        """Moves a motor until its sensor is there, and tells the distance that is left: an action's own
        matter whether it is too much. Gives up after `steps` without getting nearer (default: 1 s)."""
        motor, sensor = self.device(motor), self.device(sensor)
        if velocity is not None:
            motor.setVelocity(velocity)
        motor.setPosition(target)
        allowed = steps or max(1, round(1000.0 / self._step_ms))
        nearest, idle = math.inf, 0
        while True:
            self.step()
            left = abs(target - sensor.getValue())
            if left <= tolerance:
                return left
            nearest, idle = (left, 0) if left < nearest - 1e-9 else (nearest, idle + 1)
            if idle >= allowed:
                return left

    def pose_of(self, node):
        """For on_poses: three numbers and a quaternion."""
        found = self.node(node)
        return tuple(found.getPosition()) + quaternion(found.getOrientation())

    # Behind it.

    def run(self):
        try:
            super().run()
        finally:
            if self._webots is not None:
                self._webots.kill()

    def _begin(self):
        home = os.environ.get("WEBOTS_HOME")
        if home:
            sys.path.append(os.path.join(home, "lib", "controller", "python"))
        if self._world and "WEBOTS_CONTROLLER_URL" not in os.environ:
            self._start()
        from controller import Supervisor  # it connects, and waits until the world is there

        self.robot = Supervisor()
        self._step_ms = int(self.robot.getBasicTimeStep())
        self.time_step = self._step_ms / 1000.0
        for node, _ in self._placed.values():
            self.node(node)
        for sensor, joint in self._joints.values():
            self.device(sensor)
            if joint:
                self.node(joint)

    def _start(self):
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            port = free.getsockname()[1]
        self._webots = subprocess.Popen(
            [self._program, "--port=%d" % port, "--batch", "--mode=fast", "--minimize",
             "--no-rendering", self._world], stdout=2)
        os.environ["WEBOTS_CONTROLLER_URL"] = "ipc://%d/%s" % (port, self._robot_name)

    def _step(self):
        if self.robot.step(self._step_ms) == -1:
            raise Lost("Webots has ended the controller")

    def _put(self, start):
        self.robot.simulationReset()
        self._step()  # at its end the world is as it was at the beginning
        for name in {node for node, _ in self._placed.values()}:
            self._put_node(name, start)
        for param, (_, joint) in self._joints.items():
            if param in start:
                self.node(joint).setJointPosition(start[param])
        if self._extra_reset is not None:
            self._extra_reset(start)
        for _ in range(self._settle_steps):
            self._step()

    def _put_node(self, name, start):
        node, moved = self.node(name), False
        place = node.getField("translation").getSFVec3f()
        for param, (of, axis) in self._placed.items():
            if of != name or param not in start:
                continue
            moved = True
            if axis == "yaw":
                node.getField("rotation").setSFRotation(list(UP) + [start[param]])
            else:
                place[_AXES[axis]] = start[param]
        if moved:
            node.getField("translation").setSFVec3f(place)
            node.resetPhysics()

    def _look(self):
        seen = dict(self._extra_observe()) if self._extra_observe is not None else {}
        for param, (node, axis) in self._placed.items():
            if axis == "yaw":
                turn = self.node(node).getOrientation()
                seen[param] = math.atan2(turn[3], turn[0])
            else:
                seen[param] = self.node(node).getPosition()[_AXES[axis]]
        for param, (sensor, _) in self._joints.items():
            seen[param] = self.device(sensor).getValue()
        return seen
