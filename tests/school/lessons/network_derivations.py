"""What the lesson on DQN says is found out again, by networks that learn the floor that it shows."""

from __future__ import annotations

import re
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import Final

import numpy as np

from kit.learning.grid.dqn import BATCH, HIDDEN, DqnLearner, ValueNetwork
from kit.learning.grid.grid_learner import GridLearnerSettings
from kit.learning.grid.grid_world import MOVE_NAMES, GridWorld
from kit.learning.training.algorithm_settings import TabularParams
from kit.school.lessons.records import LearningScene, LessonStep
from tests.kit_content import kit_lesson
from tests.school.lessons.table_derivations import SEEN, scene_of

MOST: Final = 0.8
HALF: Final = 0.5


@cache
def solved_after_each(
    world: GridWorld, settings: GridLearnerSettings, updates: int
) -> tuple[tuple[bool, ...], int]:
    """After each episode: whether the best moves lead to the target. And how many updates there were."""
    learner, found = DqnLearner(world, settings), []
    while learner.updates < updates:
        if learner.step().ended:
            found.append(learner.is_solved)
    return tuple(found), learner.updates


def shares_of(scene: LearningScene) -> list[float]:
    """Of each learner: the share of its episodes after which the best moves lead to the target."""
    many = [solved_after_each(scene.world, each, scene.updates)[0] for each in scene.learners]
    return [sum(each) / max(1, len(each)) for each in many]


def network_rewards(words: str, step: LessonStep, folder: Path) -> str:
    rewards = scene_of(step).world.rewards
    return f"A step costs {-rewards.step:g} and G pays {rewards.target:g}"


def one_network_update(words: str, step: LessonStep, folder: Path) -> str:
    scene = scene_of(step)
    learner = DqnLearner(scene.world, scene.learners[0])
    before = learner.values.copy()
    learner.step()
    assert (learner.values != before).all()
    return "All values of all cells." if words.startswith("All") else "each update moves every value"


def state_count(words: str, step: LessonStep, folder: Path) -> str:
    count = (len(TabularParams().edges) + 1) ** SEEN
    if "billion" in words:
        return f"With ten parts each it would have { {10**9: 'a billion'}[10**SEEN] }"
    return f"A robot with { {9: 'nine'}[SEEN] } distances, each near, middle or far, has {count:,} states"


def weight_count(words: str, step: LessonStep, folder: Path) -> str:
    network = ValueNetwork(np.random.default_rng(0), SEEN, len(MOVE_NAMES))
    count = sum(each.size for each in network.parameters)
    return f"A network with two layers of {HIDDEN} neurons that gets { {9: 'nine'}[SEEN] } distances has {count:,} weights"


def first_overshoot(words: str, step: LessonStep, folder: Path) -> str:
    """The first update of the lesson's first scene, as its line says it."""
    scene = scene_of(kit_lesson("22-inside-dqn").steps[0])
    update = DqnLearner(scene.world, scene.learners[0]).step()
    assert (update.after - update.target) * (update.before - update.target) < 0, "it stays on its side"
    return (
        f"the first update of the film took a value from {update.before:.2f} past its target, "
        f"{update.target:.2f}, to {update.after:.2f}"
    )


def two_flat_layers(words: str, step: LessonStep, folder: Path) -> str:
    """Of two layers without a bend: the one that gives the same for every input."""
    first, second = (float(each) for each in re.findall(r"\d", words)[:2])
    inputs = np.linspace(-2.0, 2.0, 9)
    (one,) = set(np.round((second * (first * inputs))[inputs != 0] / inputs[inputs != 0], 9))
    return f"{first:g} * ({second:g} * x) is {one:g} * x"


def bends(words: str, step: LessonStep, folder: Path) -> str:
    """Over sums of every size; ``tanh`` is what the networks of the scenes use."""
    sums = np.linspace(-50.0, 50.0, 1001)
    if words.startswith("holds"):
        bent = np.tanh(sums)
        return f"holds every sum between {bent.min():g} and {bent.max():g}"
    below = np.unique(np.maximum(sums, 0.0)[sums < 0])
    assert len(below) == 1
    return f"turns what is below 0 into {below[0]:g}"


def first_descent(words: str, step: LessonStep, folder: Path) -> str:
    """By a difference of the loss in place of its slope."""

    def loss(weight: float) -> float:
        return (1.0 * weight - 1.0) ** 2

    slope = (loss(1e-7) - loss(-1e-7)) / 2e-7
    return f"one input of 1, one weight of 0, target 1, rate 0.1. The weight becomes {-0.1 * slope:.1f}."


def buffer_sizes(words: str, step: LessonStep, folder: Path) -> str:
    kept = scene_of(step).learners[0].replay
    return f"keeps the last {kept:,} steps, and each update learns from {BATCH} of them"


def without_buffer(words: str, step: LessonStep, folder: Path) -> str:
    scene = scene_of(step)
    assert [each.replay for each in scene.learners] == [1000, 1]
    full, without = shares_of(scene)
    assert full > MOST
    assert without < 1 - MOST
    return "Next to nothing."


def copy_interval(words: str, step: LessonStep, folder: Path) -> str:
    return f"Every {scene_of(step).learners[0].target_interval} updates the copy is renewed"


def without_copy(words: str, step: LessonStep, folder: Path) -> str:
    scene = scene_of(step)
    assert scene.learners[1].target_interval == 1
    full, without = shares_of(scene)
    assert full > MOST
    assert 0.1 < without < HALF
    found, _ = solved_after_each(scene.world, scene.learners[1], scene.updates)
    changes = sum(one != other for one, other in pairwise(found))
    assert changes >= 6
    if words.startswith("It finds"):
        return "It finds the way, and loses it again and again."
    return "with the copy they lead to G after most episodes, without it after fewer than half"


NETWORK_DERIVATIONS: Final = (
    network_rewards,
    one_network_update,
    state_count,
    weight_count,
    first_overshoot,
    two_flat_layers,
    bends,
    first_descent,
    buffer_sizes,
    without_buffer,
    copy_interval,
    without_copy,
)
