"""A world without physics: a disc-shaped robot on a floor with a wall that has a door, and a crate
that it carries. The wheels slip, so that it stops a little short or far. Run it by

    parallax run kinematic_2d.yaml
"""

import math
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from parallax_adapter import Adapter, Failed, InvalidStart  # noqa: E402

STEP_S, SLIP, ROBOT_M, REACH_M = 0.02, 0.005, 0.2, 0.6
WALL_X, DOOR_Y, DOOR_HALF_M = 2.0, 0.0, 0.5  # the wall is a line, the door a gap in it

sim = Adapter("kinematic-2d", version="1", determinism="bitwise", noise=True, time_step=STEP_S)
sim.param("robot.x", unit="m", settable=True, default=0.5, lower=0.0, upper=4.0)
sim.param("robot.y", unit="m", settable=True, default=0.0, lower=-1.5, upper=1.5)
sim.param("crate.x", unit="m", settable=True, default=3.0, lower=0.0, upper=4.0)
sim.param("crate.y", unit="m", settable=True, default=0.0, lower=-1.5, upper=1.5)
sim.param("crate.held")
world = {}


@sim.on_reset
def reset(start):
    if abs(start["robot.x"] - WALL_X) < ROBOT_M:
        raise InvalidStart("`robot` stands in `wall`")
    world.update(start, **{"crate.held": False})


@sim.on_observe
def observe():
    return world


@sim.on_poses([{"name": "robot", "moves": True, "shapes": [{"cylinder": [ROBOT_M, 0.3]}]},
               {"name": "crate", "kind": "item", "moves": True, "shapes": [{"box": [.1, .1, .1]}]}])
def poses():
    return {"robot": (world["robot.x"], world["robot.y"], 0.15),
            "crate": (world["crate.x"], world["crate.y"], 0.45 if world["crate.held"] else 0.05)}


@sim.action("drive", required={"target.x": ("m", 1.0), "target.y": ("m", 0.2)},
            optional={"max_speed_m_s": 0.5})
def drive(target_x, target_y, max_speed_m_s):
    way_x, way_y = target_x - world["robot.x"], target_y - world["robot.y"]
    way_m = math.hypot(way_x, way_y) * (1.0 + sim.random.gauss(0.0, SLIP))
    angle = math.atan2(way_y, way_x)
    while way_m > 0.0:
        step = min(way_m, max_speed_m_s * STEP_S)
        x, y = world["robot.x"] + step * math.cos(angle), world["robot.y"] + step * math.sin(angle)
        clearance = max(abs(x - WALL_X), DOOR_HALF_M - abs(y - DOOR_Y)) - ROBOT_M
        sim.margin("clearance", clearance)
        if clearance < 0.0:
            raise Failed("navigation-pose-unreachable: the wall is in the way at y = %.3f m" % y)
        world.update({"robot.x": x, "robot.y": y})
        if world["crate.held"]:
            world.update({"crate.x": x, "crate.y": y})
        way_m -= step
        sim.advance(STEP_S)


@sim.action("pick-up")
def pick_up():
    reach = math.hypot(world["crate.x"] - world["robot.x"], world["crate.y"] - world["robot.y"])
    sim.margin("reach", REACH_M - reach)
    sim.advance(1.0)
    if reach > REACH_M:
        raise Failed("manipulation-pose-unreachable: the crate is %.3f m away" % reach)
    world["crate.held"] = True


@sim.action("put-down")
def put_down():
    sim.advance(1.0)
    if not world["crate.held"]:
        raise Failed("object-not-held: the hands are empty")
    world["crate.held"] = False


sim.run()
