"""Evidence about a reward: its value for every transition of the model, and what is best under it."""

from __future__ import annotations

from functools import cached_property
from pathlib import Path
from typing import Any, Final

import numpy as np

from grader.assignment import Assignment
from grader.evidence.submission_clock import SubmissionClock
from grader.kinds.reward.behaviours import (
    BehaviourComparison,
    LoopComparison,
    compare_approaches,
    compare_behaviours,
    compare_loops,
    discounted_return,
)
from grader.kinds.reward.exploit_recording import save_exploit
from grader.kinds.reward.mirrored_cases import MIRRORED_MOVES, mirrored, rotated
from grader.kinds.reward.optimal_policy import (
    OptimalPolicy,
    OptimalPolicyScore,
    draw_path,
    evaluate_policy,
    rollout,
    value_iteration,
)
from grader.kinds.reward.reward_training import RewardTrainingParams, mean_success
from grader.kinds.reward.task_model import LAST_MOVES, LEFT, RIGHT, GridModel, build_model
from grader.kinds.reward.transitions import MODEL_FACTS, TransitionBatch, to_transition
from grader.submitted_files import reading_submission
from kit.arrays import FloatArray, IntArray
from kit.host.failure import Failure, FailureKind, StudentCodeError
from kit.host.sandbox.sandbox_config import Level
from kit.host.student_functions import StudentFunctions
from kit.host.wire import printable
from kit.learning.tasks.student_reward import REWARD_FUNCTION, RewardFileError, call_reward, reward_parameters
from kit.learning.tasks.transition import Transition
from kit.plain_text import counted, suggestion

MIRRORED_MOVES[[LEFT, RIGHT]] = RIGHT, LEFT

SHUFFLE: Final = 1234
"""Seed of the order in which the transitions are evaluated a second time."""

MAX_SAMPLES: Final = 4000
"""Transitions on which the mirrored and the rotated task are compared."""


class RewardEvidence:
    """One reward function, and what is computed from its values."""

    label = "the reward"
    secret = False

    def __init__(
        self, file: Path, assignment: Assignment, level: Level, clock: SubmissionClock | None = None
    ) -> None:
        self._clock = clock or SubmissionClock()
        self._interruptions: dict[str, Failure] = {}
        """How the reward failed when a check called it again, by check."""
        self.model: GridModel = build_model(assignment.task)
        self.level = level
        self.failure: Failure | None = None
        self.printed: tuple[str, ...] = ()
        self.steps = 0
        self._file = file
        self._folder = assignment.folder
        self._limits = assignment.limits
        self._names: tuple[str, ...] = ()
        self._successes: dict[RewardTrainingParams, float] = {}
        try:
            self._names = read_parameter_names(file)
            self.rewards: FloatArray = self._evaluate_all(TransitionBatch.all(self.model)).reshape(
                self.model.states, -1
            )
        except StudentCodeError as error:
            self.failure = self._clock.explain(error.failure)

    @property
    def outcome(self) -> str:
        return "examined" if self.failure is None else f"stopped ({self.failure.kind.value})"

    @cached_property
    def policy(self) -> OptimalPolicy:
        return value_iteration(self.model, self.rewards, self._clock.check)

    @cached_property
    def plan_outcome(self) -> OptimalPolicyScore:
        return evaluate_policy(self.policy, self._clock.check)

    @cached_property
    def is_pure(self) -> bool:
        """True if the same transitions give bit-equal rewards in another order and in a fresh process."""
        steps = TransitionBatch.all(self.model)
        order = np.random.default_rng(SHUFFLE).permutation(len(steps))
        shuffled = steps.at(order)
        try:
            with self._open() as functions:
                first = self._call(functions, shuffled)
                second = self._call(functions, steps)
        except StudentCodeError as error:
            self._interruptions["pure"] = self._clock.explain(error.failure)
            return False
        known = self.rewards.reshape(-1)
        return bool(np.array_equal(first, known[order]) and np.array_equal(second, known))

    @cached_property
    def symmetry(self) -> float:
        """The share of transitions whose reward stays the same when the whole task is mirrored and when it is turned."""
        everything = TransitionBatch.all(self.model)
        # In the target's centre there is no direction to the target.
        elsewhere = np.flatnonzero(
            ~everything.reached & (self.model.cell_of(everything.states) != self.model.target)
        )
        sampled = np.random.default_rng(SHUFFLE).permutation(elsewhere)[:MAX_SAMPLES]
        sample = everything.at(sampled)
        known = self.rewards.reshape(-1)[sampled]
        same = np.ones(len(sample), dtype=np.bool_)
        transforms: tuple[TransitionBatch, ...] = (mirrored(sample), rotated(sample))
        try:
            with self._open() as functions:
                for transformed in transforms:
                    same &= np.isclose(self._call(functions, transformed), known, rtol=1e-6, atol=1e-9)
        except StudentCodeError as error:
            self._interruptions["symmetric"] = self._clock.explain(error.failure)
            return 0.0
        return float(same.mean())

    @cached_property
    def behaviours(self) -> tuple[BehaviourComparison, ...]:
        """Comparisons of good and bad behaviours by their returns."""
        return compare_behaviours(self.model, self.rewards, self._clock.check)

    @cached_property
    def approaches(self) -> tuple[BehaviourComparison, ...]:
        """Comparisons of drives of equal length, none of which arrives."""
        return compare_approaches(self.model, self.rewards, self._clock.check)

    @cached_property
    def loops(self) -> tuple[LoopComparison, ...]:
        return compare_loops(self.model, self.rewards, self._clock.check)

    def success_after_training(self, budget: RewardTrainingParams) -> float:
        """Returns the success of robots trained with this reward; 0 if the reward fails during training."""
        if budget not in self._successes:
            try:
                with self._open() as functions:
                    self._successes[budget] = mean_success(
                        lambda each: self._rewards_of(functions, each), budget, self._clock, self._folder
                    )
            except StudentCodeError as error:
                self._interruptions["trained"] = self._clock.explain(error.failure)
                self._successes[budget] = 0.0
        return self._successes[budget]

    def explain(self, check: str, params: Any = None) -> str:
        """Explains the first comparison that a check counts as wrong, or how the reward failed during a check."""
        if check in self._interruptions:
            return f"But {self._interruptions[check]}"
        if check in ("ordered", "shaped"):
            pairs = self.behaviours if check == "ordered" else self.approaches
            wrong = next((pair for pair in pairs if not pair.is_ordered), None)
            return "" if wrong is None else str(wrong)
        if check == "loops":
            profitable = next((loop for loop in self.loops if loop.is_profitable), None)
            return "" if profitable is None else str(profitable)
        return self._explain_exploit() if check == "planned" else ""

    def _explain_exploit(self) -> str:
        """Says how the optimal behaviour ends that misses the target."""
        states = self._exploit
        if states is None:
            return ""
        if self.model.hit[states[-2], states[-1] % LAST_MOVES]:
            return (
                f"It drives into a wall after {counted(len(states) - 1, 'move')}: with this reward, that ends an episode better "
                "than driving on does."
            )
        return f"It drives until the {len(states) - 1} moves of an episode are used up: that pays more than arriving."

    def picture(self, check: str = "") -> str:
        """Draws the optimal behaviour under this reward, and says its return, if it misses the target."""
        states = self._exploit
        if states is None:
            return ""
        moves = tuple((states[1:] % LAST_MOVES).tolist())
        paid = discounted_return(self.model, self.policy.rewards, int(states[0]), moves)
        return f"{draw_path(self.model, states)}\nYour reward pays {paid:.4g} for it in all."

    def replay_title(self) -> str:
        return "" if self._exploit is None else "What a robot does that has learnt this reward perfectly"

    def save_replay(self, file: Path) -> bool:
        """Saves what ``picture`` shows as a recording, with its world beside it. Raises OSError."""
        assert self._exploit is not None, "there is no picture"
        save_exploit(self.model, self._exploit, file)
        return False

    @cached_property
    def _exploit(self) -> IntArray | None:
        """The states of the optimal behaviour, if it misses the target."""
        try:
            if self.failure is not None or self.plan_outcome.exploit_start is None:
                return None
        except StudentCodeError:  # the time is used up
            return None
        return rollout(self.policy, self.plan_outcome.exploit_start, self.model.task.max_steps)

    def _evaluate_all(self, steps: TransitionBatch) -> FloatArray:
        with self._open() as functions:
            try:
                return self._call(functions, steps)
            finally:
                self.printed = tuple(printable(line.text) for line in functions.take_output().lines)

    def _open(self) -> StudentFunctions:
        self._clock.check()
        return StudentFunctions(self._file, limits=self._clock.shorten(self._limits), level=self.level)

    def _call(self, functions: StudentFunctions, steps: TransitionBatch) -> FloatArray:
        self.steps += len(steps)
        return self._rewards_of(functions, to_transition(steps))

    def _rewards_of(self, functions: StudentFunctions, step: Transition) -> FloatArray:
        """Returns (n,) rewards of the student's function for n transitions."""
        rewards: FloatArray = call_reward(functions, REWARD_FUNCTION, step, self._names)
        return rewards


def read_parameter_names(file: Path) -> tuple[str, ...]:
    """Returns the names of the reward function's parameters. The file is read, never run. Raises StudentCodeError."""
    try:
        with reading_submission(file.name, RewardFileError):
            names = reward_parameters(file)
    except RewardFileError as error:
        # The path of the temporary copy means nothing to the student.
        message = str(error).replace(f"{file}", file.name)
        raise StudentCodeError(Failure(FailureKind.IMPORT, printable(message))) from None
    unknown = [name for name in names if name not in MODEL_FACTS]
    if unknown:
        message = f"{file.name}: {REWARD_FUNCTION}() asks for {unknown[0]}, which this task does not have: {suggestion(unknown[0], MODEL_FACTS)}"
        raise StudentCodeError(Failure(FailureKind.IMPORT, message))
    return names
