"""What a deep Q-network does, with and without its parts, found out by letting it learn a small floor."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from kit.learning.grid.dqn import DqnLearner
from kit.learning.grid.grid_learner import GridLearnerSettings
from kit.learning.grid.grid_world import GridRewards, GridWorld
from kit.school.quiz.items import QuizItem
from tests.school.quiz.derived.finding import Derivation, Finding, nearest

WORLD = GridWorld(("..#...G", "..#.#..", "....#..", "S......"), GridRewards(step=-0.05))
SETTINGS = GridLearnerSettings("dqn", alpha=0.01, gamma=0.9, epsilon=0.2, seed=1)
UPDATES = 2500


def _solved(settings: GridLearnerSettings) -> list[bool]:
    learner, found = DqnLearner(WORLD, settings), []
    while learner.updates < UPDATES:
        if learner.step().ended:
            found.append(learner.is_solved)
    return found


def network_update(item: QuizItem, folder: Path) -> Finding:
    learner = DqnLearner(WORLD, SETTINGS)
    before = learner.values.copy()
    update = learner.step()
    changed = learner.values != before
    own = changed[update.cell].all() and changed.sum() == 4
    truth = "all" if changed.all() else "cell" if own else "one"
    return Finding(
        truth,
        {"Those of all cells": "all", "The one of that action": "one", "Those of that cell": "cell"},
    )


def newest_step_only(item: QuizItem, folder: Path) -> Finding:
    share = float(np.mean(_solved(replace(SETTINGS, replay=1))))
    full = float(np.mean(_solved(SETTINGS)))
    truth = "little" if share < 0.3 * full else "same" if share < 1.1 * full else "more"
    return Finding(
        truth,
        {
            "It forgets each place while it is in another": "little",
            "It learns as much, only more slowly": "same",
            "It learns more, from fresher steps": "more",
        },
    )


def resting_target(item: QuizItem, folder: Path) -> Finding:
    found = _solved(replace(SETTINGS, target_interval=1))
    ever, keeps = any(found), np.mean(found[found.index(True) :]) > 0.8
    truth = "never" if not ever else "keeps" if keeps else "swings"
    return Finding(
        truth,
        {
            "Its values swing, and its policy with them": "swings",
            "It never finds a way to the target": "never",
            "It finds a way and keeps it, more slowly": "keeps",
        },
    )


def descent_step(item: QuizItem, folder: Path) -> Finding:
    """By a difference of the squared error in place of its slope."""

    def loss(weight: float) -> float:
        return (2.0 * weight - 0.0) ** 2

    slope = (loss(1 + 1e-6) - loss(1 - 1e-6)) / 2e-6
    return nearest(item, 1.0 - 0.1 * slope, 0.01)


def full_buffer(item: QuizItem, folder: Path) -> Finding:
    learner = DqnLearner(WORLD, replace(SETTINGS, replay=5))
    steps = [learner.step() for _ in range(8)]
    kept = sorted((each.cell, each.move) for each in learner._replay)
    columns = WORLD.shape[1]

    def of(chosen: slice) -> list[tuple[int, int]]:
        return sorted((each.cell.row * columns + each.cell.column, each.move) for each in steps[chosen])

    truth = "oldest" if kept == of(slice(3, 8)) else "newest" if kept == of(slice(0, 5)) else "any"
    return Finding(
        truth,
        {
            "The oldest step in it": "oldest",
            "The new step itself": "newest",
            "Any step, drawn at random": "any",
        },
    )


NETWORKS: dict[str, Derivation] = {
    "network-update": network_update,
    "newest-step-only": newest_step_only,
    "resting-target": resting_target,
    "descent-step": descent_step,
    "full-buffer": full_buffer,
}
