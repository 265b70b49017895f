"""Where policies drive: the ways of a few episodes, and pictures of them over the map."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from kit.learning.environment.batch import BatchEnv
from kit.learning.environment.batch_map import ground
from kit.learning.environment.episode_stats import Outcome, Tally
from kit.learning.environment.tasks import Task
from kit.learning.policies.evaluation import seed_for
from kit.learning.policies.policies import Policy
from kit.render.scene import Disc, Mark, Path, Scene
from kit.world.catalogue import MapCard, MapCase


@dataclass(frozen=True, slots=True, eq=False)
class Way:
    """One episode's way."""

    case: str
    outcome: Outcome
    poses: NDArray[np.float64]
    """(steps + 1, robots, 3), from the start on."""
    target: tuple[float, float]


def drive(policy: Policy, task: Task, episodes: int, seed: int, *, greedy: bool = True) -> tuple[Way, ...]:
    """The ways of ``episodes`` episodes of each case, in the order of the task's cases.

    PolicyError if the policy does not fit.
    """
    policy.fits(task)
    batch = BatchEnv(task, episodes * len(task.courses()), seed)
    player = policy.player(batch.n, None if greedy else np.random.default_rng(seed_for(seed, "moves")))
    observations, fresh = batch.reset(seed=seed), np.ones(batch.n, dtype=np.bool_)
    starts, targets, tally = batch.state.pose.copy(), batch.state.target.copy(), Tally(batch)
    trails = [[start] for start in starts]
    ways: dict[int, Way] = {}
    while len(ways) < batch.n:
        step = batch.step(player.act(observations, fresh))
        for world in range(batch.n):
            if world not in ways:
                trails[world].append(step.transition.pose[world].copy())
        for episode in tally.add(step):
            if episode.world not in ways:
                world, (x, y) = episode.world, targets[episode.world].tolist()
                ways[world] = Way(episode.case, episode.outcome, np.array(trails[world]), (x, y))
        observations, fresh = step.observations, step.ended
    order = [case.name for _, case in task.courses()]
    return tuple(sorted((ways[world] for world in sorted(ways)), key=lambda way: order.index(way.case)))


def scene_of(card: MapCard, case: MapCase, ways: tuple[Way, ...], radius: float) -> Scene:
    """The ways of one case over its map: solid where the target was reached, dotted where not. ``radius`` [m]: of
    the target."""
    mine = [way for way in ways if way.case == case.name]
    paths = tuple(
        Path(way.poses[:, robot, :2], "solid" if way.outcome is Outcome.REACHED else "dotted")
        for way in mine
        for robot in range(way.poses.shape[1])
    )
    ends = [way for way in mine if way.outcome is not Outcome.REACHED]
    contacts = [way.poses[-1, 0, :2] for way in ends if way.outcome is Outcome.COLLIDED]
    return Scene(
        walls=ground(card).walls,
        targets=(Disc(*case.target, radius),),
        paths=paths,
        contacts=np.array(contacts).reshape(-1, 2),
        marks=(Mark(case.start.x, case.start.y, "S"),),
    )
