"""A small simulated robot as a ROS 1 node: it drives along x as /drive asks (move_base_msgs), says where
it is on /pose, and makes /clock go while it moves, twenty times as fast as the wall's. /reset takes the
private parameters x and seed. It cannot go beyond x = 3 and says so."""

import random
import threading
import time

import actionlib
import rospy
from geometry_msgs.msg import PoseStamped
from move_base_msgs.msg import MoveBaseAction
from rosgraph_msgs.msg import Clock
from std_srvs.srv import Trigger, TriggerResponse

STEP_S, SPEED_M_S, WALL_X = 0.05, 0.5, 3.0


class Robot:
    def __init__(self):
        self.lock, self.x, self.now, self.random = threading.RLock(), 0.0, 1.0, random.Random(0)
        self.clock = rospy.Publisher("/clock", Clock, queue_size=10)
        self.pose = rospy.Publisher("/pose", PoseStamped, queue_size=1)
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


rospy.set_param("/use_sim_time", True)
rospy.init_node("robot", disable_signals=True)
robot = Robot()
while not rospy.is_shutdown():
    robot.tell()
    time.sleep(0.005)
