"""A robot on a rail pushes a box, in Webots. Its world has

- a Robot named "pusher" with `supervisor TRUE`, `controller "<extern>"`, and along x a SliderJoint with the
  DEF name RAIL, whose devices are a LinearMotor "rail motor" and a PositionSensor "rail sensor";
- a Solid with the DEF name BOX and a Physics node, 0.1 m long, in front of the slider.

NOT RUN AGAINST THE REAL WEBOTS: tested against a stub of its API. Run it with a world of yours by

    parallax adapter-check -- python3 pusher.py pusher.wbt
"""

import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
from parallax_adapter import Failed, InvalidStart  # noqa: E402
from parallax_webots import WebotsAdapter  # noqa: E402

BOX_M, TOLERANCE_M = 0.1, 0.01

sim = WebotsAdapter("webots-pusher", world=sys.argv[1] if len(sys.argv) > 1 else None,
                    robot="pusher", version="1", determinism="bitwise", noise=True)
sim.joint("rail.m", sensor="rail sensor", joint="RAIL", unit="m", settable=True, default=0.0,
          lower=0.0, upper=2.0)
sim.place("box.x", "BOX", "x", settable=True, default=0.5, lower=0.1, upper=1.9)
sim.place("box.yaw", "BOX", "yaw")


@sim.on_reset
def reset(start):
    if start["rail.m"] > start["box.x"] - BOX_M / 2:
        raise InvalidStart("`slider` stands in `box`")
    sim.device("rail motor").setPosition(start["rail.m"])


@sim.on_poses([{"name": "box", "kind": "item", "moves": True, "shapes": [{"box": [BOX_M] * 3}]}])
def poses():
    return {"box": sim.pose_of("BOX")}


@sim.action("push", required={"target.x": ("m", 1.0)}, optional={"max_speed_m_s": 0.5})
def push(target_x, max_speed_m_s):
    aim = target_x - BOX_M / 2 + sim.random.gauss(0.0, 0.002)  # it does not see so well
    sim.drive("rail motor", "rail sensor", aim, velocity=max_speed_m_s)
    left = abs(target_x - sim.node("BOX").getPosition()[0])
    sim.margin("goal", TOLERANCE_M - left)
    if left > TOLERANCE_M:
        raise Failed("manipulation-goal-not-reached: the box is %.3f m away" % left)


sim.run()
