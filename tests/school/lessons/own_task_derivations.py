"""What the lesson on tasks of one's own says is found out again: by its learning scene, and by its solutions' tasks."""

from __future__ import annotations

import math
from functools import cache
from pathlib import Path
from typing import Final

from grader.evidence.submission_clock import SubmissionClock
from grader.evidence.training_results import PosedTaskPlan
from grader.kinds.task.posed_task import PosedTask
from kit.school.lessons.reading import solutions_folder
from kit.school.lessons.records import LessonStep
from tests.school.lessons.table_derivations import learners_of, scene_of

SOLUTIONS: Final = "24-train-your-own"
PLAN: Final = PosedTaskPlan("q-learning", 10_000, 1, 10, "", 1, None)


@cache
def posed(path: str) -> PosedTask:
    """The task of a solution."""
    return PosedTask(solutions_folder() / SOLUTIONS / path, PLAN, 1, SubmissionClock())


def living_rewards(words: str, step: LessonStep, folder: Path) -> str:
    scene = scene_of(step)
    (settings,) = scene.learners
    rewards, gamma = scene.world.rewards, settings.gamma
    for_ever = rewards.step / (1 - gamma)
    if words.startswith("each"):
        return f"each move earns {rewards.step:g}, and G pays {rewards.target:g}"
    return (
        f"Going on for ever is worth {rewards.step:g} / (1 - {gamma:g}), which is {for_ever:g}. "
        f"G is worth {rewards.target:g}."
    )


def living_never_arrives(words: str, step: LessonStep, folder: Path) -> str:
    """Its best moves at the end of the scene."""
    (learner,) = learners_of(step)
    assert not learner.is_solved
    if words.startswith("Where"):
        return f"Where do its best moves lead after {scene_of(step).episodes} episodes?"
    return "Not to G. It earns more by going on."


def progress_in_a_loop(words: str, step: LessonStep, folder: Path) -> str:
    """No loop of the solution's task earns anything worth mentioning, though some drive all the time."""
    loops = posed("pays/solution.yaml").loops
    assert any("back" in each.actions for each in loops)
    assert all(each.total_reward < 0.5 for each in loops if not each.is_arriving)
    return "takes it back for each metre away, so that a loop earns nothing."


def ward_way(words: str, step: LessonStep, folder: Path) -> str:
    task = posed("ward/solution/task.yaml")
    (way,), seconds, step_s = task.ways, task.shortest_seconds(), task.task.step_time
    speed = way / seconds
    texts = (
        f"the way from S to T is {way:.2f} m long",
        f"The robot drives at {speed:g} m/s, and one step takes {step_s:g} s",
        f"{way:.2f} m at {speed:g} m/s are more than {math.floor(seconds)} s even without a turn. 80 steps are {80 * step_s:g} s.",
        f"At full speed and without a turn the way takes {math.ceil(seconds / step_s)} steps",
    )
    return next((each for each in texts if each[:5] == words[:5]), texts[0])


OWN_TASK_DERIVATIONS: Final = (living_rewards, living_never_arrives, progress_in_a_loop, ward_way)
