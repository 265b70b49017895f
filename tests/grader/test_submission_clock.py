"""The wall clock of a whole submission binds every kind of work, and what was shown before keeps its points."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from grader.budgets import default_submission_limit_s
from grader.grading import GradingOptions, grade
from grader.reading import read_assignment
from grader.submission import Submission, read_submission
from kit.host.sandbox.limits import GRADER_LIMITS
from kit.host.sandbox.sandbox_config import Level
from kit.learning.policies.policy_file import policy_bytes
from kit.results.grading_result import CriterionStatus, GradingResult, GradingVerdict
from tests.grader.conftest import FORWARD, TEMPLATES, write_assignment
from tests.grader.kinds import (
    test_field,
    test_function,
    test_policy,
    test_training,
)
from tests.grader.kinds.environment import test_kind as test_environment
from tests.grader.kinds.reward import test_kind as test_reward

LESSONS = Path(__file__).parents[2] / "lessons"
SOLUTIONS = Path(__file__).parents[1] / "solutions"
DESK = GradingOptions(Level.LIMITED)
USED_UP = "that a submission may take are used up"
TOO_SHORT = "budget: {submission: 0.01}\n"
"""No work of any kind ends within ten milliseconds: starting Python takes longer."""

REWARD = """
title: R
kind: reward
submit: reward.py
level: 0
grid: {map: "#####\\n#..G#\\n#...#\\n#####"}
checks: [{check: planned, points: 1}]
"""


def _with_own_text(folder: Path, text: str, name: str, source: str) -> tuple[Path, Path]:
    write_assignment(folder, text + TOO_SHORT)
    work = folder.parent / name
    work.write_text(source)
    return folder, work


def _of_a_lesson(folder: Path, lesson: str, work: str) -> tuple[Path, Path]:
    shutil.copytree((LESSONS / lesson).parent, folder, ignore=shutil.ignore_patterns("secret.yaml"))
    made = folder / Path(lesson).name
    (made / "assignment.yaml").write_text((made / "assignment.yaml").read_text() + TOO_SHORT)
    return made, SOLUTIONS / lesson / work


def honest_work(kind: str, folder: Path) -> tuple[Path, Path]:
    """An assignment whose whole budget is ten milliseconds, and a right work for it."""
    if kind == "controller":
        text = (TEMPLATES / "controller" / "assignment.yaml").read_text()
        return _with_own_text(folder, text, "controller.py", FORWARD)
    if kind == "function":
        text = test_function.ASSIGNMENT_TEXT.partition("budget:")[0]
        made = _with_own_text(folder, text, "scans.py", test_function.NEAREST + test_function.HALVES)
        (folder / "reference.py").write_text(test_function.REFERENCE)
        return made
    if kind == "environment":
        text = test_environment.ASSIGNMENT_TEXT.partition("budget:")[0]
        return _with_own_text(folder, text, "hallway_env.py", test_environment.GOOD.read_text())
    if kind == "training":
        return _with_own_text(folder, test_training.ASSIGNMENT_TEXT, "training.yaml", "batch: 5000\n")
    if kind == "field":
        text = test_field.ASSIGNMENT_TEXT.replace("FX", "1").replace("FY", "1")
        return _with_own_text(folder, text, "charges.yaml", test_field.GOOD)
    if kind == "reward":
        return _with_own_text(folder, REWARD, "reward.py", test_reward.source("sparse"))
    if kind == "policy":
        made = _with_own_text(folder, test_policy.ASSIGNMENT_TEXT, "best.npz", "")
        (folder / "ahead.yaml").write_text(test_policy.TASK)
        made[1].write_bytes(policy_bytes(test_policy.policy(folder, 1)))
        return made
    if kind == "drive":
        return _of_a_lesson(folder, "01-drive/flag", "solution.npz")
    if kind == "launch":
        return _of_a_lesson(folder, "04-launch-files/driver", "solution.py")
    assert kind == "world"
    shutil.copytree(TEMPLATES / "world", folder, ignore=shutil.ignore_patterns("secret.yaml"))
    (folder / "assignment.yaml").write_text((folder / "assignment.yaml").read_text() + TOO_SHORT)
    return folder, folder / "solution"


KINDS = (
    *("controller", "function", "environment", "training", "field"),
    *("reward", "launch", "world", "drive", "policy"),
)
"""All but ``answers`` and ``plan``, which are read and never run."""


@pytest.mark.long
@pytest.mark.parametrize("kind", KINDS)
def test_it_binds_every_kind(kind: str, tmp_path: Path) -> None:
    folder, work = honest_work(kind, tmp_path / "assignment")
    assignment = read_assignment(folder)
    result = grade(assignment, read_submission(work, assignment.submit), DESK)
    assert result.verdict is GradingVerdict.FAIL
    assert result.points == 0.0
    judged = [test for test in result.tests if test.status is not CriterionStatus.SKIPPED]
    assert judged
    assert {test.status for test in judged} == {CriterionStatus.TIMEOUT}
    assert USED_UP in judged[0].rationale


HANGS_WHEN_TOLD = FORWARD.replace(
    'super().__init__("forward")', 'super().__init__("forward"); self.declare_parameter("hang", False)'
).replace(
    "    def go(self):\n",
    '    def go(self):\n        while self.get_parameter("hang").value: pass\n',
)
SOME_HANG = """
title: Some hang
submit: controller.py
level: 0
trials:
  - {name: well, place: turn, time: 1, seeds: [1]}
  - {name: hanging, place: turn, time: 1, seeds: [1, 2, 3], parameters: ["hang:=true"]}
checks: [{check: runs, points: 4}]
"""


def _some_hang(tmp_path: Path, budget: str) -> GradingResult:
    folder = write_assignment(tmp_path / "q", SOME_HANG + budget)
    return grade(
        read_assignment(folder),
        Submission("ada", "controller.py", {"controller.py": HANGS_WHEN_TOLD.encode()}),
        DESK,
    )


@pytest.mark.long
def test_after_two_that_took_too_long_no_other_is_run_and_points_so_far_stay(tmp_path: Path) -> None:
    (test,) = _some_hang(tmp_path, "budget: {reply: 0.5}\n").tests
    assert [each.outcome for each in test.episodes][1:] == [
        "stopped (timeout)",
        "stopped (timeout)",
        "not run",
    ]
    assert (test.status, test.points) == (CriterionStatus.PARTIAL, 1.0)


@pytest.mark.long
def test_what_is_used_up_ends_the_episode_that_runs(tmp_path: Path) -> None:
    """The program runs longer than the submission may take, which is less than a reply may take."""
    (test,) = _some_hang(tmp_path, "budget: {reply: 60, submission: 4}\n").tests
    assert test.episodes[-1].outcome == "not run"
    assert test.status in (CriterionStatus.PARTIAL, CriterionStatus.TIMEOUT)  # a very slow machine
    assert USED_UP in test.rationale


@pytest.mark.long
def test_a_teachers_test_of_what_was_not_run_is_no_fault_of_the_graders(tmp_path: Path) -> None:
    text = SOME_HANG + "tests: [test_own.py]\n" + TOO_SHORT
    folder = write_assignment(tmp_path / "q", text)
    (folder / "test_own.py").write_text(
        "import pytest\n\n@pytest.mark.points(2)\ndef test_it_drives(grading):\n"
        "    assert all(drive.track[0, 0] < 100 for drive in grading.evidence('runs'))\n"
    )
    result = grade(
        read_assignment(folder), Submission("ada", "controller.py", {"controller.py": FORWARD.encode()}), DESK
    )
    assert [test.status for test in result.tests] == [CriterionStatus.TIMEOUT] * 2
    assert result.verdict is GradingVerdict.FAIL


@pytest.mark.long
def test_an_error_of_the_program_is_no_fault_of_a_teachers_test(tmp_path: Path) -> None:
    folder = write_assignment(tmp_path / "q", SOME_HANG + "tests: [test_own.py]\n")
    (folder / "test_own.py").write_text(
        "import pytest\n\n@pytest.mark.points(2)\ndef test_it_drives(grading):\n"
        "    assert grading.evidence('runs')[0].track[0, 0] < 100\n"
    )
    work = Submission("ada", "controller.py", {"controller.py": b"x = 1 / 0\n"})
    result = grade(read_assignment(folder), work, DESK)
    assert result.tests[-1].status is CriterionStatus.STUDENT_ERROR
    assert "controller.py:1" in result.tests[-1].rationale


@pytest.mark.long
def test_the_default_stays_below_a_ci_runners_patience_and_above_what_one_process_may_take(
    tmp_path: Path,
) -> None:
    every = sorted((*LESSONS.glob("*/*/assignment.yaml"), *TEMPLATES.glob("*/assignment.yaml")))
    assert every
    for file in every:
        limit_s = read_assignment(file.parent).submission_limit_s
        assert 135.0 <= limit_s <= 600.0, file
    assert default_submission_limit_s((), GRADER_LIMITS) == 600.0
