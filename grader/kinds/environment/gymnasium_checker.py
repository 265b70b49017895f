"""Runs Gymnasium's own checker in the grader, on an environment that forwards every call to a student's process.

What that process answers is data, of which values and spaces are rebuilt here. The grader judges these copies, never what
the process says about them: whether an observation lies in its space, for one, is decided here.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Final, TypeAlias

import gymnasium
import numpy as np
from gymnasium.utils.env_checker import check_env

from grader.kinds.environment.described_values import rebuild_space, rebuild_value
from kit.host.failure import StudentCodeError
from kit.host.wire import Json, printable

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
