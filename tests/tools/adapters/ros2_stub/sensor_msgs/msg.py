from stub_world import BatteryState  # noqa: F401
