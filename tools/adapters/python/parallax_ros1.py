"""Makes a robot that speaks ROS 1 one that `parallax` can run: actionlib clients for its actions,
topics for what is observed. Needs rospy and actionlib (Debian: python3-rospy, python3-actionlib), and
parallax_adapter.py beside it. docs/adapters.md tells how.

    from parallax_ros1 import RosAdapter

    sim = RosAdapter("my robot", seeds=False)
    sim.topic("robot.x", "/odom", Odometry, lambda message: message.pose.pose.position.x, unit="m")
    sim.ros_action("drive", "/move_base", MoveBaseAction, lambda target_x: goal(target_x),
                   required={"target.x": "m"})

    @sim.on_reset
    def reset(start): ...          # by services of the simulator

    sim.run()

Simulated time is that of /clock where use_sim_time is set, else the wall's.
"""

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
        self._observe = self._observed_topics

    def topic(self, param, topic, message_type, value, unit="1", **settable):
        """A variable that is read off a topic: value(message)."""
        self.param(param, unit=unit, **settable)
        self._topics.setdefault((topic, message_type), []).append((param, value))

    def ros_action(self, name, server, action_type, goal, required=None, optional=None):
        """An action of an actionlib server; goal(**arguments) makes its goal. What the server aborts
        or rejects has failed, with the text of its status as the reason."""
        self._clients[server] = action_type

        def call(**arguments):
            self._call(server, goal(**arguments))

        self.action(name, required=required, optional=optional)(call)

    def run(self):
        super().run()
        # What rospy does at the end may take longer than anybody waits.
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

    def _observed_topics(self):
        """From messages that came after the request, so that they tell what is now."""
        seen = {}
        count = {topic: self._last.get(topic, (0, None))[0] for topic, _ in self._topics}
        for (topic, _), params in self._topics.items():
            self._wait(lambda: self._last.get(topic, (0, None))[0] >= count[topic] + FRESH,
                       "nothing is said on %s" % topic)
            message = self._last[topic][1]
            for param, value in params:
                seen[param] = value(message)
        return seen
