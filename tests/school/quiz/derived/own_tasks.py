"""What tasks of one's own pay for, found out by learners and by driving in them."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from kit.learning.environment.batch import BatchEnv
from kit.learning.grid.grid_learner import GridLearnerSettings
from kit.learning.grid.grid_world import GridRewards, GridWorld
from kit.learning.grid.registry import make_grid_learner
from kit.learning.tasks.task_spec import TaskSpec
from kit.school.lessons.reading import lessons_folder
from kit.school.quiz.items import QuizItem
from tests.school.quiz.derived.finding import Derivation, Finding, nearest


def small_pay_for_living(item: QuizItem, folder: Path) -> Finding:
    """A table learns it, on a corridor."""
    world = GridWorld(("S.G", "..."), GridRewards(step=0.05))
    learner = make_grid_learner(world, GridLearnerSettings(alpha=0.5, gamma=0.9, epsilon=0.5, seed=0))
    while learner.episodes < 200:
        learner.step()
    return Finding(
        "target" if learner.is_solved else "on",
        {
            "It goes to the target, which is worth more": "target",
            "It goes on for ever, which is worth more": "on",
            "It does the one or the other, both are equal": "equal",
        },
    )


def progress_there_and_back(item: QuizItem, folder: Path) -> Finding:
    """Ten steps forward and ten back on the lesson's corner, paid by progress alone."""
    task = TaskSpec(str(lessons_folder() / "24-train-your-own" / "pays" / "starter.yaml")).resolve()
    batch = BatchEnv(task, 1, 3, autoreset=False)
    batch.reset()
    before, names = float(batch.state.to_go[0, 0]), list(task.actions.names)  # type: ignore[union-attr]  # a table
    for name in ["forward"] * 10 + ["back"] * 10:
        batch.step(np.array([names.index(name)]))
    earned = before - float(batch.state.to_go[0, 0])
    return Finding(
        round(earned, 2),
        {"Half of the weight": 0.5, "The whole weight": 1.0, "Nothing at all": 0.0},
    )


def crash_is_cheaper(item: QuizItem, folder: Path) -> Finding:
    """The best of the three, as the question has them; it takes a few steps to a wall."""
    earned = {"arrives": 10.0 - 90 * 1.0, "crashes": -2.0 - 5 * 1.0, "waits": -200 * 1.0}
    return Finding(
        max(earned, key=lambda each: earned[each]),
        {
            "It arrives as quickly as it can": "arrives",
            "It crashes as soon as it can": "crashes",
            "It stands and waits for the end": "waits",
        },
    )


def fewest_steps_for_a_way(item: QuizItem, folder: Path) -> Finding:
    return nearest(item, 5.0 / 0.5 / 0.1, 0.5)


def out_of_reach_in_time(item: QuizItem, folder: Path) -> Finding:
    """Full speed straight ahead for the ward's limit of 80 steps is less than its way."""
    way, speed, step_s = 3.65, 0.4, 0.1
    return Finding(
        "nothing" if 80 * step_s * speed < way else "luck",
        {
            "The robot drives faster in the end": "faster",
            "Nothing, as no episode ever arrives": "nothing",
            "A success now and then, by luck": "luck",
        },
    )


OWN_TASKS: dict[str, Derivation] = {
    "small-pay-for-living": small_pay_for_living,
    "progress-there-and-back": progress_there_and_back,
    "crash-is-cheaper": crash_is_cheaper,
    "fewest-steps-for-a-way": fewest_steps_for_a_way,
    "out-of-reach-in-time": out_of_reach_in_time,
}
