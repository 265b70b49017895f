"""What tables learn, found out by letting them learn in small grid worlds."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from kit.learning.environment.grid_world import GridRewards, GridWorld
from kit.learning.training.grid_learner import GridLearner, GridLearnerSettings
from kit.school.quiz.items import QuizItem
from tests.school.quiz.derived.finding import Derivation, Finding, nearest

RIGHT = 0


def _trained(world: GridWorld, settings: GridLearnerSettings, episodes: int) -> GridLearner:
    learner = GridLearner(world, settings)
    while learner.episodes < episodes:
        learner.step()
    return learner


def second_success(item: QuizItem, folder: Path) -> Finding:
    """A cell beside the target, whose move into it has the value 0.5."""
    learner = GridLearner(GridWorld(("SG",)), GridLearnerSettings(alpha=0.5, epsilon=0.0))
    learner.values[0, 0, RIGHT] = 0.5
    learner.step()
    while not learner.episodes:
        learner.step()
    return nearest(item, float(learner.values[0, 0, RIGHT]), 0.001)


def three_moves_away(item: QuizItem, folder: Path) -> Finding:
    learner = _trained(GridWorld(("S..G",)), GridLearnerSettings(gamma=0.9, epsilon=0.5), 500)
    return nearest(item, float(learner.values[0, 0].max()), 0.001)


def never_explores(item: QuizItem, folder: Path) -> Finding:
    """The small target is known, the other one is not."""
    learner = GridLearner(GridWorld(("g..S..G",)), GridLearnerSettings(epsilon=0.0))
    learner.values[0, 1:4, 2] = 0.2
    ends = [_episode_reward(learner) for _ in range(1000)]
    small = np.mean(np.array(ends) == 0.3)
    found = "small" if small == 1 else "large" if ends[-1] == 1.0 else "both"
    return Finding(
        found,
        {
            "It goes to the small one each time": "small",
            "It finds the larger one in the end": "large",
            "It goes to each about half the time": "both",
        },
    )


def _episode_reward(learner: GridLearner) -> float:
    ended = learner.episodes
    while learner.episodes == ended:
        learner.step()
    return learner.returns[-1]


def off_policy(item: QuizItem, folder: Path) -> Finding:
    """With epsilon 1: is the start worth what the best moves earn, or what moving at random earns?"""
    world = GridWorld(("..#G", "S..."), GridRewards())
    value = _trained(world, GridLearnerSettings(epsilon=1.0), 400).values[world.start].max()
    assert world.shortest_path_length is not None
    best = 0.9 ** (world.shortest_path_length - 1)
    rng, earned = np.random.default_rng(0), []
    for _ in range(300):
        cell, ended, steps = world.start, False, 0
        while not ended:
            cell, _, ended = world.step(cell, int(rng.integers(4)))
            steps += 1
        earned.append(0.9 ** (steps - 1))
    at_random = float(np.mean(earned))
    known = {"best": best, "random": at_random, "nothing": 0.0}
    truth = min(known, key=lambda name: abs(known[name] - value))
    return Finding(
        truth,
        {
            "What the best moves are worth": "best",
            "What moving at random is worth": "random",
            "Nothing, since it never exploits": "nothing",
        },
    )


def smaller_alpha(item: QuizItem, folder: Path) -> Finding:
    """Over many seeds: how often do the best moves lead to the target, and how large are the values?"""
    world = GridWorld(("..#...G", "..#.#..", "....#..", "S......"))
    solved, largest = {}, {}
    for alpha in (0.1, 1.0):
        many = [_trained(world, GridLearnerSettings(alpha=alpha, seed=seed), 20) for seed in range(12)]
        solved[alpha] = sum(each.is_solved for each in many)
        largest[alpha] = np.mean([each.values.mean() for each in many])
    difference = solved[0.1] - solved[1.0]
    policy = "as good" if abs(difference) <= 1 else "better" if difference > 0 else "worse"
    values = "smaller" if largest[0.1] < largest[1.0] else "exact"
    return Finding(
        (policy, values),
        {
            "It is as good, with smaller values": ("as good", "smaller"),
            "It is worse, with smaller values": ("worse", "smaller"),
            "It is better, with exact values": ("better", "exact"),
        },
    )


TABLES: dict[str, Derivation] = {
    "second-success": second_success,
    "three-moves-away": three_moves_away,
    "never-explores": never_explores,
    "off-policy": off_policy,
    "smaller-alpha": smaller_alpha,
}
