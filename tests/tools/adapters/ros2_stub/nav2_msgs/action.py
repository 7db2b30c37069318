from stub_world import PoseStamped, message


class NavigateToPose:
    Goal = message("Goal", pose=PoseStamped(), behavior_tree="")
    Result = message("Result", error_code=0, error_msg="")
    Ended = message("GetResult", status=0, result=None)
