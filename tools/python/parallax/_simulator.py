"""Turns a class into a simulator behind the pipe protocol (docs/reference/protocol.md).

The protocol itself is spoken by `parallax_adapter`, which also works without this package.
"""

from dataclasses import dataclass
from typing import Any, Callable, Dict, List, Mapping, Optional, Sequence, Tuple, Type, TypeVar, Union

from parallax_adapter import Adapter, Failed, InvalidStart, Lost

__all__ = ["Adapter", "Failed", "InvalidStart", "Lost", "action", "observed", "param", "poses",
           "serve", "simulator"]

Value = Union[float, bool, str]
Required = Mapping[str, Union[str, Tuple[str, Value]]]
C = TypeVar("C")
F = TypeVar("F", bound=Callable[..., Any])

_MAKER = "__parallax_adapter__"
_ACTION = "__parallax_action__"
_POSES = "__parallax_poses__"


@dataclass(frozen=True)
class _Variable:
    name: str
    unit: str
    settable: bool
    default: Value
    lower: Optional[float] = None
    upper: Optional[float] = None


@dataclass(frozen=True)
class _Action:
    name: str
    required: Required
    optional: Mapping[str, Value]


@dataclass(frozen=True)
class _Poses:
    bodies: Sequence[Mapping[str, Any]]
    grippers: Sequence[str]


def param(name: str, unit: str = "1", default: Value = 0.0, lower: Optional[float] = None,
          upper: Optional[float] = None) -> Any:
    """An attribute that a start sets and that is observed. A start outside of the bounds is
    invalid; one that does not name it takes the default."""
    return _Variable(name, unit, True, default, lower, upper)


def observed(name: str, default: Value = False, unit: str = "1") -> Any:
    """An attribute that is observed, and that each start sets to `default`."""
    return _Variable(name, unit, False, default)


def action(name: str, required: Optional[Required] = None,
           optional: Optional[Mapping[str, Value]] = None) -> Callable[[F], F]:
    """A method that is an action. `required` maps arguments to units, or to (unit, example);
    `optional` to defaults. Dots in their names are underscores of the method's parameters."""

    def declare(function: F) -> F:
        setattr(function, _ACTION, _Action(name, dict(required or {}), dict(optional or {})))
        return function

    return declare


def poses(bodies: Sequence[Mapping[str, Any]], grippers: Sequence[str] = ()) -> Callable[[F], F]:
    """A method that says where bodies are, so that runs leave recordings."""

    def declare(function: F) -> F:
        setattr(function, _POSES, _Poses(bodies, grippers))
        return function

    return declare


def simulator(name: str, version: str = "", determinism: str = "none", seeds: bool = True,
              noise: bool = False, time_step: float = 0.0,
              min_real_time_factor: Optional[float] = None) -> Callable[[Type[C]], Type[C]]:
    """Makes a class a simulator, which `serve` runs.

    Each start makes a new object, without arguments, so that nothing is left of the run before;
    then its variables are set, and its method `reset` is called if there is one. `self.sim` is the
    `Adapter`: `self.sim.advance(seconds)`, `self.sim.random`, `self.sim.margin(name, value)`.
    """

    def decorate(world: Type[C]) -> Type[C]:
        variables: Dict[str, _Variable] = {}
        methods: List[Tuple[str, _Action]] = []
        scene: Optional[Tuple[str, _Poses]] = None
        for key in dir(world):
            value = getattr(world, key)
            if isinstance(value, _Variable):
                variables[key] = value
            elif isinstance(getattr(value, _ACTION, None), _Action):
                methods.append((key, getattr(value, _ACTION)))
            elif isinstance(getattr(value, _POSES, None), _Poses):
                scene = (key, getattr(value, _POSES))
        if not variables or not methods:
            raise TypeError("`%s` needs a variable (param) and an action" % world.__name__)
        for key, variable in variables.items():
            setattr(world, key, variable.default)

        def make() -> Adapter:
            sim = Adapter(name, version=version, determinism=determinism, seeds=seeds, noise=noise,
                          time_step=time_step, min_real_time_factor=min_real_time_factor)
            return _bound(sim, world, variables, methods, scene)

        setattr(world, _MAKER, staticmethod(make))
        return world

    return decorate


def _bound(sim: Adapter, world: Type[C], variables: Mapping[str, _Variable],
           methods: Sequence[Tuple[str, _Action]],
           scene: Optional[Tuple[str, _Poses]]) -> Adapter:
    """Declares everything of the class to its adapter."""
    now: List[Any] = []  # the object of the present run

    def reset(start: Mapping[str, Value]) -> None:
        made: Any = world.__new__(world)
        made.sim = sim
        made.__init__()
        for key, variable in variables.items():
            setattr(made, key, start.get(variable.name, variable.default))
        now[:] = [made]
        if hasattr(made, "reset"):
            made.reset()

    def observe() -> Dict[str, Value]:
        return {variable.name: getattr(now[0], key) for key, variable in variables.items()}

    def caller(key: str) -> Callable[..., Any]:
        return lambda *values, **named: getattr(now[0], key)(*values, **named)

    for variable in variables.values():
        sim.param(variable.name, unit=variable.unit, settable=variable.settable,
                  default=variable.default, lower=variable.lower, upper=variable.upper)
    sim.on_reset(reset)
    sim.on_observe(observe)
    for key, declared in methods:
        sim.action(declared.name, declared.required, declared.optional)(caller(key))
    if scene is not None:
        sim.on_poses(scene[1].bodies, scene[1].grippers)(caller(scene[0]))
    return sim


def serve(world: type) -> None:
    """Answers requests on standard input until it ends. Call it at the end of a program:

        if __name__ == "__main__":
            serve(MyWorld)
    """
    make = getattr(world, _MAKER, None)
    if make is None:
        raise TypeError("`%s` is no simulator: decorate it with @simulator(...)" % world.__name__)
    make().run()
