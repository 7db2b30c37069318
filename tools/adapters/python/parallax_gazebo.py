"""Makes a world in Gazebo, or in another simulator that offers the ROS 2 package simulation_interfaces, one
that `parallax` can run: entities that are placed and looked at, action servers (those of Nav2, say) as actions.
Needs rclpy and simulation_interfaces, and parallax_adapter.py beside it. docs/guide/simulators.md tells how.

NOT RUN AGAINST THE REAL GAZEBO OR ROS 2: written from their documentation, and tested against a stub.

    from parallax_gazebo import GazeboAdapter

    sim = GazeboAdapter("my world", time_step=0.001)
    sim.place("robot.x", "turtlebot", "x", settable=True, default=0.0)
    sim.ros_action("drive", "/navigate_to_pose", NavigateToPose, goal, required={"target.x": "m"})
    sim.run()

The world is paused between requests. While an action runs it is stepped, `chunk` steps at a time, and not faster
than `pace` times the wall's clock: controllers in other processes have to keep up.
"""

import math
import time

import rclpy
from action_msgs.msg import GoalStatus
from geometry_msgs.msg import Twist
from rclpy.action import ActionClient
from simulation_interfaces.msg import Result, SimulationState
from simulation_interfaces.srv import (GetEntityState, ResetSimulation, SetEntityState,
                                       SetSimulationState, StepSimulation)

from parallax_adapter import Adapter, Failed, Lost

SERVICES = {"reset_simulation": ResetSimulation, "step_simulation": StepSimulation,
            "set_simulation_state": SetSimulationState, "get_entity_state": GetEntityState,
            "set_entity_state": SetEntityState}
_FINE = (Result.RESULT_OK, SetSimulationState.Response.ALREADY_IN_TARGET_STATE)


def yaw_of(turn):
    """About the vertical, of a quaternion as ROS has it."""
    return math.atan2(2.0 * (turn.w * turn.z + turn.x * turn.y),
                      1.0 - 2.0 * (turn.y * turn.y + turn.z * turn.z))


def turned_to(turn, yaw):
    """(x, y, z, w) of `turn`, turned about the vertical until its yaw is this."""
    half = 0.5 * (yaw - yaw_of(turn))
    c, s = math.cos(half), math.sin(half)
    return (c * turn.x - s * turn.y, c * turn.y + s * turn.x,
            c * turn.z + s * turn.w, c * turn.w - s * turn.z)


class GazeboAdapter(Adapter):
    """`time_step` is that of the world's physics. `wait_s` of the wall's clock is how long a service or an
    action server may be silent. `server` stands before the names of the services. `settle_steps` follow a
    start, in which topics speak that are silent while the world stands."""

    def __init__(self, name, time_step, server="/gzserver", node="parallax_adapter", wait_s=10.0,
                 chunk=10, pace=1.0, settle_steps=0,
                 reset_scope=ResetSimulation.Request.SCOPE_DEFAULT, **claims):
        super().__init__(name, time_step=time_step, **claims)
        self._server, self._node_name, self._wait_s = server.rstrip("/"), node, wait_s
        self._chunk, self._pace, self._scope = chunk, pace, reset_scope
        self._settle_steps = settle_steps
        self._placed, self._actions_of, self._heard, self._told = {}, {}, {}, {}
        self._extra_reset = self._extra_observe = None
        self._reset, self._observe = self._put, self._look

    # Declarations of a program.

    def place(self, param, entity, axis, **settable):
        """Where an entity is: `x`, `y` or `z` in metres, or `yaw` in radians about the vertical."""
        if axis not in ("x", "y", "z", "yaw"):
            raise ValueError("`%s` is no axis: x, y, z or yaw" % axis)
        self.param(param, unit="rad" if axis == "yaw" else "m", **settable)
        self._placed[param] = (entity, axis)

    def topic(self, param, topic, message_type, value, unit="1"):
        """A variable that is read off the last message of a topic: value(message)."""
        self.param(param, unit=unit)
        self._told.setdefault((topic, message_type), []).append((param, value))

    def on_reset(self, function):
        """function(start), after the entities were put into it."""
        self._extra_reset = function
        return function

    def on_observe(self, function):
        """function() -> dict of the params that are neither places nor topics."""
        self._extra_observe = function
        return function

    def ros_action(self, name, server, action_type, goal, required=None, optional=None):
        """An action of an action server; goal(**arguments) makes its goal. What the server aborts or
        rejects has failed, with the `error_msg` of its result, if it has one, as the reason."""
        self._actions_of[server] = action_type

        def call(**arguments):
            self._run_action(server, goal(**arguments))

        self.action(name, required=required, optional=optional)(call)

    # Functions for actions.

    def step(self, count=1):
        """Steps of the world's physics. Ends the action where its time limit is reached."""
        while count > 0:
            some = min(count, self._chunk)
            began = time.monotonic()
            self._ask("step_simulation", steps=some)
            passed = some * self.time_step
            if self._pace:
                time.sleep(max(0.0, passed / self._pace - (time.monotonic() - began)))
            self.advance(passed)
            count -= some

    def state_of(self, entity):
        """Its simulation_interfaces/EntityState."""
        return self._ask("get_entity_state", entity=entity).state

    def pose_of(self, entity):
        """For on_poses: three numbers and a quaternion."""
        pose = self.state_of(entity).pose
        at, turn = pose.position, pose.orientation
        return at.x, at.y, at.z, turn.w, turn.x, turn.y, turn.z

    # Behind it.

    def run(self):
        try:
            super().run()
        finally:
            rclpy.try_shutdown()

    def _begin(self):
        rclpy.init()
        self.node = rclpy.create_node(self._node_name)
        self._clients = {name: self.node.create_client(kind, "%s/%s" % (self._server, name))
                         for name, kind in SERVICES.items()}
        self._servers = {name: ActionClient(self.node, kind, name)
                         for name, kind in self._actions_of.items()}
        for topic, kind in self._told:
            self.node.create_subscription(
                kind, topic, lambda said, topic=topic: self._heard.update({topic: said}), 10)

    def _ask(self, service, **fields):
        client = self._clients[service]
        if not client.wait_for_service(timeout_sec=self._wait_s):
            raise Lost("the service %s/%s is not there" % (self._server, service))
        request = SERVICES[service].Request()
        for name, value in fields.items():
            setattr(request, name, value)
        said = self._done(client.call_async(request), "%s/%s" % (self._server, service))
        if said.result.result not in _FINE:
            raise Lost("%s/%s: result %d %s" % (self._server, service, said.result.result,
                                                said.result.error_message))
        return said

    def _done(self, future, what):
        rclpy.spin_until_future_complete(self.node, future, timeout_sec=self._wait_s)
        if not future.done():
            raise Lost("%s does not answer" % what)
        return future.result()

    def _put(self, start):
        self._ask("set_simulation_state", state=SimulationState(state=SimulationState.STATE_PAUSED))
        self._ask("reset_simulation", scope=self._scope)
        self._heard.clear()
        # Some simulators play on after a reset.
        self._ask("set_simulation_state", state=SimulationState(state=SimulationState.STATE_PAUSED))
        for entity in sorted({entity for entity, _ in self._placed.values()}):
            self._put_entity(entity, start)
        if self._extra_reset is not None:
            self._extra_reset(start)
        if self._settle_steps > 0:
            self._ask("step_simulation", steps=self._settle_steps)

    def _put_entity(self, entity, start):
        wanted = {axis: start[param] for param, (of, axis) in self._placed.items()
                  if of == entity and param in start}
        if not wanted:
            return
        state = self.state_of(entity)
        turn = state.pose.orientation
        if "yaw" in wanted:
            turn.x, turn.y, turn.z, turn.w = turned_to(turn, wanted.pop("yaw"))
        for axis, value in wanted.items():
            setattr(state.pose.position, axis, value)
        state.twist = Twist()
        self._ask("set_entity_state", entity=entity, state=state)

    def _look(self):
        seen = dict(self._extra_observe()) if self._extra_observe is not None else {}
        states = {entity: self.state_of(entity)
                  for entity in sorted({entity for entity, _ in self._placed.values()})}
        for param, (entity, axis) in self._placed.items():
            pose = states[entity].pose
            seen[param] = (yaw_of(pose.orientation) if axis == "yaw"
                           else getattr(pose.position, axis))
        for (topic, _), params in self._told.items():
            message = self._last(topic)
            for param, value in params:
                seen[param] = value(message)
        return seen

    def _last(self, topic):
        """What was said last. The world stands still, so what is under way is waited for."""
        deadline, said = time.monotonic() + self._wait_s, None
        while said is None or said is not self._heard.get(topic):
            said = self._heard.get(topic)
            rclpy.spin_once(self.node, timeout_sec=0.02)
            if time.monotonic() > deadline:
                raise Lost("%s on %s" % ("nothing is said" if said is None else "no end of words",
                                         topic))
        return said

    def _run_action(self, server, goal):
        client = self._servers[server]
        if not client.wait_for_server(timeout_sec=self._wait_s):
            raise Lost("the action server %s is not there" % server)
        handle = self._done(client.send_goal_async(goal), server)
        if not handle.accepted:
            raise Failed("rejected: %s does not take the goal" % server)
        ended = handle.get_result_async()
        try:
            while not ended.done():
                self.step(self._chunk)
                rclpy.spin_once(self.node, timeout_sec=0.0)
        except BaseException:  # the time limit as well
            self._done(handle.cancel_goal_async(), server)
            raise
        said = ended.result()
        if said.status != GoalStatus.STATUS_SUCCEEDED:
            word = {GoalStatus.STATUS_ABORTED: "aborted",
                    GoalStatus.STATUS_CANCELED: "canceled"}.get(said.status, "status %d" % said.status)
            raise Failed(getattr(said.result, "error_msg", "") or "%s: by %s" % (word, server))
