"""What the lesson on generalisation says is found out again, by trainings on one side and on both."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path
from types import MappingProxyType
from typing import Final

import numpy as np

from kit.learning.environment.episode_stats import EpisodeStats
from kit.learning.environment.mirror import TaskMirror
from kit.learning.policies.evaluation import Evaluator
from kit.learning.policies.seeds import derive_seed
from kit.learning.tasks.actions import Move
from kit.learning.tasks.task_spec import TaskSpec
from kit.learning.training.algorithms import find_algorithm
from kit.learning.training.presets import find_preset
from kit.learning.training.training import make_learner
from kit.school.lessons.records import LessonStep

RIGHT_CASE, LEFT_CASE = "turn_a_to_b", "turn_b_to_a"
STEPS: Final = MappingProxyType({(RIGHT_CASE,): 100_000, (LEFT_CASE,): 100_000, (): 150_000})
SEEDS: Final = (1, 2, 3)
EPISODES: Final = 100


class _Unwatched:
    """Callbacks of a training that nobody watches."""

    def between_updates(self) -> None: ...

    def on_episode_end(self, episode: EpisodeStats) -> None: ...


@cache
def cross_table() -> dict[tuple[str, ...], dict[str, float]]:
    """By what was trained on: the mean share of each case, over several trainings."""
    algorithm, evaluator = find_algorithm("sarsa"), Evaluator(TaskSpec("turn").resolve())
    found = {}
    for on, steps in STEPS.items():
        shares: dict[str, list[float]] = {RIGHT_CASE: [], LEFT_CASE: []}
        for seed in SEEDS:
            choice = TaskSpec("turn", on=on, reward="progress")
            task = choice.resolve()
            learner = make_learner(
                algorithm, find_preset("kit", algorithm, task.preset), choice, task, seed=seed
            )
            learner.learn(steps, _Unwatched())
            exam = evaluator.test(learner.policy(), EPISODES, derive_seed(seed, "exam"))
            for case in exam.cases:
                shares[case.case].append(case.share)
        found[on] = {case: float(np.mean(each)) for case, each in shares.items()}
    return found


def one_sided(words: str, step: LessonStep, folder: Path) -> str:
    """Cells of the table, in the order in which the words name them."""
    right, left, both = (cross_table()[on] for on in STEPS)
    if words == "0.06":
        return f"{right[LEFT_CASE]:.2f}"
    if not words.startswith(("right", "left", "worst")):
        return re.sub(r"0\.\d+", f"{right[RIGHT_CASE]:.2f}", words)
    name = words.split()[0]
    columns = [right] if words.count(".") == 1 else [right, left, both]
    shares = {
        "right": [each[RIGHT_CASE] for each in columns],
        "left": [each[LEFT_CASE] for each in columns],
        "worst": [min(each.values()) for each in columns],
    }[name]
    head = name if name == "worst" else f"{name} turn"
    return f"{head} {' '.join(f'{share:.2f}' for share in shares)}"


def one_sided_steps(words: str, step: LessonStep, folder: Path) -> str:
    if "both" in words:
        return f"those on both sides had {STEPS[()]:,} steps, the others {STEPS[RIGHT_CASE,]:,}"
    return f"for {STEPS[RIGHT_CASE,]:,} steps"


def mirrored_step(words: str, step: LessonStep, folder: Path) -> str:
    """By the mirror that the kit trains with, of a task whose two sides are alike."""
    task = TaskSpec("hallway").resolve()
    mirror = TaskMirror(task)
    seen = np.arange(task.observation.frame_size, dtype=np.float32)[None]
    first = (
        task.observation.scan_size - task.observation.sector_count + 1
    )  # the one before lies on the mirror's axis
    sectors = slice(first, task.observation.scan_size)
    turned, before = mirror.observations(seen)[0, sectors], seen[0, sectors]
    order = "in reverse order" if (turned == before[::-1]).all() else "as they are"
    moves = list(task.actions.moves)
    ((action,),) = mirror.actions(np.array([[moves.index(Move.LEFT)]]))
    side = moves[int(action)].name.lower()
    return f"The distances {order}, action {side}, reward 0.2."


GENERALISATION_DERIVATIONS: Final = (one_sided, one_sided_steps, mirrored_step)
