"""What the lesson on PPO says is found out again, by policies that learn the floor that it shows."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Final

import numpy as np

from kit.learning.grid.chances import softmax
from kit.learning.grid.grid_learner import MAX_EPISODE_STEPS, GridLearnerSettings
from kit.learning.grid.grid_world import GridWorld
from kit.learning.grid.ppo import EPOCHS, GAE_LAMBDA, HORIZON, PpoLearner
from kit.learning.training.algorithms import find_algorithm
from kit.learning.training.presets import find_preset
from kit.school.lessons.records import LessonStep
from tests.kit_content import lesson_reference
from tests.school.lessons.table_derivations import scene_of

COUNTS: Final = {8: "eight", 10: "ten"}
SEEDS: Final = 4


@cache
def policy_of(world: GridWorld, settings: GridLearnerSettings, updates: int) -> PpoLearner:
    """After so many steps; not to be changed."""
    learner = PpoLearner(world, settings)
    while learner.updates < updates:
        learner.step()
    return learner


def policies_of(step: LessonStep) -> list[PpoLearner]:
    scene = scene_of(step)
    return [policy_of(scene.world, each, scene.updates) for each in scene.learners]


def equal_chances(words: str, step: LessonStep, folder: Path) -> str:
    scene = scene_of(step)
    chances = PpoLearner(scene.world, scene.learners[0]).values
    assert chances.min() == chances.max()
    shown = f"{chances.min():g}"
    return f"At first all four are {shown}" if words.startswith("At") else f"Still about {shown}"


def sure_of_the_way(words: str, step: LessonStep, folder: Path) -> str:
    (learner,) = policies_of(step)
    assert learner.is_solved
    along = [learner.values[cell].max() for cell in learner.greedy_path()[:-1]]
    assert min(along) > 0.9
    return "Close to 1, all along the way."


def usual_lambda(words: str, step: LessonStep, folder: Path) -> str:
    return f"lambda, mostly {GAE_LAMBDA:g}"


def one_push(words: str, step: LessonStep, folder: Path) -> str:
    """The slope of the log of a chance by differences, in place of the lines that the step shows; and those lines."""
    scores = np.zeros(4)
    chances = softmax(scores)

    def log_chance(number: int, change: float) -> float:
        changed = scores.copy()
        changed[number] += change
        return float(np.log(softmax(changed)[0]))

    slope = np.array([(log_chance(at, 1e-6) - log_chance(at, -1e-6)) / 2e-6 for at in range(4)])
    assert np.allclose(slope, [1 - chances[0], *(-chances[1:])], atol=1e-6)
    lifted = softmax(scores + slope)[0]
    return f"From four chances of {chances[0]:g}, an advantage of 1 and a rate of 1 lift the move made to {lifted:.3f}"


def epochs_of_a_batch(words: str, step: LessonStep, folder: Path) -> str:
    return f"Each batch of steps is used {COUNTS[EPOCHS]} times"


def clip_range(words: str, step: LessonStep, folder: Path) -> str:
    clips = [each.clip for each in scene_of(step).learners]
    assert clips[1] == 0
    return f"once a chance is { {0.2: 'a fifth'}[clips[0]] } larger or smaller"


def without_clipping(words: str, step: LessonStep, folder: Path) -> str:
    """The clipped one arrives; the other's chances are all but certain, and its episodes end by the clock."""
    clipped, other = policies_of(step)
    assert clipped.is_solved
    assert not other.is_solved
    assert other.values[other.world.start].min() < 1e-3
    assert set(other.lengths[-2:]) == {MAX_EPISODE_STEPS}
    if words.startswith("with a chance"):
        return "with a chance of nearly 0 is hardly ever tried again"
    return "It is soon sure of bad moves, and stays stuck."


def flat_objective(words: str, step: LessonStep, folder: Path) -> str:
    """Where the exercise's objective no longer changes, searched in hundredths."""
    objective = lesson_reference("23-inside-ppo", "clipping").objective
    ratios = [ratio / 100 for ratio in range(50, 200)]

    def is_flat(ratio: float, advantage: float) -> bool:
        near = [objective(each / 4, 0.25, advantage, 0.2) for each in (ratio, ratio + 0.005)]
        return abs(near[0] - near[1]) < 1e-9

    if "negative" in words:
        last = max(ratio for ratio in ratios if is_flat(ratio, -1.0))
        return f"With a negative one it is flat below {last + 0.01:g}"
    first = min(ratio for ratio in ratios if is_flat(ratio, 1.0))
    return f"With a positive advantage it grows with the ratio, up to {first:g}"


def entropy_of_certain(words: str, step: LessonStep, folder: Path) -> str:
    entropy = lesson_reference("23-inside-ppo", "clipping").entropy
    assert entropy([0.25] * 4) > entropy([0.4, 0.2, 0.2, 0.2]) > entropy([0.9, 0.1, 0, 0])
    return f"{abs(entropy([1.0, 0.0, 0.0, 0.0])):g} when one move is certain"


def steps_between_updates(words: str, step: LessonStep, folder: Path) -> str:
    scene = scene_of(step)
    learner, count = PpoLearner(scene.world, scene.learners[0]), 0
    before = learner.logits.copy()
    while (learner.logits == before).all():
        learner.step()
        count += 1
    assert count == HORIZON
    return f"Between two updates each world makes {count} steps"


def world_counts(words: str, step: LessonStep, folder: Path) -> str:
    counts = [each.worlds for each in scene_of(step).learners]
    assert counts[1] == 1
    return f"collects them in {COUNTS[counts[0]]} worlds at once"


def one_world(words: str, step: LessonStep, folder: Path) -> str:
    """Over several seeds: how much the length of the last episodes differs from training to training."""
    scene = scene_of(step)
    lengths = []
    for settings in scene.learners:
        many = [policy_of(scene.world, replace(settings, seed=seed), scene.updates) for seed in range(SEEDS)]
        lengths.append([float(np.mean(each.lengths[-10:])) for each in many])
    eight, one = lengths
    assert np.std(one) > 3 * np.std(eight)
    assert np.mean(one) > np.mean(eight)
    return "Its updates are more a matter of luck."


def worlds_of_the_kit(words: str, step: LessonStep, folder: Path) -> str:
    return f"in {find_preset('kit', find_algorithm('ppo'), 'turn').worlds} worlds at once"


POLICY_DERIVATIONS: Final = (
    equal_chances,
    sure_of_the_way,
    usual_lambda,
    one_push,
    epochs_of_a_batch,
    clip_range,
    without_clipping,
    flat_objective,
    entropy_of_certain,
    steps_between_updates,
    world_counts,
    one_world,
    worlds_of_the_kit,
)
