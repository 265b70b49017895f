"""Tasks that are handed in: what is read of them, which loops are found, and policies beside them."""

from __future__ import annotations

import math
import re
import shutil
from dataclasses import replace
from pathlib import Path

import pytest

from grader.evidence.submission_clock import SubmissionClock
from grader.evidence.training_results import PosedTaskPlan
from grader.grading import GradingOptions, grade
from grader.kinds.task.posed_task import ActionLoop, PosedTask
from grader.reading import read_assignment
from grader.submission import Submission
from kit.host.sandbox.probe import highest_level_up_to
from kit.host.sandbox.sandbox_config import Level
from kit.learning.policies.policy import task_interface
from kit.learning.policies.policy_file import policy_bytes
from kit.learning.tasks.task_spec import TaskSpec
from kit.results.grading_result import CriterionStatus, GradingResult
from kit.school.lessons.reading import lessons_folder, solutions_folder
from kit.world.problems import WorldError
from tests.learning.policies.test_evaluation import always

ASSIGNMENT_TEXT = """
title: Straight ahead
kind: task
submit: task.yaml
level: 0
task: {algorithm: q-learning, steps: 4000, trainings: 1, episodes: 20, policy: best.npz}
checks:
  - {check: sound, points: 1}
  - {check: places, points: 1, with: {start: "0.3 0.2 1 1", target: "0.3 2 1 2.8"}}
  - {check: way, points: 1, share: {none: 0.5, full: 1.5}}
  - {check: loops, points: 1}
  - {check: arrives, points: 1}
  - {check: quick, points: 1}
"""
TASK = """\
summary: Straight ahead
maps: [hall_straight]
cases: [{name: up, start: [0.625, 0.5, 1.5708], target: [0.625, 2.5]}]
actions: {twists: {back: [-0.3, 0], forward: [0.3, 0]}}
observation: {sectors: 5}
reward: {terms: {progress: 1.0, collided: -1.0, reached: 1.0}}
target: {radius: 0.3}
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    made = tmp_path / "ahead"
    made.mkdir()
    (made / "assignment.yaml").write_text(ASSIGNMENT_TEXT)
    return made


def graded(folder: Path, text: str, policy: bytes | None = None) -> GradingResult:
    files = {"task.yaml": text.encode()} | ({} if policy is None else {"best.npz": policy})
    return grade(
        read_assignment(folder), Submission("ada", "task.yaml", files), GradingOptions(Level.LIMITED)
    )


def policy(folder: Path, action: int) -> bytes:
    """A policy for the task that always does the same."""
    (folder / "own.yaml").write_text(TASK)
    choice = TaskSpec(str(folder / "own.yaml")).frozen()
    found = replace(always(choice, action), interface=task_interface(choice.resolve()))
    (folder / "own.yaml").unlink()
    return policy_bytes(found)


def points(result: GradingResult) -> dict[str, float]:
    return {each.id: each.points for each in result.tests}


def test_a_sound_task_with_a_policy_that_arrives_earns_everything(folder: Path) -> None:
    assert min(points(graded(folder, TASK, policy(folder, 1))).values()) >= 0.9


@pytest.mark.long
def test_a_loop_that_pays_is_named_with_what_it_earns(folder: Path) -> None:
    result = graded(folder, TASK.replace("progress: 1.0", "progress: 1.0, elapsed: 0.1"), policy(folder, 1))
    (loops,) = (each for each in result.tests if each.id == "loops")
    assert loops.points == 0.0
    assert "again and again" in loops.rationale
    assert "earns" in loops.rationale


@pytest.mark.long
def test_a_policy_that_fails_or_is_missing_costs_its_own_criteria(folder: Path) -> None:
    without = graded(folder, TASK)
    for found in (without, graded(folder, TASK, policy(folder, 0)), graded(folder, TASK, b"x")):
        assert points(found)["arrives"] == points(found)["quick"] == 0.0
        assert points(found)["sound"] == points(found)["way"] == 1.0
    (missing,) = (each for each in without.tests if each.id == "arrives")
    assert "There is no best.npz" in missing.rationale


@pytest.mark.parametrize(
    ("words", "others", "told"),
    [
        ("maps: [hall_straight]", "maps: [nowhere]", "nowhere"),
        (
            "start: [0.625, 0.5, 1.5708]",
            "start: [0, 0, 0]",
            "the start (0, 0) is inside a wall, or off the floor",
        ),
        ("terms: {progress: 1.0, collided: -1.0, reached: 1.0}", "file: reward.py", "reward.py"),
        ("target: {radius: 0.3}", "target: {radius: 0.51}", "almost anywhere"),
        (
            "cases: [{",
            "cases: ["
            + "".join(
                f"{{name: c{n}, start: [0.625, 0.5, 1.5708], target: [0.625, 2.5]}}, " for n in range(8)
            )
            + "{",
            "too many",
        ),
        (
            "twists: {back: [-0.3, 0], forward: [0.3, 0]}",
            "linear: [0, 1], angular: [-1, 1]",
            "discrete actions",
        ),
    ],
)
def test_what_cannot_be_used_is_told_and_earns_nothing(
    folder: Path, words: str, others: str, told: str
) -> None:
    result = graded(folder, TASK.replace(words, others))
    assert set(points(result).values()) == {0.0}
    assert told in result.tests[0].rationale
    assert str(folder) not in result.tests[0].rationale
    assert all(each.status is not CriterionStatus.GRADER_ERROR for each in result.tests)


def test_where_episodes_begin_is_said_of_no_task_that_cannot_be_used() -> None:
    """The lesson asks for places first: then its cause is all that is told."""
    result = graded(lessons_folder() / "24-train-your-own" / "pays", "map: [turn\n")
    assert result.tests[0].rationale.startswith("task.yaml:1:6: not valid YAML")
    assert result.tests[0].rationale.count(".") < 4


@pytest.mark.long
def test_places_elsewhere_are_named(folder: Path) -> None:
    result = graded(folder, TASK.replace("target: [0.625, 2.5]", "target: [0.625, 1.5]"))
    (places,) = (each for each in result.tests if each.id == "places")
    assert places.points == 0.0
    assert "(0.625, 1.5)" in places.rationale


def test_a_policy_is_named_as_a_file_beside_the_task(folder: Path) -> None:
    (folder / "assignment.yaml").write_text(ASSIGNMENT_TEXT.replace("best.npz", "../best.npz"))
    with pytest.raises(WorldError, match="beside the task"):
        read_assignment(folder)


def test_a_loop_whose_sum_has_no_value_is_no_loop_that_loses(tmp_path: Path) -> None:
    """Neither "as much or more" nor "less" is true of it."""
    (tmp_path / "task.yaml").write_text(TASK)
    plan = PosedTaskPlan("q-learning", 1_000, 1, 10, "", 1, None)
    posed = PosedTask(tmp_path / "task.yaml", plan, 1, SubmissionClock())
    posed.__dict__["arriving_reward"] = 1.0
    posed.__dict__["loops"] = tuple(
        ActionLoop(("forward",), (1,), total, is_arriving=False) for total in (0.5, math.nan, math.inf)
    )
    assert not math.nan >= 1.0
    assert len(posed.paying_loops) == 2


@pytest.mark.parametrize(("enough", "made"), [(0.2, 2), (1.0, 3)])
def test_once_most_trainings_are_good_enough_no_further_one_is_made(
    tmp_path: Path, enough: float, made: int
) -> None:
    (tmp_path / "task.yaml").write_text(TASK)
    plan = PosedTaskPlan("q-learning", 2_000, 3, 20, "", 1, None, enough)
    posed = PosedTask(tmp_path / "task.yaml", plan, 1, SubmissionClock())
    exams = sorted(each.sure_success for each in posed.results.trainings)
    assert len(exams) == made
    assert posed.measure("learns", {}).value == exams[-2] > 0.2


@pytest.mark.parametrize(
    ("terms", "arriving", "pays"),
    [
        ("{forward: 20.0, collided: -1.0}", 9.3, True),
        ("{progress: 1.0, collided: -1.0, reached: 1.0}", 3.5, False),
    ],
)
def test_driving_back_and_forth_is_a_loop_too(
    tmp_path: Path, terms: str, arriving: float, *, pays: bool
) -> None:
    """In a narrow ward any circle ends in a wall. ``arriving``: what a drive to the target earns, about."""
    ward = shutil.copytree(solutions_folder() / "24-train-your-own" / "ward" / "solution", tmp_path / "ward")
    file = Path(ward, "task.yaml")
    file.write_text(re.sub(r"terms: \{[^}]*\}", f"terms: {terms}", file.read_text()))
    posed = PosedTask(file, PosedTaskPlan("q-learning", 1_000, 1, 10, "", 1, None), 1, SubmissionClock())
    posed.__dict__["arriving_reward"] = arriving
    assert [each.actions[0] for each in posed.paying_loops[:1]] == (["forward"] if pays else [])
    assert bool(posed.paying_loops) == pays
    assert not pays or "21 steps" in str(posed.paying_loops[0])


@pytest.mark.long
def test_a_task_with_the_target_beside_the_start_earns_nothing_in_the_lesson() -> None:
    """Its reward alone is asked for: a shorter way would be a way out."""
    solution = (solutions_folder() / "24-train-your-own" / "pays" / "solution.yaml").read_text()
    near = "cases: [{name: turn_a_to_b, start: [0, 0, 1.5708], target: [0, 0.5]}]"
    changed = solution.replace('"on": [turn_a_to_b]', near)
    assert changed != solution
    assignment = read_assignment(lessons_folder() / "24-train-your-own" / "pays")
    found = grade(
        assignment,
        Submission("ada", "task.yaml", {"task.yaml": changed.encode()}),
        GradingOptions(Level.LIMITED),
    )
    assert found.points == 0.0
    assert "(0, 0.5)" in found.tests[0].rationale


@pytest.mark.long
def test_a_confined_task_earns_what_another_one_does(folder: Path) -> None:
    files = {"task.yaml": TASK.encode(), "best.npz": policy(folder, 1)}
    assignment = read_assignment(folder)
    found = [
        points(grade(assignment, Submission("ada", "task.yaml", files), GradingOptions(level)))
        for level in (Level.LIMITED, highest_level_up_to(Level.FILTERED))
    ]
    assert found[0] == found[1]
