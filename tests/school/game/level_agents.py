"""Agents for the levels: each learns the kit's task of a level by the kit's preset."""

from __future__ import annotations

import re
from pathlib import Path

from kit.learning.maps.batch_map import UnsupportedWorld
from kit.learning.policies.policy import Policy
from kit.learning.tasks.task_spec import TaskSpec
from kit.learning.training.run_config import RunConfig, RunError
from kit.learning.training.run_folders import create_run
from kit.learning.training.training import train
from kit.school.game.level_task import MEMORY, SEED, memory_steps, needs_memory, task_text
from kit.school.game.levels import GameLevel
from kit.world.problems import WorldError

STEPS, MORE_STEPS = 600_000, 1_800_000
"""Of a training, and of the second one where the first agent has earned nothing, which also knows where it is. One with memory
is trained once, for longer."""


def train_agent(level: GameLevel, folder: Path, is_second: bool = False) -> Policy | str:
    """Trains an agent for the level in ``folder``; why there is none, where none can be trained."""
    file = folder / f"{level.id}.yaml"
    is_recurrent = needs_memory(level)
    try:
        text = task_text(level)
        if is_second and not is_recurrent and "own_pose" not in text:
            text = text.replace("observation: {", "observation: {own_pose: true, ")
        file.write_text(text)
        steps = memory_steps(level) if is_recurrent else MORE_STEPS if is_second else STEPS
        config = RunConfig(
            TaskSpec(str(file)), algorithm=MEMORY if is_recurrent else "ppo", seed=SEED, steps=steps
        )
        run = create_run(folder, config)
    except (LookupError, RunError, UnsupportedWorld, WorldError) as error:
        return _without_folders(str(error))
    ended = train(run)
    return run.policy() if ended.how == "finished" else _without_folders(f"{ended.how}: {ended.reason}")


def _without_folders(text: str) -> str:
    """A message on one line, with files by their names alone."""
    return re.sub(r"/\S*/", "", " ".join(text.split()))
