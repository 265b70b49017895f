"""The lessons' learners with the student's own lines in place of the kit's: what the exercises asked for learns the floor.

A learner calls its lines again and again, in the student's process (``StudentLines``). Each answer is kept, so that the same
learner can be watched afterwards without that process (``KeptLines``): it has the same seed, and gets the same answers.
"""

from __future__ import annotations

import math
import time
from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any, Final, Protocol, Self

import numpy as np

from kit.arrays import BoolArray, FloatArray, IntArray
from kit.host.sandbox.sandbox_config import Level
from kit.host.student_functions import StudentFunctions
from kit.learning.grid.chances import softmax
from kit.learning.grid.dqn import DqnLearner, ReplayedStep
from kit.learning.grid.grid_learner import GridLearner, GridLearnerSettings
from kit.learning.grid.grid_world import MOVE_NAMES, GridCell, GridWorld
from kit.learning.grid.ppo import GAE_LAMBDA, PpoLearner
from kit.learning.grid.q_learning import QLearner
from kit.plain_text import quoted

LIMIT_S: Final = 60.0
"""Wall clock of everything that the student's lines do in one film [s]."""
SLOPE_STEP: Final = 1e-4
"""Step of a slope that is found by trying: on a logarithm, or on a score."""


class OwnLinesError(Exception):
    """The student's lines returned something that nothing can be learned from, or take too long; the message says what."""


class Lines(Protocol):
    """The functions of one or more files by their names."""

    def call(self, name: str, **arguments: Any) -> Any:
        """What the function returns: plain data."""

    def call_all(self, name: str, columns: Mapping[str, Any]) -> list[float]:
        """The numbers that it returns for each record of these columns."""


@dataclass(frozen=True, slots=True)
class KeptLines:
    """Answers that were given, in the order of the calls."""

    answers: tuple[Any, ...]

    def opened(self) -> Lines:
        """A copy that gives the kept answers again from the first one."""
        return _Answering(self.answers)


class _Answering:
    def __init__(self, answers: Sequence[Any]) -> None:
        self._answers = iter(answers)

    def call(self, name: str, **arguments: Any) -> Any:
        return next(self._answers)

    def call_all(self, name: str, columns: Mapping[str, Any]) -> list[float]:
        found: list[float] = next(self._answers)
        return found


class StudentLines:
    """The functions of the student's files, in a process for each file. Leaving the context ends them. All of it raises
    StudentCodeError; a call that comes after ``LIMIT_S`` raises OwnLinesError."""

    def __init__(self, files: Sequence[Path], level: Level) -> None:
        self._processes = ExitStack()
        self._functions: dict[str, StudentFunctions] = {}
        self._answers: list[Any] = []
        self._newest: dict[str, Any] = {}
        self._ends_at = time.monotonic() + LIMIT_S
        with ExitStack() as opened:
            for file in files:
                functions = opened.enter_context(StudentFunctions(file, level=level))
                self._functions |= dict.fromkeys(functions.names, functions)
            self._processes = opened.pop_all()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._processes.close()

    def call(self, name: str, **arguments: Any) -> Any:
        return self._keep_answer(name, self._functions_with(name).call_json(name, arguments))

    def call_all(self, name: str, columns: Mapping[str, Any]) -> list[float]:
        return list(self._keep_answer(name, list(self._functions_with(name).call_columns(name, columns))))

    def kept_lines(self) -> KeptLines:
        """All answers so far."""
        return KeptLines(tuple(self._answers))

    def _functions_with(self, name: str) -> StudentFunctions:
        if time.monotonic() > self._ends_at:
            raise OwnLinesError(
                f"Your lines need more than {LIMIT_S:g} s to learn the floor. Which of them is slow?"
            )
        if name not in self._functions:
            raise OwnLinesError(f"There is no function {quoted(name)} any more in your files.")
        return self._functions[name]

    def _keep_answer(self, name: str, answer: Any) -> Any:
        if answer == self._newest.get(name):  # most copies of a network's weights are the one before
            answer = self._newest[name]
        self._newest[name] = answer
        self._answers.append(answer)
        return answer


class OwnQLearner(QLearner):
    """Q-learning by the student's ``choose`` and ``update``."""

    def __init__(self, world: GridWorld, settings: GridLearnerSettings, lines: Lines) -> None:
        self._lines = lines
        super().__init__(world, settings)

    def choose(self, cell: GridCell) -> int:
        move = self._lines.call(
            "choose",
            values=self.values[cell].tolist(),
            epsilon=self.settings.epsilon,
            drawn=float(self.rng.random()),
            any_move=int(self.rng.integers(len(MOVE_NAMES))),
        )
        if move not in range(len(MOVE_NAMES)):  # 2.0 is 2, as numbers come over the pipe
            raise OwnLinesError(
                f"choose() returned {move!r}; a move is a number from 0 to {len(MOVE_NAMES) - 1}."
            )
        return int(move)

    def learn(
        self, cell: GridCell, move: int, reward: float, reached: GridCell, next_move: int, terminated: bool
    ) -> float:
        before = float(self.values[cell][move])
        table = self._lines.call(
            "update",
            table=self.values.reshape(-1, len(MOVE_NAMES)).tolist(),
            cell=self.world.number_of(cell),
            move=move,
            reward=reward,
            next_cell=self.world.number_of(reached),
            terminated=terminated,
            alpha=self.settings.alpha,
            gamma=self.settings.gamma,
        )
        self.values = numbers_of(
            table, "update", (self.values.size // len(MOVE_NAMES), len(MOVE_NAMES))
        ).reshape(self.values.shape)
        return before + (float(self.values[cell][move]) - before) / self.settings.alpha


class OwnDqnLearner(DqnLearner):
    """A deep Q-network with the student's ``store``, ``targets`` and ``synced`` around the kit's network."""

    def __init__(self, world: GridWorld, settings: GridLearnerSettings, lines: Lines) -> None:
        self._lines = lines
        self._steps: list[ReplayedStep] = []
        self._stored: list[int] = []
        """What the student's buffer holds: numbers of steps."""
        super().__init__(world, settings)

    def store(self, step: ReplayedStep) -> None:
        self._steps.append(step)
        stored = self._lines.call(
            "store", buffer=self._stored, step=len(self._steps) - 1, capacity=self.settings.replay
        )
        if not isinstance(stored, list) or not stored or not set(stored) <= set(range(len(self._steps))):
            raise OwnLinesError("store() did not return a list of steps that it was given.")
        self._stored = [int(number) for number in stored]
        self._replay = [self._steps[number] for number in self._stored]

    def targets(self, steps: list[ReplayedStep]) -> FloatArray:
        found = self._lines.call(
            "targets",
            batch=[[each.reward, each.terminated] for each in steps],
            next_values=self.next_values(steps).tolist(),
            gamma=self.settings.gamma,
        )
        return numbers_of(found, "targets", (len(steps),))

    def synchronise(self) -> None:
        shapes = [each.shape for each in self.target_parameters]
        online = np.concatenate([each.ravel() for each in self.network.parameters])
        target = np.concatenate([each.ravel() for each in self.target_parameters])
        found = self._lines.call(
            "synced",
            target=target.tolist(),
            online=online.tolist(),
            updates=self.updates + 1,
            interval=self.settings.target_interval,
        )
        weights, at = numbers_of(found, "synced", target.shape), 0
        for number, shape in enumerate(shapes):
            size = math.prod(shape)
            self.target_parameters[number] = weights[at : at + size].reshape(shape)
            at += size


class OwnPpoLearner(PpoLearner):
    """Proximal policy optimisation by the student's ``errors``, ``advantages``, ``objective`` and ``entropy``. How the last two
    change with a chance is found by trying it a little larger and a little smaller."""

    def __init__(self, world: GridWorld, settings: GridLearnerSettings, lines: Lines) -> None:
        self._lines = lines
        super().__init__(world, settings)

    def advantages(
        self,
        rewards: FloatArray,
        values: FloatArray,
        next_values: FloatArray,
        terminated: BoolArray,
        ended: BoolArray,
    ) -> FloatArray:
        gamma, found = self.settings.gamma, np.zeros_like(rewards)
        for column in range(rewards.shape[1]):
            errors = self._lines.call(
                "errors",
                rewards=rewards[:, column].tolist(),
                values=values[:, column].tolist(),
                next_values=next_values[:, column].tolist(),
                terminated=terminated[:, column].tolist(),
                gamma=gamma,
            )
            deltas = numbers_of(errors, "errors", (len(rewards),)).tolist()
            made = self._lines.call(
                "advantages", deltas=deltas, ended=ended[:, column].tolist(), gamma=gamma, lam=GAE_LAMBDA
            )
            found[:, column] = numbers_of(made, "advantages", (len(rewards),))
        return found

    def objective_slope(self, now: FloatArray, then: FloatArray, weights: FloatArray) -> FloatArray:
        count = len(now)
        tried = np.concatenate([now * (1 + SLOPE_STEP), now * (1 - SLOPE_STEP)])
        found: FloatArray = np.array(
            self._lines.call_all(
                "objective",
                {
                    "now": tried,
                    "then": np.tile(then, 2),
                    "advantage": np.tile(weights, 2),
                    "clip": np.full(2 * count, self.settings.clip),
                },
            )
        )
        slope: FloatArray = (found[:count] - found[count:]) / (2 * SLOPE_STEP)
        return slope

    def entropy_slope(self, cells: IntArray) -> FloatArray:
        seen, places = np.unique(cells, return_inverse=True)
        steps = SLOPE_STEP * np.concatenate([np.eye(len(MOVE_NAMES)), -np.eye(len(MOVE_NAMES))])
        tried = softmax((self.logits[seen][:, None, :] + steps).reshape(-1, len(MOVE_NAMES)))
        found = np.array(self._lines.call_all("entropy", {"chances": tried.tolist()}))
        more, less = np.split(found.reshape(len(seen), -1), 2, axis=1)
        slope: FloatArray = ((more - less) / (2 * SLOPE_STEP))[places.ravel()]
        return slope


OWN_LEARNERS: Final[Mapping[str, Any]] = MappingProxyType(
    {learner.algorithm: learner for learner in (OwnQLearner, OwnDqnLearner, OwnPpoLearner)}
)


def make_own_learner(world: GridWorld, settings: GridLearnerSettings, lines: Lines) -> GridLearner:
    """The learner of the settings' algorithm, made of these lines. Raises as they do, and OwnLinesError."""
    learner: GridLearner = OWN_LEARNERS[settings.algorithm](world, settings, lines)
    return learner


def numbers_of(answer: Any, name: str, shape: tuple[int, ...]) -> FloatArray:
    """What a function returned as an array of this shape. Raises OwnLinesError."""
    try:
        found = np.array(answer, dtype=float)
    except (TypeError, ValueError):
        found = np.array(math.nan)
    if found.shape != shape or not np.isfinite(found).all():
        wanted = " x ".join(map(str, shape))
        raise OwnLinesError(f"{name}() did not return {wanted} finite numbers.")
    return found
