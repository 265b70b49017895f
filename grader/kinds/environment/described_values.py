"""Values and spaces as a student's process describes them, rebuilt within limits."""

from __future__ import annotations

import math
import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

import gymnasium
import numpy as np

from kit.host.wire import MAX_NAME, Json, ProtocolError, integer, items, number, printable, text

MAX_NUMBERS: Final = 1000
"""Numbers of one array that a student's process sends; see ``environment_examiner``."""

MAX_PARTS: Final = 16
"""Parts of one tuple, list or dictionary that it sends."""
MAX_DEPTH: Final = 5
MAX_DIMENSIONS: Final = 8
MAX_SIZE: Final = 10**9
NUMBER_KINDS: Final = ("int8", "int16", "int32", "int64", "uint8", "uint16", "uint32", "uint64")
DTYPES: Final = ("bool", *NUMBER_KINDS, "float16", "float32", "float64")


@dataclass(frozen=True, slots=True)
class UnknownValue:
    """Stands for a value that cannot be rebuilt, such as an object of the student's own class. Equal to any other: two infos
    that are too large to be sent whole must not pass for different ones."""


class UnknownSpace(gymnasium.Space[Any]):
    """Stands for a space of a kind that is not rebuilt. Nothing lies in it."""

    def contains(self, x: Any) -> bool:
        return False


def check_description(value: Json, depth: int = MAX_DEPTH) -> None:
    """Raises ProtocolError unless a value has the form that ``environment_examiner.describe_value`` gives it."""
    if not isinstance(value, dict) or depth == 0:
        raise ProtocolError("a value that is not described as agreed")
    for name in ("kind", "dtype"):
        text(value.get(name, ""), MAX_NAME)
    text(value.get("text", ""))
    integer(value.get("count", 0))
    check_shape(value.get("shape", []))
    for each in [value.get("value"), *items(value.get("numbers", []))]:
        if each is not None and type(each) is not bool:
            number(each)
    named = value.get("items", {})
    if not isinstance(named, dict):
        raise ProtocolError("a dictionary that is not described as agreed")
    for each in (*items(value.get("parts", [])), *items(value.get("values", [])), *named.values()):
        check_description(each, depth - 1)


def check_shape(value: Json) -> tuple[int, ...]:
    """Returns the shape of an array. Raises ProtocolError for anything else, and for too many dimensions."""
    sizes = items(value)
    if len(sizes) > MAX_DIMENSIONS:
        raise ProtocolError(f"an array of more than {MAX_DIMENSIONS} dimensions")
    return tuple(integer(each, 0, MAX_SIZE) for each in sizes)


_PARTS: Final = {"tuple": "parts", "list": "values", "dict": "items"}
"""The keys under which a value's parts are described, by its kind."""


def rebuild_value(content: Mapping[str, Any]) -> Any:
    """Returns the value that ``check_description`` has accepted; an ``UnknownValue`` where there is no telling."""
    kind, value = content.get("kind"), content.get("value")
    if kind in _PARTS and _PARTS[kind] not in content:  # it lies deeper than MAX_DEPTH
        return UnknownValue()
    if kind in ("tuple", "list"):
        parts = [rebuild_value(each) for each in content[_PARTS[kind]]]
        missing = min(content.get("count", 0), 10 * MAX_PARTS) - len(parts)
        parts += [UnknownValue()] * missing
        return tuple(parts) if kind == "tuple" else parts
    if kind == "dict":
        return {name: rebuild_value(each) for name, each in content["items"].items()}
    if kind == "ndarray":
        return _rebuild_array(content)
    if kind == "bool":
        return np.bool_(value) if content.get("numpy") else bool(value)
    if kind in ("int", "float") or kind in DTYPES:
        if kind == "float" or value is None:
            return math.nan if value is None else float(value)
        try:
            return int(value) if kind == "int" else np.dtype(kind).type(value)
        except (OverflowError, ValueError):  # no such number of that kind
            return UnknownValue()
    if kind == "str":
        return content.get("text", "")
    return None if kind == "NoneType" else UnknownValue()


def _rebuild_array(content: Mapping[str, Any]) -> Any:
    dtype, shape, numbers = (content.get(each) for each in ("dtype", "shape", "numbers"))
    if dtype not in DTYPES or shape is None or numbers is None or len(numbers) != math.prod(shape):
        return UnknownValue()
    values = np.array([math.nan if each is None else float(each) for each in numbers])
    with np.errstate(all="ignore"):
        return values.astype(dtype).reshape(shape)


def rebuild_space(content: Json) -> Any:
    """Returns the space that ``environment_examiner.describe_space`` has described; an ``UnknownValue`` for no space."""
    if not isinstance(content, dict):
        return UnknownValue()
    try:
        if content.get("kind") == "Discrete":
            return gymnasium.spaces.Discrete(
                integer(content.get("n"), 1, MAX_SIZE),
                start=integer(content.get("start"), -MAX_SIZE, MAX_SIZE),
            )
        if content.get("kind") == "Box":
            return _rebuild_box(content)
    except (ProtocolError, ValueError, TypeError, AssertionError, OverflowError):
        return UnknownSpace()
    return UnknownSpace() if content.get("is_space") is True else UnknownValue()


def clean_space(content: Json) -> dict[str, Json]:
    """Returns the description of a space for the checks, made of the rebuilt space where there is one."""
    space = rebuild_space(content)
    if isinstance(space, gymnasium.spaces.Discrete):
        return {"kind": "Discrete", "n": int(space.n), "start": int(space.start)}
    if isinstance(space, gymnasium.spaces.Box):
        lows, highs = (bounds.ravel().astype(np.float64) for bounds in (space.low, space.high))
        bounds = {"low": lows.min() if lows.size else None, "high": highs.max() if highs.size else None}
        finite = {
            name: float(each) if each is not None and math.isfinite(each) else None
            for name, each in bounds.items()
        }
        return {"kind": "Box", "shape": list(space.shape), "dtype": str(space.dtype), **finite}
    kind = content.get("kind") if isinstance(content, dict) else None
    return {"kind": printable(kind)[:MAX_NAME] if isinstance(kind, str) else None}


def _rebuild_box(content: Mapping[str, Any]) -> Any:
    shape = check_shape(content.get("shape"))
    dtype, size = content.get("dtype"), math.prod(shape)
    if dtype not in DTYPES or size > MAX_NUMBERS:
        raise ProtocolError("a box of another kind")
    bounds = []
    for name, unbounded in (("lows", -math.inf), ("highs", math.inf)):
        given = items(content.get(name), size)
        numbers = [unbounded if each is None else number(each) for each in given]
        bounds.append(np.array(numbers, dtype=np.float64).reshape(shape).astype(dtype))
    return gymnasium.spaces.Box(bounds[0], bounds[1], dtype=np.dtype(dtype).type)


def is_in_space(space: Any, value: Any) -> bool:
    """True if a rebuilt value lies in a rebuilt space."""
    if not isinstance(space, gymnasium.Space):
        return False
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            return bool(space.contains(value))
        except (TypeError, ValueError):  # a list of what is no number
            return False
