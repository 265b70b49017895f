"""Numbers of assignments go up to their limits: the last one is taken, the next one is told with its limit."""

from __future__ import annotations

import re
import shutil
from pathlib import Path
from typing import NamedTuple

import pytest

from grader.assignment import MAX_HINTS
from grader.budgets import MAX_SUBMISSION_LIMIT_S
from grader.kinds.controller import kind as controller
from grader.kinds.drive import kind as drive
from grader.kinds.environment import kind as environment
from grader.kinds.launch import kind as launch
from grader.kinds.policy import kind as policy
from grader.kinds.reward import kind as reward
from grader.kinds.task import kind as task
from grader.kinds.training import kind as training
from grader.kinds.world import kind as world
from grader.reading import read_assignment
from grader.scoring import MAX_SHARE_STEPS
from grader.seeds import MAX_SEED
from kit.school.lessons.reading import lessons_folder
from kit.world.problems import WorldError
from tests.grader.conftest import QUICK, TEMPLATES, write_assignment
from tests.grader.kinds.test_policy import ASSIGNMENT_TEXT as POLICY
from tests.grader.kinds.test_policy import TASK as POLICY_TASK


class Setting(NamedTuple):
    """A setting of an assignment: what stands there now, and what it may be."""

    now: str
    most: str
    beyond: str
    message: str


def number(now: str, most: float) -> Setting:
    """A number after its key, ``time: 4``."""
    key = now.partition(":")[0]
    return Setting(
        now,
        f"{key}: {most:.9g}",
        f"{key}: {most + 1:.9g}",
        f"at most {most if isinstance(most, int) else f'{most:g}'}",
    )


def hints(count: int) -> str:
    return f"hints: [{', '.join('abcdefgh'[:count])}]"


def seeds(count: int) -> str:
    return f"seeds: [{', '.join(map(str, range(count)))}]"


def grid(size: int) -> str:
    """A map of that many rows and columns, with a target in it."""
    rows = ["#" * size, f"#G{'.' * (size - 3)}#", *["#" + "." * (size - 2) + "#"] * (size - 3), "#" * size]
    return "map: |\n" + "".join(f"    {row}\n" for row in rows)


EVERY_KIND = [
    number("time: 4", controller.MAX_EPISODE_S),
    Setting("seeds: [1]", f"seeds: [{MAX_SEED}]", f"seeds: [{MAX_SEED + 1}]", "seeds"),
    Setting("hints: [one, two, three]", hints(MAX_HINTS), hints(MAX_HINTS + 1), f"at most {MAX_HINTS} hints"),
    Setting(
        "share: {none: 0",
        f"share: {{steps: {MAX_SHARE_STEPS}, none: 0",
        f"share: {{steps: {MAX_SHARE_STEPS + 1}, none: 0",
        f"at most {MAX_SHARE_STEPS}",
    ),
    Setting(
        "title: Drive on",
        f"title: Drive on\nbudget: {{submission: {MAX_SUBMISSION_LIMIT_S}}}",
        f"title: Drive on\nbudget: {{submission: {MAX_SUBMISSION_LIMIT_S + 1}}}",
        f"at most {MAX_SUBMISSION_LIMIT_S:g}",
    ),
]
OF_LESSONS = [
    ("01-drive/flag", number("time: 180", drive.MAX_TIME_S)),
    ("04-launch-files/driver", number("time: 4", launch.MAX_RUN_S)),
    ("10-words-of-learning/hallway", number("max_steps: 200", environment.MOST_STEPS)),
    ("24-train-your-own/pays", number("steps: 60000", task.MAX_STEPS)),
    ("24-train-your-own/pays", number("trainings: 3", task.MAX_TRAININGS)),
    ("24-train-your-own/pays", number("episodes: 100", task.MAX_EPISODES)),
    ("12-training-strategies/forget", number("steps: 80000", training.MAX_STEPS)),
    (
        "12-training-strategies/forget",
        Setting(
            "seeds: [10, 11, 12]",
            seeds(training.MAX_SEEDS),
            seeds(training.MAX_SEEDS + 1),
            f"at most {training.MAX_SEEDS}",
        ),
    ),
]


def check(folder: Path, setting: Setting) -> None:
    """``folder``: of an assignment that is sound."""
    file = folder / "assignment.yaml"
    text = file.read_text()
    assert re.search(rf"{re.escape(setting.now)}(?!\d)", text), f"{setting.now} is not in the assignment"
    file.write_text(re.sub(rf"{re.escape(setting.now)}(?!\d)", lambda _: setting.most, text, count=1))
    read_assignment(folder)
    file.write_text(re.sub(rf"{re.escape(setting.now)}(?!\d)", lambda _: setting.beyond, text, count=1))
    with pytest.raises(WorldError, match=re.escape(setting.message)):
        read_assignment(folder)


@pytest.mark.parametrize("setting", EVERY_KIND, ids=lambda setting: setting.now.partition(":")[0])
def test_numbers_of_any_assignment(setting: Setting, tmp_path: Path) -> None:
    check(write_assignment(tmp_path / "quick", QUICK), setting)


@pytest.mark.parametrize(("exercise", "setting"), OF_LESSONS, ids=lambda each: str(each)[:40])
def test_numbers_of_a_kind(exercise: str, setting: Setting, tmp_path: Path) -> None:
    check(Path(shutil.copytree(lessons_folder() / exercise, tmp_path / "copy")), setting)


def test_numbers_of_a_policy(tmp_path: Path) -> None:
    folder = write_assignment(tmp_path / "policy", POLICY)
    (folder / "ahead.yaml").write_text(POLICY_TASK)
    check(folder, number("episodes: 40", policy.MAX_EPISODES))


def test_the_time_of_a_world(tmp_path: Path) -> None:
    check(Path(shutil.copytree(TEMPLATES / "world", tmp_path / "world")), number("time: 30", world.MAX_RUN_S))


def test_the_map_of_a_reward(tmp_path: Path) -> None:
    folder = Path(shutil.copytree(TEMPLATES / "reward", tmp_path / "reward"))
    file = folder / "assignment.yaml"
    text = file.read_text()
    before, after = text[: text.index("map: |")], text[text.index("checks:") :]
    file.write_text(f"{before}{grid(reward.MAX_GRID_SIZE)}\n{after}")
    read_assignment(folder)
    file.write_text(f"{before}{grid(reward.MAX_GRID_SIZE + 1)}\n{after}")
    with pytest.raises(WorldError, match=f"at most {reward.MAX_GRID_SIZE} by {reward.MAX_GRID_SIZE}"):
        read_assignment(folder)
