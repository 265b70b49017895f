"""One training, from its configuration to its end: the learner learns, the stopping rule evaluates, the run is written.

Killing this process at any moment loses what was learned since the last checkpoint, and nothing else.
"""

from __future__ import annotations

import errno
import json
import math
import time
import traceback
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import asdict, replace
from importlib.util import find_spec
from pathlib import Path
from typing import Any, cast

import numpy as np

from kit.arrays import FloatArray
from kit.field_types import check_field_types
from kit.host.failure import StudentCodeError
from kit.kernels.compilation_progress import PROGRESS
from kit.learning.environment.batch import BatchEnv, RewardError
from kit.learning.environment.episode_stats import EpisodeOutcome, EpisodeStats
from kit.learning.maps.batch_map import UnsupportedWorld
from kit.learning.policies.evaluation import CaseResult, Evaluator
from kit.learning.policies.policy import Policy, PolicyError
from kit.learning.policies.policy_file import save_policy
from kit.learning.policies.seeds import derive_seed
from kit.learning.tasks.actions import DiscreteActions
from kit.learning.tasks.curriculum import CasePractice, practices
from kit.learning.tasks.learning_task import LearningTask, UnknownTask
from kit.learning.tasks.reward import RewardFunction
from kit.learning.tasks.student_reward import RewardFileError, StudentReward
from kit.learning.tasks.task_spec import TaskSpec
from kit.learning.training.algorithm_settings import LinearSchedule
from kit.learning.training.algorithms import (
    Algorithm,
    UnknownAlgorithm,
    UnsuitableAlgorithm,
    check_suits,
    find_algorithm,
)
from kit.learning.training.checkpoint_file import read_numbers
from kit.learning.training.demonstrations import DemonstrationError
from kit.learning.training.events import (
    Evaluated,
    EventWriter,
    TrainingEnded,
    TrainingNote,
    TrainingProgress,
    TrainingStarted,
)
from kit.learning.training.learn_extra import require_learn_extra, versions
from kit.learning.training.learner import Learner, StopLearning
from kit.learning.training.measures import is_value_too_large, value_warning
from kit.learning.training.presets import Preset, find_preset
from kit.learning.training.run_config import RunConfig, RunError
from kit.learning.training.runs import TrainingRun
from kit.learning.training.stopping_rules import (
    CaseCount,
    CaseCounts,
    StoppingDecision,
    StoppingMemory,
    TrainThenTest,
    TrainUntilGoal,
    TrainUntilSure,
)
from kit.run.recording import RecordingError
from kit.world.problems import WorldError

PROGRESS_S = 0.5
CHECKPOINT_S = 10.0
CONTROL_S = 0.1
"""How often each is done or looked for, at most; between two updates of the learner."""
CHEATED_BELOW = 0.5
"""With less success than this, a student is told what their own reward paid for instead."""
COMPARED_EPISODES = 200
"""The first and the last episodes of a training, whose mean returns are compared then."""


def resolve_preset(config: RunConfig) -> Preset:
    """The configuration's preset, with what the configuration changes in it."""
    task = config.choice.resolve()
    preset = find_preset(
        config.preset,
        find_algorithm(config.algorithm),
        task.preset,
        is_continuous=not isinstance(task.actions, DiscreteActions),
    )
    if config.settings:
        preset = preset.changed(dict(config.settings))
    strategy = preset.stopping_rule
    goal = task.success if config.goal is None else config.goal
    if config.keep_training:
        strategy = TrainThenTest(strategy.test_interval, greedy=strategy.greedy)
    elif goal is not None and isinstance(strategy, TrainUntilGoal | TrainUntilSure):
        strategy = replace(strategy, goal=goal)
    rate = config.learning_rate
    return replace(
        preset,
        stopping_rule=strategy,
        steps=preset.steps if config.steps is None else config.steps,
        worlds=preset.worlds if config.worlds is None else config.worlds,
        mirrored=preset.mirrored or config.mirrored,
        learning_rate=preset.learning_rate if rate is None else LinearSchedule(rate, rate),
    )


def fit_task_spec(choice: TaskSpec, algorithm: Algorithm) -> TaskSpec:
    """The choice, as the algorithm can take it: many choose one number only, so a pair's moves become one.

    UnsuitableAlgorithm where it cannot take it at all.
    """
    actions = choice.resolve().actions
    check_suits(algorithm, is_continuous=not isinstance(actions, DiscreteActions))
    if algorithm.supports_multi_discrete or not isinstance(actions, DiscreteActions) or actions.one_number:
        return choice
    return replace(choice, one_number=True)


def train(run: TrainingRun, *, interrupted: Callable[[], bool] = lambda: False) -> TrainingEnded:
    """Trains the run to its end, or goes on where it was interrupted. Returns how it ended.

    ``interrupted``: asked now and then whether to leave everything as it is, to go on another time; if so, raises
    KeyboardInterrupt. Raises RunError if the run is damaged or busy, or the disk is full, and LearnExtraMissing.
    """
    config = run.config()
    with run.lock(), _full_disk_as_run_error(run), EventWriter(run.events_file) as events:
        try:
            if find_algorithm(config.algorithm).needs_torch:
                require_learn_extra()
            with _student_reward(run, config) as reward, PROGRESS.told_by(_CompilationNotes(events).tell):
                training = _TrainingLoop(run, config, events, reward, interrupted)
                ended = training.run()
        except (
            StudentCodeError,
            RewardError,
            RewardFileError,
            UnknownTask,
            WorldError,
            UnsupportedWorld,
            UnknownAlgorithm,
            UnsuitableAlgorithm,
            DemonstrationError,
            RecordingError,
            PolicyError,
            LearningFailed,
        ) as error:
            ended = _ended_by_failure(run, str(error))
        events.write(ended)
    return ended


class LearningFailed(Exception):
    """The learner's numbers cannot be reckoned with any more; the message says why, and what to do."""


class _CompilationNotes:
    """Says what is compiled, before the first step on a machine."""

    def __init__(self, events: EventWriter) -> None:
        self._events = events
        self._told_at = -math.inf

    def tell(self, text: str) -> None:
        if time.monotonic() - self._told_at >= PROGRESS_S:
            self._events.write(TrainingNote(text, until_progress=True))
            self._told_at = time.monotonic()


def _ended_by_failure(run: TrainingRun, message: str) -> TrainingEnded:
    summary = run.summary()
    return TrainingEnded("failed", summary.steps, summary.seconds, message)


@contextmanager
def _student_reward(run: TrainingRun, config: RunConfig) -> Iterator[RewardFunction | None]:
    """The student's reward, if there is one."""
    if config.reward_file is None:
        yield None
        return
    with StudentReward(run.reward, seed=config.seed, original=Path(config.reward_file)) as reward:
        yield reward


@contextmanager
def _full_disk_as_run_error(run: TrainingRun) -> Iterator[None]:
    """A full disk as a RunError that says what to do."""
    try:
        yield
    except OSError as error:
        if error.errno not in (errno.ENOSPC, errno.EDQUOT):
            raise
        raise RunError(
            f"{run.folder}: the disk is full. The run is intact up to its last checkpoint: free some space, then "
            f"`kit train --resume {run.name}`."
        ) from None


class _StopRequested(StopLearning):
    """The user asked to stop."""


class _TrainingLoop:
    """Watches one learner. Everything here happens between two updates of the learner's policy."""

    def __init__(
        self,
        run: TrainingRun,
        config: RunConfig,
        events: EventWriter,
        reward: RewardFunction | None,
        interrupted: Callable[[], bool],
    ) -> None:
        self._run = run
        self._config = config
        self._events = events
        self._interrupted = interrupted
        self._preset = resolve_preset(config)
        algorithm = find_algorithm(config.algorithm)
        choice = fit_task_spec(config.choice, algorithm)
        self._task = choice.resolve()
        self._evaluator = Evaluator(self._task)
        self._memory = StoppingMemory()
        self._seconds = 0.0
        self._test_count = 0
        self._resumed = 0
        self._evaluated_at, self._next_evaluation = 0, self._preset.stopping_rule.test_interval
        self._best_snapshot: Any = None
        self._first_returns: list[float] = []
        self._last_returns: deque[float] = deque(maxlen=COMPARED_EPISODES)
        self._is_warned = False
        """Whether it has been said that values exceed what rewards can pay."""
        self._success = 1.0
        self._is_sure = False
        self._worst = ("", 0.0)
        """The share that reached the goal in the last test."""
        cases = [(case.name, case.group) for _, case in self._task.map_cases()]
        imitates = algorithm.family == "imitation"  # those who demonstrate choose the cases
        self._practices = () if imitates else practices(self._task.curriculum, cases)
        self._stage = 0
        parts = self._load_checkpoint()
        self._learner = make_learner(
            algorithm,
            self._preset,
            choice,
            self._task,
            seed=derive_seed(config.seed, "training", self._resumed),
            reward=reward,
            tensorboard=_tensorboard_folder(run),
            demonstrations=run.demonstrations(),
        )
        if parts:
            with self._odd_checkpoint_as_run_error():
                self._learner.load(parts)
        self._batch = _ProgressBatch(self._learner.steps)
        self._began = self._control_at = self._checkpoint_at = time.monotonic()

    # From start to end

    def run(self) -> TrainingEnded:
        self._events.write(TrainingStarted(time.time(), self._learner.steps, versions()))
        self._assign_stage()
        stopped, reason = False, "all steps are done"
        try:
            with self._numbers_as_failure():
                self._learner.learn(self._preset.steps, self)
            if self._learner.steps > self._evaluated_at:
                self._evaluate(last=True)
            reason += self._describe_missed_goal()
        except StopLearning as halt:
            stopped, reason = isinstance(halt, _StopRequested), str(halt)
        self._report_progress()
        self._checkpoint()
        cheat = "" if self._config.reward_file is None else self._describe_cheat()
        if cheat:
            self._events.write(TrainingNote(cheat))
        return TrainingEnded(
            "stopped" if stopped else "finished", self._learner.steps, self._elapsed(), reason
        )

    @contextmanager
    def _numbers_as_failure(self) -> Iterator[None]:
        """What a library raises where values have become too large, or arrays, as a failure that says so."""
        try:
            yield
        except (ArithmeticError, MemoryError, ValueError, RuntimeError) as error:
            traceback.print_exc()  # to the run's log
            raise LearningFailed(
                f"{self._config.algorithm} cannot go on ({str(error).partition(chr(10))[0][:200]}): with "
                f"{self._config.preset_text} its numbers have become too large. Lower the learning rate, or the settings "
                "that were changed."
            ) from error

    def between_updates(self) -> None:
        now = time.monotonic()
        if now - self._control_at >= CONTROL_S:
            self._follow_command()
        if self._learner.steps >= self._next_evaluation:
            self._evaluate()
        if now - self._batch.since >= PROGRESS_S:
            self._report_progress()
        if now - self._checkpoint_at >= CHECKPOINT_S:
            self._checkpoint()

    def on_episode_end(self, episode: EpisodeStats) -> None:
        self._batch.add(episode)
        if self._config.reward_file is not None:
            if len(self._first_returns) < COMPARED_EPISODES:
                self._first_returns.append(episode.reward)
            self._last_returns.append(episode.reward)

    def _describe_missed_goal(self) -> str:
        """What of the task's goal is not certain when all steps are done; empty where nothing is asked for."""
        goal = getattr(self._preset.stopping_rule, "goal", None)
        if goal is None or self._is_sure:
            return ""
        case, share = self._worst
        return f", but {goal:g} in each case is not certain ({case} {share:.3f})"

    def _describe_cheat(self) -> str:
        """What the student's reward pays for missing the goal, where that is what has been learned; else empty."""
        if self._success >= CHEATED_BELOW or len(self._first_returns) < COMPARED_EPISODES:
            return ""
        first, last = (float(np.mean(each)) for each in (self._first_returns, self._last_returns))
        if last <= first:
            return ""
        return (
            f"In the last test {self._success:.0%} reached the goal, yet an episode earns {last:.2f}, in the beginning "
            f"{first:.2f}: the robot has learned what this reward pays, and that is not to arrive. "
            f"`kit watch {self._run.name}` shows what it does instead."
        )

    def _follow_command(self) -> None:
        """Follows the command in the control file; returns only when it is not to pause."""
        paused = time.monotonic()
        is_saved = False
        while True:
            if self._interrupted():
                self._checkpoint()
                raise KeyboardInterrupt
            order = self._run.read_command()
            if order != "pause":
                break
            if not is_saved:
                self._checkpoint()
                is_saved = True
            time.sleep(CONTROL_S)
        now = time.monotonic()
        self._began += now - paused  # a pause is not training
        self._batch.since += now - paused
        self._control_at = now
        if order == "stop":
            raise _StopRequested("as asked")

    # Looking

    def _evaluate(self, last: bool = False) -> None:
        """Evaluates the present policy and follows the stopping rule's decision."""
        self._report_progress()
        policy, steps = self._learner.policy(), self._learner.steps
        test = _SeededPolicyTest(
            self._evaluator, policy, self._config.seed, self._test_count, self._preset.stopping_rule.greedy
        )
        decision = self._preset.stopping_rule.evaluate(steps, self._memory, test)
        self._test_count, self._memory = test.test_count, decision.memory
        self._success = float(np.mean([each.reached / each.episodes for each in decision.counts.values()]))
        shares = {name: count.share for name, count in decision.counts.items()}
        self._worst = min(shares.items(), key=lambda item: item[1])
        self._is_sure = decision.stop
        self._evaluated_at, self._next_evaluation = steps, steps + self._preset.stopping_rule.test_interval
        save_policy(policy, self._run.newest_policy)
        if decision.is_best:
            save_policy(policy, self._run.best_policy)
            self._best_snapshot = self._learner.snapshot()
        measures = self._learner.measures()
        self._events.write(
            _evaluation_event(steps, self._elapsed(), decision, self._task.robots > 1, measures)
        )
        if is_value_too_large(measures) and not self._is_warned:
            self._is_warned = True
            self._events.write(TrainingNote(value_warning(measures)))
        if decision.restore_best and self._best_snapshot is not None and not last:
            self._learner.restore(self._best_snapshot)
        self._follow_curriculum(decision.counts)
        if self._preset.hard_case_share and self._stage >= len(self._practices) and not last:
            self._learner.assign_cases(practice_shares(decision.counts, self._preset.hard_case_share))
        self._batch = _ProgressBatch(steps)
        if decision.stop and not last:
            raise StopLearning(decision.reason)

    def _follow_curriculum(self, counts: CaseCounts) -> None:
        """Goes on to the next stage, perhaps over several, where a test went well enough."""
        before, shares = self._stage, {name: count.share for name, count in counts.items()}
        while self._stage < len(self._practices) and self._practices[self._stage].is_over(shares):
            self._stage += 1
        if self._stage > before:
            self._assign_stage()

    def _assign_stage(self) -> None:
        """Deals the worlds to the cases of the present stage, and says so."""
        if not self._practices:
            return
        names = self._evaluator.cases
        practice = CasePractice(names, 1.0)
        if self._stage < len(self._practices):
            practice = self._practices[self._stage]
        self._learner.assign_cases(practice.world_shares(names))
        count = len(self._practices) + 1
        self._events.write(TrainingNote(f"Stage {self._stage + 1} of {count}: {', '.join(practice.cases)}."))

    # Writing

    def _elapsed(self) -> float:
        return self._seconds + time.monotonic() - self._began

    def _report_progress(self) -> None:
        if self._learner.steps > self._batch.steps:
            progress = self._batch.progress(self._learner.steps, self._elapsed())
            self._events.write(replace(progress, measures=self._learner.measures()))
            self._batch = _ProgressBatch(self._learner.steps)

    def _checkpoint(self) -> None:
        state = {
            "memory": asdict(self._memory),
            "seconds": self._elapsed(),
            "test_count": self._test_count,
            "resumed": self._resumed,
            "next_evaluation": self._next_evaluation,
            "stage": self._stage,
            "is_warned": self._is_warned,
        }
        save_policy(self._learner.policy(), self._run.newest_policy)
        self._run.save_checkpoint({"training.json": json.dumps(state).encode(), **self._learner.save()})
        self._checkpoint_at = time.monotonic()

    @contextmanager
    def _odd_checkpoint_as_run_error(self) -> Iterator[None]:
        """Reports a checkpoint whose file is whole and whose content no learner has written."""
        try:
            yield
        except Exception as error:  # noqa: BLE001 - whatever json, numpy and torch raise for what they cannot read
            raise RunError(
                f"{self._run.folder}: the checkpoint is not one of this kit's ({error}). The policies in it may be "
                "whole; to train on, start a new run with `kit train`."
            ) from None

    def _load_checkpoint(self) -> dict[str, bytes] | None:
        """Restores the last checkpoint and returns the learner's part of it. Raises RunError if it is damaged."""
        loaded = self._run.load_checkpoint()
        if loaded is None:
            if self._run.events_file.stat().st_size:
                self._events.write(TrainingNote("There was no checkpoint yet: training starts again."))
            return None
        parts, damage = loaded
        with self._odd_checkpoint_as_run_error():
            state = read_numbers(parts["training.json"])
            check_field_types(StoppingMemory, state["memory"])
            best = state["memory"]["best"]
            self._memory = StoppingMemory(**{**state["memory"], "best": tuple(best) if best else None})
            self._seconds, self._test_count = float(state["seconds"]), int(state["test_count"])
            self._resumed, self._next_evaluation = int(state["resumed"]) + 1, int(state["next_evaluation"])
            self._stage, self._is_warned = int(state["stage"]), bool(state["is_warned"])
            if min(self._seconds, self._test_count, self._resumed, self._next_evaluation, self._stage) < 0:
                raise ValueError("a count below 0")
        note = "Training continues from the last checkpoint, with new episodes."
        self._events.write(TrainingNote(f"{damage}: the previous one is used. {note}" if damage else note))
        return parts


def make_learner(
    algorithm: Algorithm,
    preset: Preset,
    choice: TaskSpec,
    task: LearningTask,
    *,
    seed: int,
    reward: RewardFunction | None = None,
    tensorboard: Path | None = None,
    demonstrations: Sequence[Path] = (),
) -> Learner:
    """One who learns ``task`` by the algorithm; ``choice`` is what the policy will say it was trained on.
    ``demonstrations``: files of those whom it imitates. RunError where it would take more than any memory."""
    preset.check_size(task.observation.size * task.robots)
    if algorithm.family == "imitation":
        from kit.learning.training.controller_demonstrator import (
            read_demonstrator,  # brings the simulator along
        )

        demonstrators = [read_demonstrator(file, task) for file in demonstrations]
        return cast(Learner, algorithm.load()(algorithm, preset, choice, task, seed, demonstrators))
    fixed_cases = (preset.fixed_cases or bool(task.curriculum)) and preset.worlds >= len(task.map_cases())
    if task.curriculum and not fixed_cases:
        raise UnsupportedWorld(
            f"a curriculum needs at least as many worlds as cases: {preset.worlds} worlds for {len(task.map_cases())} "
            f"cases. Say --worlds {len(task.map_cases())}, or leave the curriculum out."
        )
    if algorithm.family == "table":
        if preset.mirrored:
            raise UnsupportedWorld("tabular algorithms learn without a mirror")
        batch = BatchEnv(task, preset.worlds, seed, reward=reward, fixed_cases=fixed_cases)
        learner: Learner = algorithm.load()(algorithm, preset, choice, batch, seed)
        return learner
    from kit.learning.environment.sb3_vec_env import HalfMirroredVecEnv, make_vec_env
    from kit.learning.training.deep import DeepLearner

    venv = make_vec_env(task, preset.worlds, seed, reward, fixed_cases=fixed_cases)
    shown = HalfMirroredVecEnv(venv) if preset.mirrored else venv
    if algorithm.library == "kit":
        return cast(Learner, algorithm.load()(algorithm, preset, choice, shown, seed))
    return DeepLearner(algorithm, preset, choice, shown, seed, tensorboard)


def _tensorboard_folder(run: TrainingRun) -> Path | None:
    """The folder of TensorBoard's files; None where it is not installed."""
    return run.folder / "tensorboard" if find_spec("tensorboard") else None


class _SeededPolicyTest:
    """Tries a policy on episodes of its own."""

    def __init__(
        self, evaluator: Evaluator, policy: Policy, seed: int, test_count: int, greedy: bool
    ) -> None:
        self._evaluator = evaluator
        self._policy = policy
        self._seed = seed
        self._greedy = greedy
        self.test_count = test_count
        """Number of tests so far, over all policies: each has its own episodes."""

    @property
    def cases(self) -> int:
        return len(self._evaluator.cases)

    def __call__(self, episodes: int) -> CaseCounts:
        each = -(-episodes // self.cases)
        seed = derive_seed(self._seed, "test", self.test_count)
        self.test_count += 1
        result = self._evaluator.test(self._policy, each, seed, greedy=self._greedy)
        return {case.case: _count_of_case(case) for case in result.cases}


def practice_shares(counts: CaseCounts, hard_case_share: float) -> FloatArray:
    """(cases,) which part of the worlds each case gets: one part is shared out alike, the part ``hard_case_share`` as the cases went
    wrong. A few episodes without a failure are no proof: half a failure is added (Jeffreys)."""
    failed: FloatArray = np.array(
        [(count.episodes - count.reached + 0.5) / (count.episodes + 1) for count in counts.values()]
    )
    shares: FloatArray = (1.0 - hard_case_share) / len(failed) + hard_case_share * failed / failed.sum()
    return shares


def _count_of_case(case: CaseResult) -> CaseCount:
    """What counts of a test's result on one case; an adjacency that was not measured as 0."""
    adjacency = 0.0 if math.isnan(case.adjacency) else case.adjacency
    return CaseCount(case.reached, case.episodes, adjacency, case.outcomes[1], case.reward)


def _evaluation_event(
    steps: int, seconds: float, decision: StoppingDecision, is_pair: bool, measures: dict[str, float]
) -> Evaluated:
    counts = decision.counts
    cases = {
        name: [count.reached, count.collided, count.episodes - count.reached - count.collided]
        for name, count in counts.items()
    }
    reward = float(np.mean([count.reward for count in counts.values()]))
    adjacency = float(np.mean([count.adjacency for count in counts.values()])) if is_pair else None
    return Evaluated(steps, seconds, cases, decision.is_best, reward, decision.reason, adjacency, measures)


class _ProgressBatch:
    """Episodes since the last progress event."""

    def __init__(self, steps: int) -> None:
        self.since = time.monotonic()
        self.steps = steps
        self._episodes: list[EpisodeStats] = []

    def add(self, episode: EpisodeStats) -> None:
        self._episodes.append(episode)

    def progress(self, steps: int, seconds: float) -> TrainingProgress:
        episodes, places = self._episodes, {outcome: place for place, outcome in enumerate(EpisodeOutcome)}
        counts: dict[str, list[int]] = {}
        terms: dict[str, float] = {}
        for episode in episodes:
            counts.setdefault(episode.case, [0] * len(places))[places[episode.outcome]] += 1
            for name, value in episode.terms.items():
                terms[name] = terms.get(name, 0.0) + value
        many = max(1, len(episodes))
        return TrainingProgress(
            steps,
            seconds,
            (steps - self.steps) / max(1e-9, time.monotonic() - self.since),
            counts,
            reward=_mean_or_none([episode.reward for episode in episodes]),
            length=_mean_or_none([episode.steps for episode in episodes]),
            terms={name: value / many for name, value in terms.items()},
            adjacency=_mean_or_none([episode.adjacency for episode in episodes]),
        )


def _mean_or_none(values: list[float] | list[int]) -> float | None:
    return sum(values) / len(values) if values else None
