"""A small simulated robot as a ROS 1 node: it drives along x as /drive asks (move_base_msgs), says where
it is on /pose and in tf (map, odom, base, hand), and makes /clock go while it moves, twenty times as fast as the
wall's. /reset takes the private parameters x and seed. It cannot go beyond x = 3 and says so."""

import math
import random
import threading
import time

import actionlib
import rospy
import tf2_ros
from geometry_msgs.msg import PoseStamped, TransformStamped
from move_base_msgs.msg import MoveBaseAction
from rosgraph_msgs.msg import Clock
from std_srvs.srv import Trigger, TriggerResponse

STEP_S, SPEED_M_S, WALL_X = 0.05, 0.5, 3.0


def link(parent, child, x, y, z, yaw, stamp):
    said = TransformStamped()
    said.header.frame_id, said.child_frame_id, said.header.stamp = parent, child, stamp
    at, turn = said.transform.translation, said.transform.rotation
    at.x, at.y, at.z = x, y, z
    turn.z, turn.w = math.sin(yaw / 2), math.cos(yaw / 2)
    return said


class Robot:
    def __init__(self):
        self.lock, self.x, self.now, self.random = threading.RLock(), 0.0, 1.0, random.Random(0)
        self.clock = rospy.Publisher("/clock", Clock, queue_size=10)
        self.pose = rospy.Publisher("/pose", PoseStamped, queue_size=1)
        self.frames, still = tf2_ros.TransformBroadcaster(), tf2_ros.StaticTransformBroadcaster()
        # The wheels counted from (1, 0) on, where it looked to the left of the map's x.
        still.sendTransform([link("map", "odom", 1.0, 0.0, 0.0, math.pi / 2, rospy.Time(0)),
                             link("base", "hand", 0.3, 0.1, 0.5, 0.25, rospy.Time(0))])
        rospy.Service("/reset", Trigger, self.reset)
        self.server = actionlib.SimpleActionServer("/drive", MoveBaseAction, self.drive, False)
        self.server.start()

    def reset(self, _):
        with self.lock:
            self.x = float(rospy.get_param("~x", 0.0))
            self.random.seed(int(rospy.get_param("~seed", "0")))
        return TriggerResponse(success=True)

    def drive(self, goal):
        target = goal.target_pose.pose.position.x
        target += self.random.gauss(0.0, 0.01)  # it does not know so well where it is
        while abs(target - self.x) > 1e-9:
            if self.server.is_preempt_requested():
                return self.server.set_preempted()
            step = max(-SPEED_M_S * STEP_S, min(SPEED_M_S * STEP_S, target - self.x))
            if self.x + step > WALL_X:
                return self.server.set_aborted(text="navigation-pose-unreachable: a wall at 3 m")
            with self.lock:
                self.x += step
                self.now += STEP_S
            time.sleep(STEP_S / 20)
        return self.server.set_succeeded()

    def tell(self):
        said = PoseStamped()
        with self.lock:
            said.header.stamp, said.pose.position.x = rospy.Time.from_sec(self.now), self.x
        self.clock.publish(Clock(clock=said.header.stamp))
        self.pose.publish(said)
        x = said.pose.position.x
        self.frames.sendTransform(link("odom", "base", 0.0, 1.0 - x, 0.0, -math.pi / 2,
                                       said.header.stamp))


rospy.set_param("/use_sim_time", True)
rospy.init_node("robot", disable_signals=True)
robot = Robot()
while not rospy.is_shutdown():
    robot.tell()
    time.sleep(0.005)
