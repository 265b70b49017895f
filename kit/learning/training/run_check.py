"""Checks what a training is asked to learn before anything is written: task, worlds, algorithm, mirror, reward file."""

from __future__ import annotations

from pathlib import Path

from kit.learning.environment.case_arrays import CaseArrays
from kit.learning.environment.mirror import TaskMirror
from kit.learning.environment.tasks import task_names
from kit.learning.tasks.task_check import check_task
from kit.learning.tasks.task_reader import read_task
from kit.learning.training.algorithms import find_algorithm
from kit.learning.training.optional_deps import require_learn_extra
from kit.learning.training.runs import RunConfig, RunError
from kit.learning.training.student_reward import reward_parameters
from kit.learning.training.training import fit_task_spec


def check_run_config(config: RunConfig) -> None:
    """Raises what is wrong with a training that is to begin: UnknownTask, UnknownAlgorithm, UnsuitableAlgorithm,
    WorldError, UnsupportedWorld, RewardFileError, LearnExtraMissing or RunError. Each message says the way out."""
    task = config.choice.resolve()
    algorithm = find_algorithm(config.algorithm)
    fit_task_spec(config.choice, algorithm)
    if task.file is not None and task.name not in task_names():
        check_task(read_task(task.file, config.choice.text))
    CaseArrays(task)
    if config.mirrored:
        TaskMirror(task)
        if algorithm.family == "table":
            raise RunError("A table is learned without a mirror: leave --mirrored out.")
    if algorithm.needs_torch:
        require_learn_extra()
    if config.reward_file is not None:
        reward_parameters(Path(config.reward_file))
