"""A student's reward in training: a function ``reward`` in a file of theirs, run in a process of its own.

Its parameters are named after what it wants to know of a step, by the names of ``Transition``:

    def reward(reached, collided, to_go, previous_to_go):
        return 2.0 * reached - 2.0 * collided + previous_to_go - to_go

It is called once for each step of each world, with plain numbers; for two robots what belongs to a robot is a list
of two, the left one's first.
"""

from __future__ import annotations

import ast
import errno
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any, Self

import numpy as np

from kit.host.failure import Failure, FailureKind, StudentCodeError
from kit.host.sandbox.probe import highest_level_up_to
from kit.host.sandbox.sandbox_config import Level
from kit.host.student_functions import StudentFunctions
from kit.learning.tasks.transition import TRANSITION_FIELDS, Array, Transition
from kit.plain_files import read_plain_file
from kit.plain_text import nearest_name, quoted

REWARD_FUNCTION = "reward"
METRIC_PREFIX = "metric_"
"""Functions of the file whose names begin so are counted like terms of the reward, and no part of it: a curve each."""
MAX_SOURCE_BYTES = 128 * 1024
"""Bytes of a file with a reward: parsing takes more than a kilobyte of memory for each."""


LARGEST_REWARD = 1e9
"""The largest magnitude of a reward of one step: sums of larger ones overflow, or lose everything else that was added."""


class RewardFileError(Exception):
    """The file has no function that can be called; the message names file and line, and what to do."""


def reward_parameters(file: Path) -> tuple[str, ...]:
    """Returns the parameter names of the file's ``reward``. The file is read, not run. Raises RewardFileError."""
    functions = _read_functions(file)
    if REWARD_FUNCTION in functions:
        return functions[REWARD_FUNCTION]
    raise RewardFileError(
        f"{file}: it has no function {REWARD_FUNCTION}(). Write one, such as\n"
        f"  def {REWARD_FUNCTION}(reached, collided):\n      return 2.0 * reached - 2.0 * collided"
    )


def metric_parameters(file: Path) -> dict[str, tuple[str, ...]]:
    """Returns the parameter names of each metric of the file, by the metric's name. As ``reward_parameters``."""
    return {
        name.removeprefix(METRIC_PREFIX): parameters
        for name, parameters in _read_functions(file).items()
        if name != REWARD_FUNCTION
    }


def _read_functions(file: Path) -> dict[str, tuple[str, ...]]:
    """The parameter names of the reward and the metrics, by the functions' names."""
    try:
        tree = ast.parse(read_plain_file(file, MAX_SOURCE_BYTES), file.name)
    except OSError as error:
        if error.errno == errno.EFBIG:
            raise RewardFileError(
                f"{file}: larger than {MAX_SOURCE_BYTES // 1024} KiB. A reward is a few lines: leave out everything else."
            ) from None
        raise RewardFileError(f"{file}: cannot be read ({error.strerror}).") from None
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        line = f":{error.lineno}" if isinstance(error, SyntaxError) and error.lineno else ""
        raise RewardFileError(f"{file}{line}: not Python ({getattr(error, 'msg', error)}).") from None
    return {
        node.name: _checked_parameters(file, node)
        for node in tree.body
        if isinstance(node, ast.FunctionDef)
        and (node.name == REWARD_FUNCTION or node.name.startswith(METRIC_PREFIX))
    }


def _checked_parameters(file: Path, node: ast.FunctionDef) -> tuple[str, ...]:
    arguments = node.args
    where = f"{file}:{node.lineno}: {node.name}()"
    if arguments.posonlyargs or arguments.vararg:
        raise RewardFileError(f"{where} is called with keyword arguments: leave out '/' and '*'.")
    names = tuple(each.arg for each in (*arguments.args, *arguments.kwonlyargs))
    unknown = [name for name in names if name not in TRANSITION_FIELDS]
    if unknown:
        nearest = [(name, nearest_name(name, TRANSITION_FIELDS)) for name in unknown]
        meant = "".join(
            f" For {quoted(name)}, did you mean {quoted(near)}?" for name, near in nearest if near
        )
        raise RewardFileError(
            f"{where} asks for {' and '.join(map(quoted, unknown))}, which a step does not have.{meant} "
            f"It can ask for: {', '.join(TRANSITION_FIELDS)}."
        )
    if not names:
        raise RewardFileError(f"{where} has no arguments. It can use: {', '.join(TRANSITION_FIELDS)}.")
    return names


class StudentReward:
    """The file's reward as a ``RewardFunction``. Use as a context manager, or ``close`` it.

    It runs at the highest level that the machine has: a task, a run or a policy that names it may be somebody else's.

    RewardFileError for a file that cannot be called; StudentCodeError when the student's code fails, here or in a call.
    """

    def __init__(
        self,
        file: Path,
        *,
        seed: int = 0,
        original: Path | None = None,
    ) -> None:
        """``original``: the student's own file where ``file`` is a copy of it; failures name that one."""
        self._names = reward_parameters(file)
        self._metrics = metric_parameters(file)
        self._file, self._original = file, original or file
        with self._named_failures():
            self._functions = StudentFunctions(file, seed=seed, level=highest_level_up_to(max(Level)))

    def __call__(self, transition: Transition) -> Array:
        """(n,) rewards of n worlds."""
        return self._call(REWARD_FUNCTION, transition, self._names)

    def metrics(self, transition: Transition) -> dict[str, Array]:
        """(n,) each: the file's metrics by name."""
        return {
            name: self._call(METRIC_PREFIX + name, transition, parameters)
            for name, parameters in self._metrics.items()
        }

    def _call(self, function: str, transition: Transition, parameters: Sequence[str]) -> Array:
        with self._named_failures():
            return call_reward(self._functions, function, transition, parameters)

    @contextmanager
    def _named_failures(self) -> Iterator[None]:
        """Lets a failure name the student's file by its whole path: that of a copy means nothing to the student."""
        try:
            yield
        except StudentCodeError as error:
            failure = error.failure
            is_elsewhere = failure.file not in (None, self._file.name)
            if is_elsewhere or failure.kind is FailureKind.CONFINEMENT:  # that is the machine's fault
                raise
            raise StudentCodeError(replace(failure, file=str(self._original))) from None

    def close(self) -> None:
        self._functions.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def call_reward(
    functions: StudentFunctions, name: str, transition: Transition, parameters: Sequence[str]
) -> Array:
    """Returns (n,) values of a reward or metric for n transitions, each finite and at most ``LARGEST_REWARD`` in magnitude.

    Raises StudentCodeError when the student's code fails, or returns something else.
    """
    values = np.frombuffer(functions.call_columns(name, reward_columns(transition, parameters)))
    largest = values[np.argmax(np.abs(values))] if len(values) else 0.0
    if abs(largest) > LARGEST_REWARD:
        raise StudentCodeError(
            Failure(
                FailureKind.EXCEPTION,
                f"{name}() returned {largest:.3g} for a step. It may return {-LARGEST_REWARD:g} to {LARGEST_REWARD:g}.",
                functions.file.name,
            )
        )
    return values


def reward_columns(transition: Transition, names: Sequence[str]) -> dict[str, Sequence[Any] | Array]:
    """Returns the arguments of a reward with these parameters: one column each, with a value for every world."""
    return {name: _field_values(transition, name) for name in names}


def _field_values(transition: Transition, name: str) -> Sequence[Any] | Array:
    """(n,) one value for each world, or a list of n lists; the axis of the robots is left out where there is one."""
    count = len(transition.step)
    value = np.asarray(getattr(transition, name))
    if value.ndim == 0:
        return np.full(count, value)
    robots = transition.pose.shape[-2]
    if robots == 1 and name in FIELDS_PER_ROBOT:
        value = value[:, 0]
    return value if value.ndim == 1 else value.tolist()


FIELDS_PER_ROBOT = frozenset(TRANSITION_FIELDS) - {
    "case",
    "step",
    "max_steps",
    "target",
    "collided",
    "reached",
    "timed_out",
    "ended",
    "adjacent",
    "abreast",
    "achieved",
    "previous_achieved",
    "target_heading",
    "crashed",
    "collision_ends",
}
"""Facts that every robot has its own of."""
