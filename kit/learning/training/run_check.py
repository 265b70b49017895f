"""Checks what a training is asked to learn before anything is written: task, worlds, algorithm, mirror, reward file."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Final

import numpy as np

from kit.learning.authoring.task_check import check_task
from kit.learning.environment.batch import BatchEnv
from kit.learning.environment.case_arrays import CaseArrays
from kit.learning.environment.mirror import TaskMirror
from kit.learning.tasks.catalogue import task_names
from kit.learning.tasks.learning_task import LearningTask
from kit.learning.tasks.student_reward import StudentReward
from kit.learning.tasks.task_reader import read_task
from kit.learning.tasks.transition import EpisodeState, Transition
from kit.learning.training.algorithms import IMITATION_ALGORITHMS, Algorithm, find_algorithm
from kit.learning.training.demonstrations import DemonstrationError
from kit.learning.training.learn_extra import require_learn_extra
from kit.learning.training.run_config import RunConfig, RunError
from kit.learning.training.training import fit_task_spec, resolve_preset


def check_run_config(config: RunConfig) -> None:
    """Raises what is wrong with a training that is to begin: UnknownTask, UnknownAlgorithm, UnsuitableAlgorithm,
    WorldError, UnsupportedWorld, RewardFileError, StudentCodeError, DemonstrationError, RecordingError,
    PolicyError, LearnExtraMissing or RunError. Each message says the way out."""
    task = config.choice.resolve()
    algorithm = find_algorithm(config.algorithm)
    fit_task_spec(config.choice, algorithm)
    if task.file is not None and task.name not in task_names():
        check_task(read_task(task.file, config.choice.text))
    if algorithm.needs_torch:
        require_learn_extra()
    check_settings(config)
    resolve_preset(config).check_size(task.observation.size * task.robots)
    CaseArrays(task)
    if config.mirrored:
        TaskMirror(task)
        if algorithm.family in ("table", "imitation"):
            raise RunError(f"{algorithm.name} learns without a mirror: leave out --mirrored.")
    _check_demonstrations(config, algorithm, task)
    reward_file = task.reward_file if config.reward_file is None else Path(config.reward_file)
    if reward_file is not None:
        check_reward(reward_file, task)


def check_settings(config: RunConfig) -> None:
    """Raises RunError for a setting that the algorithm does not have, or a number that it cannot take."""
    if config.settings:
        preset = resolve_preset(replace(config, settings=()))
        preset.changed(dict(config.settings), find_algorithm(config.algorithm))


CHECKED_STEPS: Final = 3
CHECKED_WORLDS: Final = 8


def check_reward(file: Path, task: LearningTask) -> None:
    """Calls a file's reward and metrics in a process of their own: for the first steps of random drives, and for such
    steps as if each had ended the episode in one of its ways, so that what is said of the end is run too.

    RewardFileError where the file cannot be called, StudentCodeError where its code fails: with the file and the line.
    """
    with StudentReward(file) as reward:
        batch = BatchEnv(task, CHECKED_WORLDS, reward=reward)
        batch.action_space.seed(0)
        batch.reset()
        for _ in range(CHECKED_STEPS):
            step = batch.step(np.array([batch.action_space.sample() for _ in range(batch.n)]))
        for ended in _possible_endings(step.transition):
            reward(ended)
            reward.metrics(ended)


def _possible_endings(transition: Transition) -> Iterator[Transition]:
    """The step as a collision, as an arrival and as the last one."""
    after = EpisodeState.of(transition.after)
    unhurt = replace(after, hit=np.zeros_like(after.hit))
    arrived = replace(unhurt, in_target=np.ones_like(after.in_target), achieved=np.ones_like(after.achieved))
    last = replace(
        unhurt, achieved=np.zeros_like(after.achieved), step=np.full_like(after.step, transition.max_steps)
    )
    for state in (replace(after, hit=np.ones_like(after.hit)), arrived, last):
        yield replace(transition, after=state)


def _check_demonstrations(config: RunConfig, algorithm: Algorithm, task: LearningTask) -> None:
    """Whether those who are imitated fit the task and the algorithm."""
    imitates = algorithm.family == "imitation"
    if config.imitate and not imitates:
        able = " or ".join(IMITATION_ALGORITHMS)
        raise DemonstrationError(
            f"{algorithm.name} learns from a reward, not by imitation: leave out --imitate, or use --algo {able}."
        )
    if imitates and not config.imitate:
        raise DemonstrationError(
            f"{algorithm.name} needs something to imitate: `kit train {config.choice.name} --algo {algorithm.name} --imitate fields`."
        )
    for file in config.imitate:
        from kit.learning.training.controller_demonstrator import (
            read_demonstrator,  # brings the simulator along
        )

        demonstrator = read_demonstrator(Path(file), task)
        if algorithm.name == "dagger" and not demonstrator.can_be_asked:
            raise DemonstrationError(
                f"{file}: dagger asks the demonstrator in the states that the learner visits, and a recording cannot answer. "
                "Take --algo bc, or imitate a controller, a run or a policy."
            )
