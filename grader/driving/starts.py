"""Whether the starts of a trial are free: a seed that puts the robot into a wall takes points from right programs."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Final

from grader.assignment import Assignment, Shift, Trial
from grader.driving.episodes import shifted_start
from kit.geometry import Pose
from kit.plain_text import quoted
from kit.sim.simulation import Simulation

SEEDS_TRIED: Final = range(50)
"""Besides those of the assignment."""
STEP_M: Final = 0.05
"""A robot is farther across, so a wall between two places that lie so near to one another touches it at one of them."""


def start_problems(assignment: Assignment) -> Iterator[str]:
    """Yields a sentence for each trial of which some seeds put the robot into a wall or behind one."""
    for trial in assignment.trials:
        blocked = blocked_seeds(trial)
        if blocked:
            yield (
                f"trial {quoted(trial.name)}: {len(blocked)} of {len(_seeds_tried(trial))} seeds put the robot into something or behind a "
                f"wall (such as seed {blocked[0]}): make `shift` smaller. It is along x and y of the world, not along the robot."
            )


def blocked_seeds(trial: Trial) -> tuple[int, ...]:
    """Returns those of the trial's seeds, and of the seeds 0 to 49, whose start the robot cannot reach from its home in a
    straight line."""
    robot = trial.scenario.robot
    if robot is None or trial.shift == Shift():
        return ()
    simulation = Simulation(trial.scenario.world, seed=0, has_subscribers=lambda topic: False)
    return tuple(
        seed
        for seed in _seeds_tried(trial)
        if any(_touches_at(simulation, robot, pose) for pose in _way_to_start(trial, seed))
    )


def _seeds_tried(trial: Trial) -> tuple[int, ...]:
    return tuple(dict.fromkeys((*SEEDS_TRIED, *trial.seeds, *trial.secret_seeds)))


def _way_to_start(trial: Trial, seed: int) -> Iterator[Pose]:
    """Yields poses from the home to the start of the seed."""
    home, start = trial.home(), shifted_start(trial, seed)
    parts = 1 + math.ceil(math.dist((home.x, home.y), (start.x, start.y)) / STEP_M)
    for part in range(1, parts + 1):
        share = part / parts
        yield Pose(
            home.x + share * (start.x - home.x),
            home.y + share * (start.y - home.y),
            home.theta + share * (start.theta - home.theta),
        )


def _touches_at(simulation: Simulation, robot: str, pose: Pose) -> bool:
    simulation.reset()
    simulation.move_model(robot, pose, at_rest=True)
    simulation.step()
    return simulation.is_touching(robot)
