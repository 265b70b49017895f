"""What tables learn, found out by letting them learn in small grid worlds."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from kit.learning.grid.grid_learner import GridLearner, GridLearnerSettings
from kit.learning.grid.grid_world import GridCell, GridRewards, GridWorld
from kit.learning.grid.registry import make_grid_learner
from kit.school.quiz.items import QuizItem
from tests.learning.worlds import trained
from tests.school.quiz.derived.finding import Derivation, Finding, nearest

RIGHT = 0


def second_success(item: QuizItem, folder: Path) -> Finding:
    """A cell beside the target, whose move into it has the value 0.5."""
    learner = make_grid_learner(GridWorld(("SG",)), GridLearnerSettings(alpha=0.5, epsilon=0.0))
    learner.values[0, 0, RIGHT] = 0.5
    learner.step()
    while not learner.episodes:
        learner.step()
    return nearest(item, float(learner.values[0, 0, RIGHT]), 0.001)


def three_moves_away(item: QuizItem, folder: Path) -> Finding:
    learner = trained(GridWorld(("S..G",)), GridLearnerSettings(gamma=0.9, epsilon=0.5), 500)
    return nearest(item, float(learner.values[0, 0].max()), 0.001)


def never_explores(item: QuizItem, folder: Path) -> Finding:
    """The small target is known, the other one is not."""
    learner = make_grid_learner(GridWorld(("g..S..G",)), GridLearnerSettings(epsilon=0.0))
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
    value = trained(world, GridLearnerSettings(epsilon=1.0), 400).values[world.start].max()
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
    """Of many trainings, those with smaller values: do their best moves lead to the target more seldom, or more often?"""
    world = GridWorld(("..#...G", "..#.#..", "....#..", "S......"))
    solved, largest = {}, {}
    for alpha in (0.1, 1.0):
        many = [trained(world, GridLearnerSettings(alpha=alpha, seed=seed), 20) for seed in range(12)]
        solved[alpha] = sum(each.is_solved for each in many)
        largest[alpha] = np.mean([each.values.mean() for each in many])
    assert largest[0.1] < largest[1.0]
    difference = solved[0.1] - solved[1.0]
    return Finding(
        0 if abs(difference) <= 1 else difference // abs(difference),
        {
            "Nothing, if each cell's order is the same": 0,
            "That it leads to the target more seldom": -1,
            "That it leads to the target more often": 1,
        },
    )


CLIFF = GridWorld((*("........",) * 3, "SCCCCCCG"), GridRewards(-1, -1, 0, -100))
SEEDS = 6


def _cliff(algorithm: str, epsilon: float) -> list[GridLearner]:
    settings = [GridLearnerSettings(algorithm, 0.1, 1.0, epsilon, seed) for seed in range(SEEDS)]
    return [trained(CLIFF, each, 300) for each in settings]


def falls_while_learning(item: QuizItem, folder: Path) -> Finding:
    falls = {
        algorithm: sum(reward <= -100 for each in _cliff(algorithm, 0.1) for reward in each.returns[-100:])
        for algorithm in ("q-learning", "sarsa")
    }
    is_alike = max(falls.values()) < 1.1 * min(falls.values())
    truth: str = "alike" if is_alike else min(falls, key=lambda name: falls[name])
    return Finding(
        truth,
        {
            "SARSA, since it keeps away from the edge": "sarsa",
            "Q-learning, since its way is shorter": "q-learning",
            "Neither; both stumble equally often": "alike",
        },
    )


def sarsa_without_exploring(item: QuizItem, folder: Path) -> Finding:
    steps = {
        tuple(len(each.greedy_path()) - 1 for each in _cliff(name, 0.0)) for name in ("q-learning", "sarsa")
    }
    ((first, *rest),) = steps
    assert set(rest) <= {first}
    truth = "edge" if first == CLIFF.shortest_path_length else "away"
    return Finding(
        truth,
        {
            "Along the edge, like Q-learning": "edge",
            "A row away from the edge": "away",
            "Nowhere; it learns nothing so": "nowhere",
        },
    )


def sarsa_target_needs(item: QuizItem, folder: Path) -> Finding:
    """Which change of the next step changes the target: another best move, or another move made?"""
    learner = make_grid_learner(CLIFF, GridLearnerSettings("sarsa", epsilon=1.0, gamma=1.0, seed=1))
    learner.values[:] = np.random.default_rng(1).normal(size=learner.values.shape)
    update = learner.step()
    while update.ended or update.reached == update.cell:
        update = learner.step()
    table = learner.values.copy()
    following = learner.step()
    own = update.target - update.reward
    known = {
        "made": float(table[update.reached][following.move]),
        "best": float(table[update.reached].max()),
        "mean": float(table[update.reached].mean()),
    }
    truth = min(known, key=lambda name: abs(known[name] - own))
    assert len({round(value, 6) for value in known.values()}) == 3
    return Finding(
        truth,
        {
            "The move that is really made next": "made",
            "The best move of the next cell": "best",
            "The mean of all moves of the next cell": "mean",
        },
    )


def edge_step(item: QuizItem, folder: Path) -> Finding:
    """Random moves on the edge, counted."""
    rng, moves = np.random.default_rng(0), 200_000
    exploring = rng.random(moves) < 0.2
    down = rng.integers(4, size=moves) == 3
    assert CLIFF.step(GridCell(2, 3), 3).terminated
    falls = int((exploring & down).sum())
    return nearest(item, 100 * falls / moves, 0.3)


def tested_on_the_cliff(item: QuizItem, folder: Path) -> Finding:
    steps = {
        name: {len(each.greedy_path()) - 1 for each in _cliff(name, 0.1)} for name in ("q-learning", "sarsa")
    }
    truth = "q-learning" if max(steps["q-learning"]) < min(steps["sarsa"]) else "sarsa"
    return Finding(
        truth,
        {
            "Q-learning's, since its way is shorter": "q-learning",
            "SARSA's, since it falls less often": "sarsa",
            "Both the same, since both reach G": "alike",
        },
    )


TABLES: dict[str, Derivation] = {
    "second-success": second_success,
    "three-moves-away": three_moves_away,
    "never-explores": never_explores,
    "off-policy": off_policy,
    "smaller-alpha": smaller_alpha,
    "falls-while-learning": falls_while_learning,
    "sarsa-without-exploring": sarsa_without_exploring,
    "sarsa-target-needs": sarsa_target_needs,
    "edge-step": edge_step,
    "tested-on-the-cliff": tested_on_the_cliff,
}
