"""A little Gazebo behind stubs of ROS 2's packages, for tests, written from their documentation: one robot on
a plane, services of simulation_interfaces, a server of Nav2 that drives it straight up to a wall at x = 3.

As there, answers arrive only while somebody spins; the world plays until it is paused, and steps only while
it is; a reset lets it play again. STUB_SILENT names a service that never answers, STUB_ABSENT one that is not
there; STUB_REJECTS makes the server refuse goals.
"""

import copy
import math
import os

STEP_S, SPEED_M_S, WALL_X = 0.01, 0.5, 3.0


def message(name, **fields):
    """A type of message: fields with what they are at first, as copies."""

    def begin(self, **given):
        for field, value in fields.items():
            setattr(self, field, given.pop(field, copy.deepcopy(value)))
        if given:
            raise AssertionError("%s has no field %s" % (name, list(given)))

    def put(self, field, value):
        if field not in fields:
            raise AttributeError("%s has no field `%s`" % (name, field))
        object.__setattr__(self, field, value)

    return type(name, (), {"__init__": begin, "__setattr__": put})


Vector = message("Vector3", x=0.0, y=0.0, z=0.0)
Quaternion = message("Quaternion", x=0.0, y=0.0, z=0.0, w=1.0)
Pose = message("Pose", position=Vector(), orientation=Quaternion())
Twist = message("Twist", linear=Vector(), angular=Vector())
Header = message("Header", frame_id="")
PoseStamped = message("PoseStamped", header=Header(), pose=Pose())
Result = message("Result", result=1, error_message="")
Result.RESULT_FEATURE_UNSUPPORTED, Result.RESULT_OK, Result.RESULT_NOT_FOUND = 0, 1, 2
Result.RESULT_INCORRECT_STATE, Result.RESULT_OPERATION_FAILED = 3, 4
SimulationState = message("SimulationState", state=0)
SimulationState.STATE_STOPPED, SimulationState.STATE_PLAYING = 0, 1
SimulationState.STATE_PAUSED, SimulationState.STATE_QUITTING = 2, 3
BatteryState = message("BatteryState", percentage=1.0)
EntityState = message("EntityState", header=Header(), pose=Pose(), twist=Twist())


class World:
    """The robot, the goal of its server, and what was said and not yet heard."""

    def __init__(self):
        self.x0, self.listeners, self.said = 0.25, [], []
        self.reset()

    def reset(self):
        self.robot = EntityState()
        self.robot.pose.position.x = self.x0
        self.robot.pose.position.z = 0.1
        self.state, self.goal = SimulationState.STATE_PLAYING, None

    def step(self):
        """Topics speak while the world moves, and are heard while somebody spins."""
        if not self.said:
            self.said = [BatteryState(percentage=0.75)]
        if self.goal is None or self.goal.is_over():
            return
        at, target = self.robot.pose.position, self.goal.asked.pose.pose.position
        way_x, way_y = target.x - at.x, target.y - at.y
        way = math.hypot(way_x, way_y)
        if way < 1e-9:
            return self.goal.end(4, 0, "")
        step = min(1.0, SPEED_M_S * STEP_S / way)
        if at.x + step * way_x > WALL_X:
            return self.goal.end(6, 204, "navigation-pose-unreachable: a wall at 3 m")
        at.x, at.y = at.x + step * way_x, at.y + step * way_y
        return None

    def answer(self, name, asked, response):
        said = response()
        if name == "reset_simulation":
            self.reset()
        elif name == "set_simulation_state":
            if self.state == asked.state.state:
                said.result = Result(result=101, error_message="already so")
            self.state = asked.state.state
        elif name == "step_simulation":
            if self.state != SimulationState.STATE_PAUSED:
                said.result = Result(result=3, error_message="it is not paused")
            else:
                for _ in range(asked.steps):
                    self.step()
        elif asked.entity != "robot":
            said.result = Result(result=2, error_message="no entity `%s`" % asked.entity)
        elif name == "get_entity_state":
            said.state = copy.deepcopy(self.robot)
        elif name == "set_entity_state":
            self.robot = copy.deepcopy(asked.state)
        return said


world = World()
waiting = []  # (future, function that gives its result); answered when somebody spins


class Future:
    def __init__(self):
        self._said = []

    def done(self):
        return bool(self._said)

    def result(self):
        return self._said[0] if self._said else None

    def give(self, said):
        self._said = [said]


def later(function):
    future = Future()
    waiting.append((future, function))
    return future


def spin():
    said, world.said = world.said, []
    for message_said in said:
        for listener in world.listeners:
            listener(message_said)
    for future, function in waiting[:]:
        said = function()
        if said is not None:
            waiting.remove((future, function))
            future.give(said)


def silent(name):
    return os.environ.get("STUB_SILENT") == name
