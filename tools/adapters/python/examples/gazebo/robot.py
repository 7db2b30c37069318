"""A mobile robot in Gazebo that is driven by Nav2. Its world has an entity `robot`, whose battery is told
on /battery_state; Nav2 runs with it.

NOT RUN AGAINST THE REAL GAZEBO: tested against a stub of rclpy, simulation_interfaces and nav2_msgs.

    parallax adapter-check -- python3 robot.py
"""

import math
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
from nav2_msgs.action import NavigateToPose  # noqa: E402
from sensor_msgs.msg import BatteryState  # noqa: E402

from parallax_gazebo import GazeboAdapter  # noqa: E402

sim = GazeboAdapter("gazebo-robot", time_step=0.01, version="1", determinism="tolerance",
                    settle_steps=1, pace=float(os.environ.get("PACE", "1")))
sim.place("robot.x", "robot", "x", settable=True, default=0.0, lower=-3.0, upper=2.9)
sim.place("robot.y", "robot", "y", settable=True, default=0.0, lower=-3.0, upper=3.0)
sim.place("robot.yaw", "robot", "yaw", settable=True, default=0.0, lower=-math.pi, upper=math.pi)
sim.topic("robot.battery", "/battery_state", BatteryState, lambda message: message.percentage)


@sim.on_poses([{"name": "robot", "moves": True, "shapes": [{"cylinder": [0.2, 0.3]}]}])
def poses():
    return {"robot": sim.pose_of("robot")}


def goal(target_x, target_y, target_yaw):
    asked = NavigateToPose.Goal()
    asked.pose.header.frame_id = "map"
    asked.pose.pose.position.x, asked.pose.pose.position.y = target_x, target_y
    asked.pose.pose.orientation.z = math.sin(target_yaw / 2)
    asked.pose.pose.orientation.w = math.cos(target_yaw / 2)
    return asked


sim.ros_action("drive", "/navigate_to_pose", NavigateToPose, goal,
               required={"target.x": ("m", 2.0), "target.y": ("m", 0.5)},
               optional={"target.yaw": 0.0})
sim.run()
