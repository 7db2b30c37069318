"""The robot of robot_node.py behind the protocol. A master and the node have to run."""

import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
import rospy  # noqa: E402
from geometry_msgs.msg import PoseStamped  # noqa: E402
from move_base_msgs.msg import MoveBaseAction, MoveBaseGoal  # noqa: E402
from std_srvs.srv import Trigger  # noqa: E402

from parallax_ros1 import RosAdapter  # noqa: E402

sim = RosAdapter("ros1-robot", version="1", determinism="tolerance", noise=True, time_step=0.05)
sim.topic("robot.x", "/pose", PoseStamped, lambda message: message.pose.position.x, unit="m",
          settable=True, default=0.0, lower=-3.0, upper=2.9)
sim.frame("hand.x", "hand", "x")
sim.frame("hand.y", "hand", "y")
sim.frame("hand.z", "hand", "z")
sim.frame("hand.yaw", "hand", "yaw")


@sim.on_reset
def reset(start):
    rospy.set_param("/robot/x", start["robot.x"])
    rospy.set_param("/robot/seed", str(sim.random.getrandbits(32)))
    rospy.wait_for_service("/reset", timeout=5.0)
    rospy.ServiceProxy("/reset", Trigger)()


def goal(target_x):
    asked = MoveBaseGoal()
    asked.target_pose.header.frame_id = "map"
    asked.target_pose.pose.position.x = target_x
    asked.target_pose.pose.orientation.w = 1.0
    return asked


sim.ros_action("drive", "/drive", MoveBaseAction, goal, required={"target.x": ("m", 2.5)})
sim.run()
