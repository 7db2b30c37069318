from stub_world import EntityState, Result, SimulationState, message


class ResetSimulation:
    Request = message("Request", scope=0)
    Request.SCOPE_DEFAULT, Request.SCOPE_TIME, Request.SCOPE_STATE = 0, 1, 2
    Request.SCOPE_SPAWNED, Request.SCOPE_ALL = 4, 255
    Response = message("Response", result=Result())


class StepSimulation:
    Request = message("Request", steps=0)
    Response = message("Response", result=Result())


class SetSimulationState:
    Request = message("Request", state=SimulationState())
    Response = message("Response", result=Result())
    Response.ALREADY_IN_TARGET_STATE = 101


class GetEntityState:
    Request = message("Request", entity="")
    Response = message("Response", result=Result(), state=EntityState())


class SetEntityState:
    Request = message("Request", entity="", state=EntityState())
    Response = message("Response", result=Result())
