"""Makes a robot that speaks ROS 1 one that `parallax` can run: actionlib clients for its actions,
topics and frames of tf for what is observed. Needs rospy and actionlib (Debian: python3-rospy,
python3-actionlib; for frames python3-tf2-ros), and parallax_adapter.py beside it. docs/guide/simulators.md tells how.

    from parallax_ros1 import RosAdapter

    sim = RosAdapter("my robot", seeds=False)
    sim.topic("robot.x", "/odom", Odometry, lambda message: message.pose.pose.position.x, unit="m")
    sim.frame("hand.x", "hand", "x", reference="map")
    sim.ros_action("drive", "/move_base", MoveBaseAction, lambda target_x: goal(target_x),
                   required={"target.x": "m"})

    @sim.on_reset
    def reset(start): ...          # by services of the simulator

    sim.run()

Simulated time is that of /clock where use_sim_time is set, else the wall's.
"""

import math
import os
import threading
import time

import actionlib
import rospy
from actionlib_msgs.msg import GoalStatus

from parallax_adapter import Adapter, Failed, Lost

POLL_S = 0.002
FRESH = 3  # the first messages after a request may have been under way before it
_ENDED = {value: name for name, value in vars(GoalStatus).items()
          if name in ("SUCCEEDED", "ABORTED", "REJECTED", "PREEMPTED", "RECALLED", "LOST")}


class RosAdapter(Adapter):
    """`wait_s` of the wall's clock is how long topics, servers and time itself may be silent."""

    def __init__(self, name, node="parallax_adapter", wait_s=5.0, **claims):
        super().__init__(name, **claims)
        self._node, self._wait_s = node, wait_s
        self._topics, self._clients, self._last = {}, {}, {}
        self._frames_of, self._tf = {}, None
        self._observe = self._observed_now

    def topic(self, param, topic, message_type, value, unit="1", **settable):
        """A variable that is read off a topic: value(message)."""
        self.param(param, unit=unit, **settable)
        self._topics.setdefault((topic, message_type), []).append((param, value))

    def frame(self, param, frame, axis, reference="map", **settable):
        """A variable that is read off tf: where `frame` is in `reference`, `x`, `y` or `z` in metres, or
        its `yaw` in radians."""
        if axis not in ("x", "y", "z", "yaw"):
            raise ValueError("`%s` is no axis: x, y, z or yaw" % axis)
        self.param(param, unit="rad" if axis == "yaw" else "m", **settable)
        self._frames_of.setdefault((reference, frame), []).append((param, axis))

    def ros_action(self, name, server, action_type, goal, required=None, optional=None):
        """An action of an actionlib server; goal(**arguments) makes its goal. What the server aborts
        or rejects has failed, with the text of its status as the reason."""
        self._clients[server] = action_type

        def call(**arguments):
            self._call(server, goal(**arguments))

        self.action(name, required=required, optional=optional)(call)

    def run(self):
        super().run()
        # The shutdown of rospy may take longer than anybody waits.
        closing = threading.Thread(target=rospy.signal_shutdown, args=("closed",), daemon=True)
        closing.start()
        closing.join(1.0)
        os._exit(0)

    def _begin(self):
        rospy.init_node(self._node, anonymous=True, disable_signals=True)
        for topic, message_type in self._topics:
            rospy.Subscriber(topic, message_type, self._heard, callback_args=topic, queue_size=1)
        for server, action_type in self._clients.items():
            self._clients[server] = actionlib.SimpleActionClient(server, action_type)

        if self._frames_of:
            import tf2_ros

            self._tf = tf2_ros.Buffer()
            self._tf_listener = tf2_ros.TransformListener(self._tf)

    def _heard(self, message, topic):
        self._last[topic] = (self._last.get(topic, (0, None))[0] + 1, message)

    def _call(self, server, goal):
        client = self._clients[server]
        if not self._is_there(client):
            raise Lost("the action server %s is not there" % server)
        client.send_goal(goal)
        last, moved = rospy.get_time(), time.monotonic()
        try:
            while client.simple_state != actionlib.SimpleGoalState.DONE:
                time.sleep(POLL_S)
                now = rospy.get_time()
                if now > last:
                    passed, last, moved = now - last, now, time.monotonic()
                    self.advance(passed)
                elif time.monotonic() > moved + self._wait_s:
                    raise Lost("simulated time stands still during %s" % server)
        except BaseException:  # the time limit as well
            client.cancel_goal()
            raise
        state = client.get_state()
        if state == GoalStatus.LOST:
            raise Lost("the action server %s has lost the goal" % server)
        if state != GoalStatus.SUCCEEDED:
            raise Failed(client.get_goal_status_text() or _ENDED.get(state, str(state)).lower())

    def _is_there(self, client):
        """By the wall's clock: simulated time may stand still until it is told to go on."""
        deadline = time.monotonic() + self._wait_s
        while time.monotonic() < deadline:
            said = client.action_client.last_status_msg
            if said is not None and client.action_client.pub_goal.get_num_connections() > 0:
                return True
            time.sleep(POLL_S)
        return False

    def _wait(self, is_there, why):
        deadline = time.monotonic() + self._wait_s
        while not is_there():
            if time.monotonic() > deadline or rospy.is_shutdown():
                raise Lost(why)
            time.sleep(POLL_S)

    def _observed_now(self):
        """From messages that came after the request, so that they tell what is now."""
        seen = {}
        count = {topic: self._last.get(topic, (0, None))[0] for topic, _ in self._topics}
        for (topic, _), params in self._topics.items():
            self._wait(lambda: self._last.get(topic, (0, None))[0] >= count[topic] + FRESH,
                       "nothing is said on %s" % topic)
            message = self._last[topic][1]
            for param, value in params:
                seen[param] = value(message)
        if self._frames_of:
            self._look_at_frames(seen)
        return seen

    def _look_at_frames(self, seen):
        """Times of transforms do not tell whether they are new: simulated time may stand still. What was
        heard is forgotten instead, until each link that moves was told anew; links that do not stay."""
        for _ in range(FRESH):
            self._tf.clear()
            for reference, frame in self._frames_of:
                self._wait(lambda: self._transform(reference, frame) is not None,
                           "tf does not tell `%s` in `%s`" % (frame, reference))
        for (reference, frame), params in self._frames_of.items():
            now = self._transform(reference, frame)
            at, turn = now.translation, now.rotation
            yaw = math.atan2(2.0 * (turn.w * turn.z + turn.x * turn.y),
                             1.0 - 2.0 * (turn.y * turn.y + turn.z * turn.z))
            for param, axis in params:
                seen[param] = yaw if axis == "yaw" else getattr(at, axis)

    def _transform(self, reference, frame):
        import tf2_ros

        try:
            return self._tf.lookup_transform(reference, frame, rospy.Time(0)).transform
        except (tf2_ros.LookupException, tf2_ros.ConnectivityException,
                tf2_ros.ExtrapolationException):
            return None
