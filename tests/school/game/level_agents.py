"""Agents for the levels: for each a task made from its map, start and targets, learned by the kit's preset.

What a level has of its own beside them, its carts, stays out of the training and in the race.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Final

from kit.geometry import Pose
from kit.learning.maps.batch_map import UnsupportedWorld
from kit.learning.policies.policy import Policy
from kit.learning.tasks.goals.cover import CoverGoal
from kit.learning.tasks.task_spec import TaskSpec
from kit.learning.training.run_config import RunConfig, RunError
from kit.learning.training.run_folders import create_run
from kit.learning.training.training import train
from kit.school.game.levels import GameLevel
from kit.world.problems import WorldError
from tests.school.game.ordinary import targets_of

SEED: Final = 1
STEPS, MORE_STEPS = 600_000, 1_800_000
"""Of a training, and of the second one where the first agent has earned nothing, which also knows where it is."""
STEP_S: Final = 0.2
ONE_ROBOT: Final = """\
actions:
  twists:
    forward: [0.5, 0]
    back: [-0.5, 0]
    left: [0, 1.5]
    right: [0, -1.5]
    forward_left: [0.5, 1.5]
    forward_right: [0.5, -1.5]
"""
TWO_ROBOTS: Final = """\
actions:
  one_number: false
  twists:
    stop: [0, 0]
    forward: [0.5, 0]
    back: [-0.5, 0]
    forward_left: [0.5, 1.0]
    forward_right: [0.5, -1.0]
    left: [0, 1.0]
    right: [0, -1.0]
"""
LEARNING: Final = """\
observation: {{sectors: 13, scale: 0.5{sees}}}
reward:
  terms: {{{terms}elapsed: -0.01, collided: -2.0, reached: 2.0}}
goal: {goal}
target: {{radius: {radius:g}}}
step: {{time: {step:g}, collision_checks: 2, limit: {limit}}}
start: {{noise: 0.03, max_rotation: 0.4}}
preset: hallway
success: 0.9
"""


def task_text(level: GameLevel, is_second: bool = False) -> str:
    """The text of the task's file. LookupError where no task can ask for what the level asks for."""
    if level.untrained:
        raise LookupError(f"training has no {level.untrained}")
    scenario = level.find_scenario()
    case = scenario.case
    assert case is not None
    starts = scenario.starts
    others = f", other_starts: [{_pose(starts[1])}]" if len(starts) > 1 else ""
    targets = [f"[{x:g}, {y:g}]" for x, y in targets_of(level)]
    where = f", target: {targets[0]}"
    sees, terms, goal = ", target: true", "progress: 1.0, ", "{kind: target}"
    if is_second and not isinstance(level.goal, CoverGoal):
        sees += ", own_pose: true"
    if level.goal.is_route:
        rounds = getattr(level.goal, "rounds", 1)
        where = f", targets: [{', '.join(targets[: len(targets) // rounds])}]"
        goal = f"{{kind: patrol, rounds: {rounds}}}"
        terms += "achieving: 4.0, "
    elif isinstance(level.goal, CoverGoal):
        where, sees, terms = "", ", own_pose: true, achieved: true, frames: 2", "achieving: 6.0, "
        goal = f"{{kind: cover, share: {level.goal.share:g}, radius: {level.goal.radius:g}}}"
    return (
        f"summary: The level {level.title}\nmaps: [{level.map_name}]\n"
        f"cases:\n  - {{name: {level.case}, start: {_pose(starts[0])}{others}{where}}}\n"
        + (TWO_ROBOTS if others else ONE_ROBOT)
        + LEARNING.format(
            sees=sees,
            terms=terms,
            goal=goal,
            radius=case.target_radius,
            step=STEP_S,
            limit=min(400, round(level.time_limit / STEP_S)),
        )
    )


def train_agent(level: GameLevel, folder: Path, is_second: bool = False) -> Policy | str:
    """Trains an agent for the level in ``folder``; why there is none, where none can be trained."""
    file = folder / f"{level.id}.yaml"
    try:
        file.write_text(task_text(level, is_second))
        steps = MORE_STEPS if is_second else STEPS
        run = create_run(folder, RunConfig(TaskSpec(str(file)), seed=SEED, steps=steps))
    except (LookupError, RunError, UnsupportedWorld, WorldError) as error:
        return _without_folders(str(error))
    ended = train(run)
    return run.policy() if ended.how == "finished" else _without_folders(f"{ended.how}: {ended.reason}")


def _without_folders(text: str) -> str:
    """A message on one line, with files by their names alone."""
    return re.sub(r"/\S*/", "", " ".join(text.split()))


def _pose(pose: Pose) -> str:
    return f"[{pose.x:g}, {pose.y:g}, {pose.theta:.5g}]"
