"""What of rclpy an adapter uses; see stub_world.py."""

import os

from stub_world import later, silent, spin, world


class _Client:
    def __init__(self, kind, name):
        self._kind, self._name = kind, name

    def wait_for_service(self, timeout_sec=None):
        return os.environ.get("STUB_ABSENT") != self._name

    def call_async(self, request):
        name = self._name.rsplit("/", 1)[1]
        assert self._name == "/gzserver/" + name, self._name
        if silent(name):
            return later(lambda: None)
        return later(lambda: world.answer(name, request, self._kind.Response))


class _Node:
    def create_client(self, kind, name):
        return _Client(kind, name)

    def create_subscription(self, kind, topic, callback, depth):
        assert topic == "/battery_state", topic
        world.listeners.append(callback)


def init():
    print("a word on standard output, as the real one may say")


def create_node(name):
    return _Node()


def spin_once(node, timeout_sec=None):
    spin()


def spin_until_future_complete(node, future, timeout_sec=None):
    spin()


def try_shutdown():
    pass
