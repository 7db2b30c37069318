from stub_world import PoseStamped, Twist  # noqa: F401
