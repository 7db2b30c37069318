from stub_world import EntityState, Result, SimulationState  # noqa: F401
