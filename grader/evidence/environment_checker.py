"""Runs Gymnasium's own checker in the grader, on an environment that forwards every call to a student's process.

What that process answers is data, of which values and spaces are rebuilt here. The grader judges these copies, never what
the process says about them: whether an observation lies in its space, for one, is decided here.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Final, TypeAlias

import gymnasium
import numpy as np
from gymnasium.utils.env_checker import check_env

from kit.host.failure import StudentCodeError
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


MAX_COMPLAINT: Final = 500
ACTION_SEED: Final = 123
"""Gymnasium's checker samples its first action unseeded; a work has one grade, however often it is graded."""

ForwardCall: TypeAlias = Callable[[dict[str, Json]], Mapping[str, Any]]
"""Forwards a call to the student's process; returns its answer. Raises StudentCodeError."""


class EnvironmentCallError(Exception):
    """The student's environment has raised an exception; the message names its type."""


@dataclass(frozen=True, slots=True)
class GeneratorState:
    """Stands for a bit generator: only its state is compared."""

    state: str


@dataclass(frozen=True, slots=True)
class RandomGenerator:
    """Stands for the generator of the student's environment."""

    bit_generator: GeneratorState


class ForwardingEnv(gymnasium.Env[Any, Any]):
    """An environment whose methods are those of another process; it rebuilds what they return."""

    def __init__(self, forward: ForwardCall, description: Mapping[str, Json]) -> None:
        self._forward = forward
        self._last: list[Any] = [None, None]
        for name in ("action_space", "observation_space"):
            space = description.get(name)
            if not isinstance(space, dict) or space.get("kind") != "NoneType":
                setattr(self, name, rebuild_space(space))

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> Any:
        keywords: dict[str, Json] = {} if seed is None else {"seed": seed}
        if options is not None:
            keywords["options"] = {}
        return self._call({"call": "reset", "keywords": keywords})

    def step(self, action: Any) -> Any:
        return self._call({"call": "step", "action": int(action)})

    def _call(self, question: dict[str, Json]) -> Any:
        answer = self._forward({**question, "checking": True})
        if "raised" in answer:
            raise EnvironmentCallError(printable(str(answer["raised"]))[:MAX_COMPLAINT])
        generator = answer.get("generator")
        state: Any = None if generator is None else RandomGenerator(GeneratorState(str(generator)))
        self._np_random = state
        returned = rebuild_value(answer["returned"])
        if not isinstance(returned, tuple) or not returned:
            return returned
        reused = answer.get("reused")
        is_observation_reused, is_info_reused = (
            reused if isinstance(reused, list) and len(reused) == 2 else (0, 0)
        )
        observation, *others, info = returned if len(returned) > 1 else (*returned, None)
        if is_observation_reused is True and isinstance(self._last[0], np.ndarray):
            observation = _overwrite(self._last[0], observation)
        if is_info_reused is True and isinstance(self._last[1], dict):
            info = self._last[1]
        self._last = [observation, info]
        return (observation, *others, info) if len(returned) > 1 else returned


def _overwrite(array: Any, value: Any) -> Any:
    """Writes an observation into the array of an earlier one, as the student's environment did."""
    if not isinstance(value, np.ndarray) or value.shape != array.shape or value.dtype != array.dtype:
        return value
    array[...] = value
    return array


def first_checker_complaint(forward: ForwardCall, description: Mapping[str, Json]) -> str:
    """Returns the first complaint of Gymnasium's checker; empty if it has none. Raises StudentCodeError."""
    env = ForwardingEnv(forward, description)
    if isinstance(space := getattr(env, "action_space", None), gymnasium.Space):
        space.seed(ACTION_SEED)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            check_env(env, skip_render_check=True)
        except StudentCodeError:
            raise
        except EnvironmentCallError as problem:
            return str(problem)
        except Exception as problem:  # noqa: BLE001  # any error is a complaint for the student to read
            return printable(f"{type(problem).__name__}: {problem}")[:MAX_COMPLAINT]
    return next((printable(str(each.message))[:MAX_COMPLAINT] for each in caught), "")
