"""Makes a simulator that is written in Python one that `parallax` can run.

One file, standard library only (Python 3.8 or later): copy it beside your program.
docs/guide/simulators.md tells the story, docs/reference/protocol.md what goes over the wire.

    from parallax_adapter import Adapter, Failed

    sim = Adapter("my world", version="1", determinism="bitwise", time_step=0.01)
    sim.param("box.x", unit="m", settable=True, default=1.0, lower=0.0, upper=2.0)

    @sim.on_reset
    def reset(start): ...               # every settable param by name; sim.random is seeded

    @sim.on_observe
    def observe(): return {"box.x": ...}

    @sim.action("push", required={"target.x": "m"}, optional={"max_speed_m_s": 0.5})
    def push(target_x, max_speed_m_s):
        ...
        sim.advance(0.01)               # simulated time; ends the action at its limit
        raise Failed("path-blocked: ...")

    sim.run()

What the program prints goes to standard error: standard output belongs to the protocol. An
exception that nothing catches is told as an error of the simulator, with its traceback on standard
error, never as something that was observed.
"""

import json
import math
import os
import random
import sys
import traceback

PROTOCOL = 1
MAX_LINE = 1 << 20  # bytes, without the newline


class Failed(Exception):
    """The action failed in the simulated world: an observation. Say `KIND: why`."""


class InvalidStart(Exception):
    """The start cannot be: bodies interpenetrate, a joint is beyond its stop."""


class Lost(Exception):
    """The simulator failed, and what it would say is worth nothing. It stays alive."""


class _Truncated(BaseException):  # no Exception, so that no action swallows it
    """Simulated time is over."""


class _Refused(Exception):
    """The scenario asks for what is not there."""


class _Answer(Exception):
    """An error reply."""

    def __init__(self, code, message):
        super().__init__(message)
        self.code = code


def _plain(name, value):
    """As JSON has it; numbers of numpy and its like become plain ones."""
    if isinstance(value, (bool, int, str)):
        return value
    if not isinstance(value, float) and hasattr(value, "item"):
        return _plain(name, value.item())
    if isinstance(value, float):
        if not math.isfinite(value):
            raise _Answer("not_finite", "`%s` is %r" % (name, value))
        return value
    raise TypeError("`%s` is neither bool, number nor text but %s" % (name, type(value).__name__))


class _Param:
    def __init__(self, name, unit, settable, default, lower, upper):
        if settable and default is None:
            raise ValueError("`%s` can be set, so it needs a default" % name)
        self.name, self.unit, self.settable, self.default = name, unit, settable, default
        self.lower, self.upper = lower, upper

    def short(self):
        return {"name": self.name, "unit": self.unit, "settable": self.settable}

    def said(self):
        said = self.short()
        if self.lower is not None:
            said["lower"] = self.lower
        if self.upper is not None:
            said["upper"] = self.upper
        return said

    def taken(self, value):
        if isinstance(self.default, (bool, str)):
            if type(value) is not type(self.default):
                raise _Refused("`%s` cannot be %r" % (self.name, value))
            return value
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            raise _Refused("`%s` is a number, not %r" % (self.name, value))
        if (self.lower is not None and value < self.lower) or (
            self.upper is not None and value > self.upper
        ):
            raise InvalidStart(
                "`%s` is %r, beyond %r to %r" % (self.name, value, self.lower, self.upper)
            )
        return value if isinstance(self.default, int) and isinstance(value, int) else float(value)


class _Action:
    def __init__(self, name, function, required, optional, instant):
        self.name, self.function, self.instant = name, function, instant
        self.required, self.optional = dict(required), dict(optional)
        keywords = [key.replace(".", "_") for key in self.arguments()]
        if len(set(keywords)) != len(keywords):
            raise ValueError("two arguments of `%s` have one keyword" % name)

    def arguments(self):
        return list(self.required) + list(self.optional)

    def said(self):
        """A required argument is declared by its unit, or by (unit, example)."""
        args = []
        for name, what in self.required.items():
            unit, example = what if isinstance(what, tuple) else (what, None)
            said = {"name": name, "unit": unit, "required": True}
            if example is not None:
                said["example"] = example
            args.append(said)
        for name, default in self.optional.items():
            args.append({"name": name, "required": False, "example": default})
        return dict(self.short(), args=args)

    def short(self):
        return {"name": self.name, "instant": True} if self.instant else {"name": self.name}

    def keywords(self, given):
        for name in given:
            if name not in self.required and name not in self.optional:
                raise _Refused("`%s` takes no argument `%s`" % (self.name, name))
        for name in self.required:
            if name not in given:
                raise _Refused("`%s` lacks the argument `%s`" % (self.name, name))
        values = dict(self.optional)
        values.update(given)
        for name, default in self.optional.items():
            if isinstance(default, float) and type(values[name]) is int:
                values[name] = float(values[name])
            if isinstance(default, str) != isinstance(values[name], str) or (
                isinstance(default, bool) != isinstance(values[name], bool)
            ):
                raise _Refused("`%s` of `%s` cannot be %r" % (name, self.name, values[name]))
        return {name.replace(".", "_"): value for name, value in values.items()}


class Adapter:
    """One simulated world. `determinism` is "bitwise", "tolerance" or "none" and says whether the
    same start and seed give the same result; `seeds` whether all randomness comes from the seed
    (`sim.random` does). `noise` claims that results vary with it. Without `perform` each request is
    made on its own."""

    def __init__(self, name, version="", determinism="none", seeds=True, noise=False,
                 time_step=0.0, min_real_time_factor=None, perform=True):
        if determinism not in ("bitwise", "tolerance", "none"):
            raise ValueError("determinism is bitwise, tolerance or none")
        self.name, self.version, self.determinism = name, version, determinism
        self.seeds, self.noise, self.time_step = seeds, noise, time_step
        self.min_real_time_factor = min_real_time_factor
        self._performs = perform
        self.random = random.Random(0)  # seeded anew at each reset
        self.time = 0.0  # simulated seconds since reset
        self._params, self._actions = {}, {}
        self._reset = self._observe = self._poses = self._scene = None
        self._margins, self._object = {}, ""
        self._limit_at, self._is_over, self._ready = math.inf, False, False
        self._interval, self._frames, self._next_frame = 0.0, [], 0.0

    # Declarations of a program.

    def param(self, name, unit="1", settable=False, default=None, lower=None, upper=None):
        """A variable of the state. A start outside of `lower` and `upper` is an invalid one; what
        a start does not name takes its default."""
        if name in self._params:
            raise ValueError("`%s` is declared twice" % name)
        self._params[name] = _Param(name, unit, settable, default, lower, upper)

    def on_reset(self, function):
        """function(start): puts the world into the start, a dict of all settable params."""
        self._reset = function
        return function

    def on_observe(self, function):
        """function() -> dict of all params."""
        self._observe = function
        return function

    def action(self, name, required=(), optional=(), instant=False):
        """function(**arguments), dots in their names as underscores (`target.x`: target_x).
        `required` maps names to units, or to (unit, example); `optional` to defaults. An
        `instant` action takes no simulated time."""

        def declare(function):
            if name in self._actions:
                raise ValueError("the action `%s` is declared twice" % name)
            self._actions[name] = _Action(
                name, function, required or {}, optional or {}, instant)
            return function

        return declare

    def on_poses(self, bodies, grippers=()):
        """function() -> {body: (x, y, z) or (x, y, z, qw, qx, qy, qz)}, or a pair of that and
        {body: gripper} for what is held. `bodies` as docs/reference/formats.md has them."""

        def declare(function):
            self._poses = function
            self._scene = {"bodies": list(bodies), "grippers": list(grippers)}
            return function

        return declare

    # Functions for actions.

    def advance(self, seconds):
        """Simulated time passes. Ends the action where its time limit is reached."""
        if not (math.isfinite(seconds) and seconds >= 0.0):
            raise ValueError("time passes by %r s" % seconds)
        self.time += seconds
        self._take_frame(False)
        self._is_over = self.time >= self._limit_at - 1e-9
        if self._is_over:
            raise _Truncated()

    def margin(self, name, value):
        """By how much the action went well (positive) or failed (negative)."""
        self._margins[name] = value

    def found(self, name):
        """The thing that the action found, as the model calls it."""
        self._object = name

    # The protocol.

    def run(self):
        """Answers requests until `close` or the end of the input."""
        if self._reset is None or self._observe is None:
            raise RuntimeError("declare a function with on_reset and one with on_observe")
        requests = os.fdopen(os.dup(0), "rb")
        replies = os.fdopen(os.dup(1), "wb")
        # Whatever else reads or prints, also from C or in another process, does no harm.
        nothing = os.open(os.devnull, os.O_RDONLY)
        os.dup2(nothing, 0)
        os.close(nothing)
        os.dup2(2, 1)
        sys.stdout = sys.stderr
        self._begin()
        for line in iter(lambda: requests.readline(MAX_LINE + 2), b""):
            reply, is_last = self._reply_to(line)
            try:
                replies.write(_line(reply))
                replies.flush()
            except BrokenPipeError:  # whoever asked is gone
                os._exit(1)
            if is_last:
                return

    def _begin(self):
        """What has to be done before the first request, with standard output out of the way."""

    def _reply_to(self, line):
        """The reply and whether it is the last one."""
        request_id, method = None, None
        try:
            request = _parsed(line)
            request_id, method = request.get("id"), request.get("method")
            if type(request_id) is not int:
                request_id = None
                raise _Answer("invalid_request", "`id` is missing or no integer")
        except _Answer as error:
            return _error(request_id, error.code, str(error)), False
        reply = {"id": request_id}
        reply.update(self._answered(method, request.get("params", {})))
        return reply, method == "close" and "result" in reply

    def _answered(self, method, params):
        """`result` or `error`, of a request of its own or one of several."""
        try:
            if not isinstance(params, dict):
                raise _Answer("invalid_params", "`params` is no object")
            return {"result": self._answer(method, params)}
        except _Answer as error:
            return _error(None, error.code, str(error), with_id=False)
        except Exception as error:  # a defect of the program: never an observation
            traceback.print_exc()
            text = "%s: %s" % (type(error).__name__, error)
            return _error(None, "internal", text, with_id=False)

    def _performed(self, params):
        """A reset, observations and acts at once, up to the first that goes no further."""
        requests = params.get("requests")
        if not isinstance(requests, list) or not requests or not all(
            isinstance(one, dict) for one in requests
        ):
            raise _Answer("invalid_params", "`requests` is no list of objects")
        methods = [one.get("method") for one in requests]
        if methods[0] != "reset" or not set(methods[1:]) <= {"act", "observe"}:
            raise _Answer("invalid_params", "`requests` is a reset, then acts and observations")
        replies = []
        for one in requests:
            replies.append(self._answered(one["method"], one.get("params", {})))
            status = replies[-1].get("result", {}).get("status", "ok")
            if "error" in replies[-1] or status not in ("ok", "failed", "truncated"):
                break
        return {"replies": replies}

    def _answer(self, method, params):
        if method == "perform" and self._performs:
            return self._performed(params)
        if method == "hello":
            return self._hello(params)
        if method == "describe":
            return self._described()
        if method == "close":
            return {"status": "ok"}
        if method == "reset":
            return self._outcome(lambda: self._do_reset(params))
        if method not in ("act", "observe"):
            raise _Answer("unsupported", "no method `%s`" % method)
        if not self._ready:
            raise _Answer("incorrect_state", "`%s` before a successful reset" % method)
        if method == "act":
            return self._outcome(lambda: self._do_act(params))
        return {"state": self._observed()}

    def _hello(self, params):
        if PROTOCOL not in params.get("protocol", []):
            raise _Answer("unsupported", "this simulator speaks protocol %d" % PROTOCOL)
        said = {"protocol": PROTOCOL, "name": self.name, "version": self.version,
                "determinism": self.determinism, "seeds": self.seeds,
                "time_step": self.time_step,
                "capabilities": ["describe", "margins"] + (["noise"] if self.noise else [])
                + (["perform"] if self._performs else []) + (["poses"] if self._scene else [])}
        if self.min_real_time_factor is not None:
            said["min_real_time_factor"] = self.min_real_time_factor
        if self._scene:
            said["pose"] = self._scene
        said["params"] = [param.short() for param in self._params.values()]
        said["actions"] = [action.short() for action in self._actions.values()]
        return said

    def _described(self):
        return {"params": [param.said() for param in self._params.values()],
                "actions": [action.said() for action in self._actions.values()]}

    def _do_reset(self, params):
        self._ready = False
        given, seed = params.get("state"), params.get("seed")
        if not isinstance(given, dict) or type(seed) is not int or seed < 0:
            raise _Answer("invalid_params", "`state` is an object, `seed` an integer from 0 on")
        for name in given:
            if name not in self._params or not self._params[name].settable:
                raise _Refused("no start can choose `%s`" % name)
        start = {param.name: param.taken(given.get(param.name, param.default))
                 for param in self._params.values() if param.settable}
        self.random.seed(seed)
        self.time, self._limit_at = 0.0, math.inf
        self._interval = float(params.get("pose_interval") or 0.0) if self._poses else 0.0
        self._frames, self._next_frame = [], 0.0
        self._reset(start)
        self._ready = True
        self._take_frame(True)

    def _do_act(self, params):
        given, limit = params.get("args", {}), params.get("sim_time_limit")
        if not isinstance(given, dict) or isinstance(limit, bool) or not (
            isinstance(limit, (int, float)) and limit >= 0.0
        ):
            raise _Answer("invalid_params", "`args` is an object, `sim_time_limit` a number")
        action = self._actions.get(params.get("action"))
        if action is None:
            raise _Refused("there is no action `%s`" % params.get("action"))
        keywords = action.keywords(given)
        self._limit_at, self._is_over = self.time + limit, False
        try:
            action.function(**keywords)
            if self._is_over:  # whatever swallowed it
                raise _Truncated()
        finally:
            self._limit_at = math.inf
            self._take_frame(True)

    def _outcome(self, work):
        """What became of a request: each end of `work` has its status."""
        began, self._margins, self._object = self.time, {}, ""
        status, reason = "ok", ""
        try:
            work()
        except Failed as why:
            status, reason = "failed", str(why)
        except _Truncated:
            status = "truncated"
        except InvalidStart as why:
            status, reason = "invalid_start", str(why)
        except _Refused as why:
            status, reason = "unsupported", str(why)
        except Lost as why:
            traceback.print_exc()
            status, reason = "lost", str(why)
        said = {"status": status, "sim_time": max(0.0, self.time - began)}
        if reason:
            said["reason"] = reason
        if self._margins:
            said["margins"] = {name: _plain(name, value) for name, value in self._margins.items()}
        if self._object:
            said["object"] = self._object
        if self._frames:
            said["poses"], self._frames = self._frames, []
        return said

    def _observed(self):
        seen = {name: _plain(name, value) for name, value in self._observe().items()}
        for name in self._params:
            if name not in seen:
                raise _Answer("internal", "`%s` was declared and is not observed" % name)
        for name in seen:
            if name not in self._params and name != "digest":
                raise _Answer("internal", "`%s` is observed and was not declared" % name)
        return seen

    def _take_frame(self, at_any_time):
        if self._interval <= 0.0 or not self._ready:
            return
        if not at_any_time and self.time < self._next_frame:
            return
        self._next_frame = self.time + self._interval
        said = self._poses()
        bodies, held = said if isinstance(said, tuple) else (said, None)
        frame = {"t": self.time, "bodies": {name: [_plain(name, number) for number in pose]
                                            for name, pose in bodies.items()}}
        if held is not None:
            frame["held"] = dict(held)
        self._frames.append(frame)


def _no_number(text):
    raise ValueError("%s is no number of JSON" % text)


def _finite(text):
    number = float(text)
    return number if math.isfinite(number) else _no_number(text)


def _parsed(line):
    if len(line.rstrip(b"\n")) > MAX_LINE:
        raise _Answer("line_too_long", "a request of more than 1 MiB")
    try:
        request = json.loads(line.decode("utf-8"), parse_constant=_no_number, parse_float=_finite)
    except (ValueError, RecursionError) as error:
        raise _Answer("parse_error", "the line is not JSON: %s" % error) from None
    if not isinstance(request, dict):
        raise _Answer("invalid_request", "the line is no object")
    return request


def _error(request_id, code, message, with_id=True):
    error = {"error": {"code": code, "message": message}}
    return dict({"id": request_id}, **error) if with_id else error


def _line(reply):
    """One line of UTF-8. What is too long becomes an error, or is told without its poses."""
    text = json.dumps(reply, allow_nan=False, ensure_ascii=False).encode("utf-8", "replace")
    result = reply.get("result", {})
    longest = [one for one in [result] + [one.get("result", {}) for one in result.get("replies", [])]
               if "poses" in one]
    if len(text) > MAX_LINE and longest:
        for one in longest:
            one.pop("poses")
            one["motion_fault"] = "the poses do not go in a line"
        return _line(reply)
    if len(text) > MAX_LINE:
        text = json.dumps(_error(reply["id"], "line_too_long", "the reply is too long")).encode()
    return text + b"\n"
