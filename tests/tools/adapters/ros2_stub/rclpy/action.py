"""What of rclpy.action an adapter uses; see stub_world.py."""

import os

from stub_world import later, world


class _Goal:
    def __init__(self, kind, asked):
        self.accepted, self.asked, self._kind = "STUB_REJECTS" not in os.environ, asked, kind
        self._ended = None

    def is_over(self):
        return self._ended is not None

    def end(self, status, code, text):
        self._ended = self._kind.Ended(
            status=status, result=self._kind.Result(error_code=code, error_msg=text))

    def get_result_async(self):
        return later(lambda: self._ended)

    def cancel_goal_async(self):
        self.end(5, 0, "")
        return later(lambda: "canceled")


class ActionClient:
    def __init__(self, node, kind, name):
        self._kind, self._name = kind, name

    def wait_for_server(self, timeout_sec=None):
        return os.environ.get("STUB_ABSENT") != self._name

    def send_goal_async(self, asked):
        goal = _Goal(self._kind, asked)
        if goal.accepted:
            world.goal = goal
        return later(lambda: goal)
