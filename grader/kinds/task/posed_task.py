"""Measures a task that a student posed: its places, its reward, and the result of a short training.

No program of the student's runs. Everything is worked out when a check first asks for it, in the process of
``posed_task_child``.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import permutations
from pathlib import Path
from statistics import median_low
from typing import Final

import numpy as np

from grader.evidence.submission_clock import SubmissionClock
from grader.evidence.training_results import (
    CaseOrder,
    PosedTaskPlan,
    StopRule,
    TrainingBudget,
    TrainingResults,
    TrainingSettings,
)
from grader.kinds.policy.kind import load_submitted_policy
from grader.kinds.task.task_process import PosedMeasure
from grader.kinds.training.trainings import run_trainings
from kit.learning.environment.batch import BatchEnv
from kit.learning.environment.episode_stats import EpisodeStats
from kit.learning.policies.confidence_intervals import lower_bound
from kit.learning.policies.evaluation import EvaluationResult, Evaluator
from kit.learning.policies.policy import Policy, PolicyError
from kit.learning.policies.seeds import derive_seed
from kit.learning.tasks.actions import DiscreteActions
from kit.learning.tasks.learning_task import LearningTask
from kit.learning.tasks.task_case import EpisodePlaces, TaskCase
from kit.learning.tasks.task_spec import TaskSpec
from kit.learning.training.algorithm_settings import LinearSchedule
from kit.learning.training.algorithms import find_algorithm
from kit.learning.training.presets import find_preset
from kit.learning.training.tabular import table_rows
from kit.learning.training.training import make_learner
from kit.plain_files import is_file_there
from kit.plain_text import counted

TEACHING_REWARD: Final = "progress"
"""The kit's reward by which a robot is taught to arrive, to see what its drives earn by the task's own reward."""
REPEATS: Final = (1, 5, 15)
"""Numbers of steps for which each action of a loop is repeated."""
STRETCH: Final = 0.75
"""The share of the free way ahead that a robot drives up and down."""
LoopPlan = tuple[tuple[int, int], ...]
"""The actions of a loop, each with the number of steps for which it is kept up."""
TEACHERS: Final = 4
"""Most robots that are trained, one after the other, until one arrives."""
DRIVE_COUNT: Final = 32
"""Drives whose mean return is that of arriving."""
TABLE_EDGES: Final = (0.2,)
"""Between the bins of the tables that learn a task."""
SAME_PLACE: Final = 0.5
"""A start that is no farther from a target is at the same place [m]."""
TESTS: Final = 6
"""Tests during a training."""


@dataclass(frozen=True, slots=True)
class ActionLoop:
    """What a robot earns that repeats a few actions until time is up, or it meets a wall."""

    actions: tuple[str, ...]
    repeats: tuple[int, ...]
    """Steps for which each action is kept up."""
    total_reward: float
    is_arriving: bool
    steps: int = 0
    """For which it went on."""

    def __str__(self) -> str:
        if len(self.actions) == 1:
            return f"only {self.actions[0]}"
        if len(set(self.repeats)) > 1:
            parts = (
                f"{name} for {counted(count, 'step')}"
                for name, count in zip(self.actions, self.repeats, strict=True)
            )
            return f"{' and '.join(parts)}, again and again"
        steps = "one step" if self.repeats[0] == 1 else f"{self.repeats[0]} steps"
        return f"{' and '.join(self.actions)}, {steps} each, again and again"


class PosedTask:
    """A task that can be read, and everything that checks measure about it."""

    def __init__(self, file: Path, plan: PosedTaskPlan, seed: int, clock: SubmissionClock) -> None:
        self.plan = plan
        self.choice = TaskSpec(str(file))
        self.task: LearningTask = self.choice.resolve()
        self.cases = tuple(case for _, case in self.task.map_cases())
        self._folder = file.parent
        self._seed = seed
        self._clock = clock

    @cached_property
    def ways(self) -> tuple[float, ...]:
        """The length of the way from start to target, for each case [m]."""
        numbers = np.arange(len(self.cases))
        batch = BatchEnv(self.task, len(numbers), self._seed, autoreset=False)
        batch.reset(cases=numbers)
        return tuple(float(each) for each in batch.state.to_go[:, 0])

    @cached_property
    def arriving_reward(self) -> float:
        """The mean return of drives that arrive; NaN if no robot that was well taught does."""
        for number in range(TEACHERS):
            found = self._mean_of_arriving(self._taught_policy(number))
            if not math.isnan(found):
                return found
        return math.nan

    def _mean_of_arriving(self, teacher: Policy) -> float:
        batch = BatchEnv(self.task, DRIVE_COUNT, derive_seed(self._seed, "drives"), autoreset=False)
        player = teacher.make_player(DRIVE_COUNT)
        earned, running = np.zeros(DRIVE_COUNT), np.ones(DRIVE_COUNT, dtype=np.bool_)
        reached = np.zeros(DRIVE_COUNT, dtype=np.bool_)
        observations, fresh = batch.reset(), np.ones(DRIVE_COUNT, dtype=np.bool_)
        while running.any():
            self._clock.check()
            step = batch.step(player.act(observations, fresh))
            earned += np.where(running, step.rewards, 0.0)
            reached |= running & step.ended & step.transition.reached
            running &= ~step.ended
            observations, fresh = step.observations, np.zeros(DRIVE_COUNT, dtype=np.bool_)
        return float(earned[reached].mean()) if reached.any() else math.nan

    @cached_property
    def loops(self) -> tuple[ActionLoop, ...]:
        """Every action alone, every two in turn, and up and down the way ahead, each driven once from the first case's start."""
        assert isinstance(self.task.actions, DiscreteActions)  # others are refused before
        actions = range(len(self.task.actions.names))
        alone: list[LoopPlan] = [((number, 1),) for number in actions]
        pairs: list[LoopPlan] = [
            tuple((number, repeats) for number in pair)
            for repeats in REPEATS
            for pair in permutations(actions, 2)
        ]
        driven = self._drive_loops([*alone, *pairs])
        return (*driven, *self._drive_loops([*self._back_and_forth_plans(driven[: len(alone)])]))

    def _back_and_forth_plans(self, alone: Sequence[ActionLoop]) -> Iterator[LoopPlan]:
        """Yields plans that drive straight ahead or back, turn round, and so on. ``alone``: how each action went by itself."""
        assert isinstance(self.task.actions, DiscreteActions)  # as above
        twists = self.task.actions.twist_table
        longest = self.task.max_steps // 4
        for straight, (speed, turn) in enumerate(twists):
            if not speed or turn:
                continue
            stretch = max(1, min(longest, int(STRETCH * alone[straight].steps)))
            for turning, (speed, turn) in enumerate(twists):
                half_turn = 0 if speed or not turn else round(math.pi / abs(turn) / self.task.step_time)
                if half_turn:
                    yield (straight, stretch), (turning, half_turn)

    def _drive_loops(self, plans: Sequence[LoopPlan]) -> tuple[ActionLoop, ...]:
        if not plans:
            return ()
        assert isinstance(self.task.actions, DiscreteActions)  # as above
        names = self.task.actions.names
        numbers = [[number for number, count in plan for _ in range(count)] for plan in plans]
        batch = BatchEnv(self.task, len(plans), derive_seed(self._seed, "loops"), autoreset=False)
        batch.reset(cases=np.zeros(len(plans), dtype=np.int64))
        earned, running = np.zeros(len(plans)), np.ones(len(plans), dtype=np.bool_)
        reached, lasted = np.zeros(len(plans), dtype=np.bool_), np.zeros(len(plans), dtype=np.int64)
        step_number = 0
        while running.any():
            self._clock.check()
            step = batch.step(np.array([each[step_number % len(each)] for each in numbers], dtype=np.int64))
            earned += np.where(running, step.rewards, 0.0)
            lasted += running
            reached |= running & step.ended & step.transition.reached
            running &= ~step.ended
            step_number += 1
        return tuple(
            ActionLoop(
                tuple(names[number] for number, _ in plan),
                tuple(count for _, count in plan),
                float(total),
                bool(arrived),
                int(steps),
            )
            for plan, total, arrived, steps in zip(plans, earned, reached, lasted, strict=True)
        )

    @cached_property
    def paying_loops(self) -> tuple[ActionLoop, ...]:
        """Loops that do not arrive and yet earn as much as a drive that does, the best first."""
        found = [
            each
            for each in self.loops
            # Not "as much or more": of a sum without a value, inf - inf, neither is true.
            if not (each.is_arriving or each.total_reward < self.arriving_reward)
        ]
        return tuple(sorted(found, key=lambda each: -each.total_reward))

    @cached_property
    def results(self) -> TrainingResults:
        """Trainings with the task's own reward, and their tests."""
        plan, names = self.plan, tuple(case.name for case in self.cases)
        seeds = tuple(derive_seed(self._seed, "posed", number) for number in range(plan.trainings))
        budget = TrainingBudget(self.choice, names, (plan.algorithm,), plan.steps, seeds, (), plan.episodes)
        settings = TrainingSettings(
            algorithm=plan.algorithm,
            learning_rate=LinearSchedule(0.2, 0.02),
            exploration=LinearSchedule(0.3, 0.02),
            discount=0.99,
            edges=TABLE_EDGES,
            worlds=16,
            train_on=names,
            order=CaseOrder.MIXED,
            batch=max(500, plan.steps // TESTS),
            test_episodes=20 * len(names),
            stop=StopRule.NEVER,
            goal=0.9,
            keeps_best=True,
            steps=plan.steps,
        )
        return run_trainings(settings, budget, seeds, self._clock, plan.enough)

    @cached_property
    def policy_test(self) -> EvaluationResult | str:
        """The test of the policy that was handed in with the task; what is wrong with it where it cannot be tested."""
        file = self._folder / self.plan.policy
        if not is_file_there(file):
            return f"There is no {self.plan.policy} beside the task: train it, and copy the run's best.npz there."
        try:
            policy = load_submitted_policy(file)
            policy.check_fits(self.task)
        except (PolicyError, OSError, RecursionError, OverflowError, MemoryError) as error:
            return str(error).replace(f"{self._folder}/", "")
        return Evaluator(self.task).test(
            policy, self.plan.episodes, derive_seed(self._seed, "policy"), before_step=self._clock.check
        )

    def shortest_seconds(self) -> float:
        """How long the longest way takes at the highest speed that the actions have [s]."""
        actions = self.task.actions
        assert isinstance(actions, DiscreteActions)
        return max(self.ways) / max(1e-9, max(abs(forward) for forward, _ in actions.twist_table))

    def measure(self, check: str, params: Mapping[str, str]) -> PosedMeasure:
        """Measures what a check of the kind ``task`` asks for, by its name and parameters."""
        return {
            "places": self._measure_places,
            "way": lambda params: PosedMeasure(min(self.ways)),
            "returns": self._measure_returns,
            "loops": self._measure_loops,
            "learns": self._measure_learning,
            "arrives": self._measure_arriving,
            "quick": self._measure_time_ratio,
        }[check](params)

    def _measure_places(self, params: Mapping[str, str]) -> PosedMeasure:
        found = [list(_misplaced_places(case, params)) for case in self.cases]
        share = sum(not each for each in found) / len(found)
        return PosedMeasure(share, next((text for each in found for text in each), ""))

    def _measure_returns(self, params: Mapping[str, str]) -> PosedMeasure:
        lonely = [
            case.name for case in self.cases if not any(_leads_back(case, other) for other in self.cases)
        ]
        text = f"No case leads back from the target of {lonely[0]} to its start." if lonely else ""
        return PosedMeasure(1.0 - len(lonely) / len(self.cases), text)

    def _measure_loops(self, params: Mapping[str, str]) -> PosedMeasure:
        if math.isnan(self.arriving_reward):
            return PosedMeasure(
                0.0,
                "A robot that was taught by the kit's own reward never arrived, so there is nothing to compare with: does "
                "it see enough, can it turn, is there time enough?",
            )
        if not self.paying_loops:
            return PosedMeasure(1.0)
        best = self.paying_loops[0]
        return PosedMeasure(
            1.0 - len(self.paying_loops) / len(self.loops),
            f"The best of them: {best}. It earns {best.total_reward:.4g} and never arrives; who arrives earns "
            f"{self.arriving_reward:.4g}.",
        )

    def _measure_learning(self, params: Mapping[str, str]) -> PosedMeasure:
        middle = median_low(training.sure_success for training in self.results.trainings)
        shares = ", ".join(f"{training.accuracy:.2f}" for training in self.results.trainings)
        inputs = int(self.task.observation.space(self.task.robots).shape[0])
        rows = table_rows(inputs, len(TABLE_EDGES) + 1)
        sees = (
            f"It sees {counted(inputs, 'number')}, so its table has {counted(rows, 'row')} to fill: fewer are learned sooner; "
            "with too few, places look alike that ask for different actions."
        )
        return PosedMeasure(middle, f"The exams of its trainings: {shares}. {sees}", self.results.picture())

    def _measure_arriving(self, params: Mapping[str, str]) -> PosedMeasure:
        if isinstance(self.policy_test, str):
            return PosedMeasure(0.0, self.policy_test)
        cases = self.policy_test.cases
        share = lower_bound(sum(case.reached for case in cases), sum(case.episodes for case in cases))
        return PosedMeasure(share, _worst_case(self.policy_test))

    def _measure_time_ratio(self, params: Mapping[str, str]) -> PosedMeasure:
        if isinstance(self.policy_test, str):
            return PosedMeasure(math.nan, self.policy_test)
        steps = [case.steps for case in self.policy_test.cases if case.reached]
        ratio = max(steps) * self.task.step_time / self.shortest_seconds() if steps else math.nan
        return PosedMeasure(ratio, _worst_case(self.policy_test))

    def _taught_policy(self, number: int) -> Policy:
        """A robot that was taught the task by the kit's own reward."""
        choice = replace(self.choice, reward=TEACHING_REWARD, scale=None)
        task, algorithm = choice.resolve(), find_algorithm(self.plan.algorithm)
        preset = find_preset("kit", algorithm, task.preset, is_continuous=False)
        learner = make_learner(
            algorithm, preset, choice, task, seed=derive_seed(self._seed, "teacher", number)
        )
        learner.learn(self.plan.steps, _ClockedTraining(self._clock))
        return learner.policy()


def _worst_case(test: EvaluationResult) -> str:
    worst = test.worst
    return f"The worst case is {worst.case}, reached {worst.reached} times in {worst.episodes}."


def _leads_back(case: TaskCase, other: TaskCase) -> bool:
    """Whether some start of ``other`` is at a target of ``case``, and some target of it at a start of that."""
    return _shares_a_place(case.targets, other.starts[0]) and _shares_a_place(other.targets, case.starts[0])


def _shares_a_place(one: EpisodePlaces, other: EpisodePlaces) -> bool:
    return any(math.dist(a[:2], b[:2]) <= SAME_PLACE for a in _points_of(one) for b in _points_of(other))


def _points_of(spots: EpisodePlaces) -> list[tuple[float, float]]:
    """The corners of an area, or the places of a list [m, m]."""
    corners = [(spots.area[0], spots.area[1]), (spots.area[2], spots.area[3])] if spots.area else []
    return corners or [(pose.x, pose.y) for pose in spots.poses]


def _misplaced_places(case: TaskCase, params: Mapping[str, str]) -> Iterator[str]:
    """Names the places of a case that lie elsewhere than asked."""
    for name, asked, spots in (
        ("starts", params["start"], case.starts[0]),
        ("target", params["target"], case.targets),
    ):
        if not asked:
            continue
        x1, y1, x2, y2 = (float(number) for number in asked.split())
        for x, y in _points_of(spots):
            if not (x1 <= x <= x2 and y1 <= y <= y2):
                yield f"{case.name}: ({x:g}, {y:g}), one of its {name}, is not between ({x1:g}, {y1:g}) and ({x2:g}, {y2:g})"


class _ClockedTraining:
    """Callbacks of a training that ends when the submission's time is used up."""

    def __init__(self, clock: SubmissionClock) -> None:
        self._clock = clock
        self._updates = 0

    def between_updates(self) -> None:
        self._clock.check()
        self._updates += 1
        if self._updates % 200 == 1:
            self._clock.show_progress("teaching a robot to arrive, to see what its drives earn")

    def on_episode_end(self, episode: EpisodeStats) -> None:
        """No-op: what each episode earns does not matter here."""
