"""Reads JSON without losing a digit, and takes members by type."""

import json
from typing import Any, Dict, List, Optional, Tuple

Object = Dict[str, Any]

_DIGITS = 4000  # Python converts no more than 4300 at once


def _integer(digits: str) -> int:
    """Counts of traces have any number of digits."""
    if len(digits) <= _DIGITS:
        return int(digits)
    sign, digits = (-1, digits[1:]) if digits[0] == "-" else (1, digits)
    value = 0
    for at in range(0, len(digits), _DIGITS):
        piece = digits[at:at + _DIGITS]
        value = value * 10 ** len(piece) + int(piece)
    return sign * value


def parse(text: str) -> Any:
    """The value of a JSON text. Raises ValueError."""
    try:
        return json.loads(text, parse_int=_integer)
    except RecursionError:
        raise ValueError("the text is nested too deeply") from None


def parse_object(text: str) -> Optional[Object]:
    """The object that the text is; None if it is anything else."""
    try:
        value = parse(text)
    except ValueError:
        return None
    return value if isinstance(value, dict) else None


def texts(owner: Object, key: str) -> Tuple[str, ...]:
    """A list of texts; empty if there is none."""
    return tuple(str(one) for one in owner.get(key) or ())


def objects(owner: Object, key: str) -> List[Object]:
    """A list of objects; empty if there is none."""
    return [one for one in owner.get(key) or () if isinstance(one, dict)]


def optional_int(owner: Object, key: str) -> Optional[int]:
    value = owner.get(key)
    return None if value is None else int(value)


def optional_float(owner: Object, key: str) -> Optional[float]:
    value = owner.get(key)
    return None if value is None else float(value)
