"""A world without physics as a class: a robot that drives on a floor with a wall that has a door, and
a crate that it carries. Run it in place of the simulator of kinematic_2d.yaml (docs/guide/simulators.md):

    simulator: {command: [python3, kinematic_2d.py]}
"""

import math
from typing import Dict, Tuple

from parallax import Adapter, Failed, InvalidStart, action, observed, param, poses, serve, simulator

STEP_S, SLIP, ROBOT_M, REACH_M = 0.02, 0.005, 0.2, 0.6
WALL_X, DOOR_Y, DOOR_HALF_M = 2.0, 0.0, 0.5  # the wall is a line, the door a gap in it


@simulator("kinematic-2d", version="1", determinism="bitwise", noise=True, time_step=STEP_S)
class Floor:
    sim: Adapter
    robot_x: float = param("robot.x", unit="m", default=0.5, lower=0.0, upper=4.0)
    robot_y: float = param("robot.y", unit="m", default=0.0, lower=-1.5, upper=1.5)
    crate_x: float = param("crate.x", unit="m", default=3.0, lower=0.0, upper=4.0)
    crate_y: float = param("crate.y", unit="m", default=0.0, lower=-1.5, upper=1.5)
    crate_held: bool = observed("crate.held", False)

    def reset(self) -> None:
        if abs(self.robot_x - WALL_X) < ROBOT_M:
            raise InvalidStart("`robot` stands in `wall`")

    @poses([{"name": "robot", "moves": True, "shapes": [{"cylinder": [ROBOT_M, 0.3]}]},
            {"name": "crate", "kind": "item", "moves": True, "shapes": [{"box": [0.1, 0.1, 0.1]}]}])
    def places(self) -> Dict[str, Tuple[float, float, float]]:
        return {"robot": (self.robot_x, self.robot_y, 0.15),
                "crate": (self.crate_x, self.crate_y, 0.45 if self.crate_held else 0.05)}

    @action("drive", required={"target.x": ("m", 1.0), "target.y": ("m", 0.2)},
            optional={"max_speed_m_s": 0.5})
    def drive(self, target_x: float, target_y: float, max_speed_m_s: float) -> None:
        way_x, way_y = target_x - self.robot_x, target_y - self.robot_y
        way_m = math.hypot(way_x, way_y) * (1.0 + self.sim.random.gauss(0.0, SLIP))
        angle = math.atan2(way_y, way_x)
        while way_m > 0.0:
            step = min(way_m, max_speed_m_s * STEP_S)
            x, y = self.robot_x + step * math.cos(angle), self.robot_y + step * math.sin(angle)
            clearance = max(abs(x - WALL_X), DOOR_HALF_M - abs(y - DOOR_Y)) - ROBOT_M
            self.sim.margin("clearance", clearance)
            if clearance < 0.0:
                raise Failed("navigation-pose-unreachable: the wall is in the way at y = %.3f m" % y)
            self.robot_x, self.robot_y = x, y
            if self.crate_held:
                self.crate_x, self.crate_y = x, y
            way_m -= step
            self.sim.advance(STEP_S)

    @action("pick-up")
    def pick_up(self) -> None:
        reach = math.hypot(self.crate_x - self.robot_x, self.crate_y - self.robot_y)
        self.sim.margin("reach", REACH_M - reach)
        self.sim.advance(1.0)
        if reach > REACH_M:
            raise Failed("manipulation-pose-unreachable: the crate is %.3f m away" % reach)
        self.crate_held = True

    @action("put-down")
    def put_down(self) -> None:
        self.sim.advance(1.0)
        if not self.crate_held:
            raise Failed("object-not-held: the hands are empty")
        self.crate_held = False


if __name__ == "__main__":
    serve(Floor)
