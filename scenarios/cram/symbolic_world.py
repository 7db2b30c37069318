"""A world of facts behind a pipe: no bodies, no clock. It knows what the model does not, that nobody
drives to the sink while the drawer before it is open.

It speaks the protocol itself (docs/reference/protocol.md): one line of JSON asks, one answers.
"""

import json
import sys

BASES, ITEMS = ("bSink", "bIsland"), ("bowl", "spoon")
PLACES = {"pSink": "bSink", "dTop": "bSink", "pIsland": "bIsland", "pFloor": None}  # by what serves it
FACTS = (["drawer.open"] + ["robot." + base for base in BASES] +
         ["%s.%s" % (item, word) for item in ITEMS for word in (*PLACES, "held", "perceived")])
world = {}


def in_reach(item):
    return any(world["%s.%s" % (item, place)] and world.get("robot.%s" % base) and
               (place != "dTop" or world["drawer.open"]) for place, base in PLACES.items())


def drive(to):
    if to == "bSink" and world["drawer.open"]:
        return "navigation-pose-unreachable: the drawer before the sink is open"
    world.update({"robot." + base: base == to for base in BASES})


def detect(kind):
    if not in_reach(kind):
        return "perception-object-not-found: the %s is not in view" % kind
    world[kind + ".perceived"] = True


def pick_up(item):
    if not in_reach(item) or not world[item + ".perceived"]:
        return "manipulation-pose-unreachable: the %s was not seen within reach" % item
    world.update({"%s.%s" % (item, place): False for place in PLACES}, **{item + ".held": True})


def place(item, at):
    if not world[item + ".held"] or not world.get("robot.%s" % PLACES[at]):
        return "manipulation-pose-unreachable: %s cannot be put there" % item
    world.update({item + ".held": False, "%s.%s" % (item, at): True})


def move_drawer(opened):
    if not world["robot.bSink"]:
        return "manipulation-pose-unreachable: the drawer is at the sink"
    world["drawer.open"] = opened


ACTIONS = {"drive": drive, "look": lambda at: None, "park": lambda: None, "detect": detect,
           "pick-up": pick_up, "place": place, "open-drawer": lambda: move_drawer(True),
           "close-drawer": lambda: move_drawer(False)}


def hello(params):
    return {"protocol": 1, "name": "facts about a kitchen", "version": "1",
            "determinism": "bitwise", "seeds": True, "time_step": 0.0,
            "params": [{"name": name, "settable": True} for name in FACTS],
            "actions": [{"name": name, "instant": True} for name in ACTIONS]}


def reset(params):
    unknown = [name for name in params["state"] if name not in FACTS]
    if unknown:
        return {"status": "unsupported", "reason": "no fact " + unknown[0]}
    if any(value not in (0, 1) for value in params["state"].values()):
        return {"status": "invalid_start", "reason": "a fact is true or false"}
    world.update(dict.fromkeys(FACTS, False))
    world.update({name: bool(value) for name, value in params["state"].items()})
    return {"status": "ok", "sim_time": 0.0}


def act(params):
    action = ACTIONS.get(params["action"])
    if action is None:
        return {"status": "unsupported", "reason": "no action " + params["action"]}
    try:
        why = action(**params.get("args", {}))
    except (TypeError, KeyError) as error:  # an argument that it does not have, or a name
        return {"status": "unsupported", "reason": str(error)}
    return {"status": "failed" if why else "ok", "reason": why or "", "sim_time": 0.0}


METHODS = {"hello": hello, "reset": reset, "act": act, "observe": lambda _: {"state": world},
           "close": lambda _: {"status": "ok"}}

for line in sys.stdin:
    request = json.loads(line)
    method = METHODS.get(request["method"])
    reply = {"id": request["id"]}
    if method is None:
        reply["error"] = {"code": -32601, "message": "no method " + request["method"]}
    else:
        reply["result"] = method(request.get("params", {}))
    print(json.dumps(reply), flush=True)
    if request["method"] == "close":
        break
