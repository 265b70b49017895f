"""What PPO does, found out by the kit's own small PPO and by its objective."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from kit.learning.grid.grid_learner import MAX_EPISODE_STEPS, GridLearnerSettings
from kit.learning.grid.grid_world import GridRewards, GridWorld
from kit.learning.grid.ppo import PpoLearner, advantages_of
from kit.school.quiz.items import QuizItem
from tests.school.quiz.derived.finding import Derivation, Finding, nearest

WORLD = GridWorld(("..#...G", "..#.#..", "....#..", "S......"), GridRewards(step=-0.05))
SETTINGS = GridLearnerSettings("ppo", alpha=3.0, gamma=0.95, seed=1)


def one_advantage(item: QuizItem, folder: Path) -> Finding:
    """The step ends its episode, so nothing comes after it."""
    ended = np.array([[True]])
    found = advantages_of(np.array([[1.0]]), np.array([[0.75]]), np.array([[0.0]]), ended, 0.9)
    return nearest(item, float(found[0, 0]), 0.001)


def what_an_advantage_does(item: QuizItem, folder: Path) -> Finding:
    """A move with a positive reward that was worse than expected."""
    learner = PpoLearner(WORLD, replace(SETTINGS, alpha=0.1, entropy=0.0))
    before = learner.logits[0].copy()
    chances = np.array([0.25])
    learner._ascend_objective(np.array([0]), np.array([2]), np.array([0.2 - 0.8]), chances)
    change = learner.logits[0, 2] - before[2]
    truth = "falls" if change < 0 else "rises" if change > 0 else "stays"
    return Finding(
        truth,
        {
            "It falls, since more was expected": "falls",
            "It rises, since it was paid": "rises",
            "It stays, since it went so-so": "stays",
        },
    )


def not_clipped(item: QuizItem, folder: Path) -> Finding:
    learner = PpoLearner(WORLD, replace(SETTINGS, clip=0.0))
    while learner.updates < 1500:
        learner.step()
    is_stuck = not learner.is_solved and set(learner.lengths[-2:]) == {MAX_EPISODE_STEPS}
    truth = "stuck" if is_stuck else "learns"
    return Finding(
        truth,
        {
            "It can become sure of bad moves and stay so": "stuck",
            "It learns the same, only more quickly": "learns",
            "It explores more, and never makes up its mind": "undecided",
        },
    )


def outside_the_range(item: QuizItem, folder: Path) -> Finding:
    """A positive advantage, and a chance that has grown from 0.2 to 0.3: is there a slope?"""
    learner = PpoLearner(WORLD, replace(SETTINGS, clip=0.2, entropy=0.0))
    learner.logits[0] = np.log([0.3, 0.3, 0.2, 0.2])
    before = learner.logits[0].copy()
    learner._ascend_objective(np.array([0]), np.array([0]), np.array([1.0]), np.array([0.2]))
    change = learner.logits[0, 0] - before[0]
    truth = "none" if change == 0 else "up" if change > 0 else "down"
    return Finding(
        truth,
        {"No further up or down": "none", "Further up, as before": "up", "Back down, to 0.24": "down"},
    )


def most_undecided(item: QuizItem, folder: Path) -> Finding:
    texts = [option.text for option in item.options]
    chances = {text: np.array([float(each) for each in text.split(", ")]) for text in texts}
    entropies = {text: float(-(each * np.log(each)).sum()) for text, each in chances.items()}
    truth = max(texts, key=lambda text: entropies[text])
    return Finding(truth, {text: text for text in texts})


POLICIES: dict[str, Derivation] = {
    "one-advantage": one_advantage,
    "what-an-advantage-does": what_an_advantage_does,
    "not-clipped": not_clipped,
    "outside-the-range": outside_the_range,
    "most-undecided": most_undecided,
}
