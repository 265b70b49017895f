"""A teacher's own tests earn points, say what they mean, and are never taken from what lies around."""

from __future__ import annotations

import contextlib
import signal
import time
from pathlib import Path

import pytest

from grader.cohort.gradebook import gradebook_rows
from grader.cohort.queue import Queue, prepare_queue
from grader.grading import GradingOptions, grade
from grader.reading import read_assignment
from grader.submission import Submission
from grader.teacher_tests.deadline import TestDeadline, TestTimeUsedUp
from grader.teacher_tests.reading import read_teacher_tests
from kit.host.sandbox.sandbox_config import Level
from kit.results.grading_result import (
    CriterionResult,
    CriterionStatus,
    GradingResult,
    GradingVerdict,
    Visibility,
)
from kit.world.problems import WorldError
from tests.grader.conftest import FORWARD, LOCKS, QUICK, write_assignment
from tests.grader.test_grading import run_pytest

DESK = GradingOptions(Level.LIMITED)

OWN = '''
import pytest

@pytest.mark.points(2)
def test_it_drives(grading):
    """It stands still."""
    (drive,) = grading.evidence("moves")
    assert drive.score.distance_m > 0.5

@pytest.mark.points(4, visibility="after_due", hints=["Look left.", "Turn."])
def test_it_turns(grading):
    """The robot never turns."""
    (drive,) = grading.evidence("moves")
    assert abs(drive.track[:, 2] - drive.track[0, 2]).max() > 0.5

@pytest.mark.points(3)
def test_it_says_why(grading):
    (drive,) = grading.evidence("moves")
    assert drive.steps > 10_000, f"only {drive.steps} ticks"

@pytest.mark.points(1)
@pytest.mark.parametrize("metres", [0.1, 0.2, 50.0, 60.0])
def test_it_comes_far(grading, metres):
    """Farther."""
    assert grading.evidence("moves")[0].score.distance_m > metres

@pytest.mark.points(1)
def test_for_another_day(grading):
    pytest.skip("Later.")
'''


def folder_with(tmp_path: Path, own: str, sheet: str = QUICK + "tests: [test_own.py]\n") -> Path:
    folder = write_assignment(tmp_path / "q", sheet)
    (folder / "test_own.py").write_text(own)
    return folder


def graded(folder: Path) -> tuple[GradingResult, dict[str, CriterionResult]]:
    submission = Submission("ada", "controller.py", {"controller.py": FORWARD.encode()})
    result = grade(read_assignment(folder), submission, DESK)
    return result, {test.id: test for test in result.tests}


@pytest.mark.long
def test_they_earn_points_and_say_what_they_mean(tmp_path: Path) -> None:
    folder = folder_with(tmp_path, OWN)
    result, tests = graded(folder)
    assert read_assignment(folder).max_points == result.max_points == 6 + 11
    drives, turns, says, far = (
        tests[f"test_it_{name}"] for name in ("drives", "turns", "says_why", "comes_far")
    )
    assert (drives.status, drives.points, drives.title) == (CriterionStatus.PASS, 2.0, "It drives")
    assert (turns.status, turns.points, turns.rationale) == (
        CriterionStatus.FAIL,
        0.0,
        "The robot never turns.",
    )
    assert (turns.visibility, turns.hints) == (Visibility.AFTER_DUE, ("Look left.", "Turn."))
    assert (says.status, says.rationale) == (CriterionStatus.FAIL, "only 400 ticks")
    assert (far.status, far.points, far.rationale) == (CriterionStatus.PARTIAL, 0.5, "Farther.")
    assert tests["test_for_another_day"].status is CriterionStatus.SKIPPED
    assert "assert" not in "".join(test.rationale for test in tests.values()), "no test's source is told"
    assert graded(folder)[0].tests == result.tests


@pytest.mark.long
@pytest.mark.parametrize("body", ["raise KeyError('ours')", "grading.evidence('nothing')", "import nowhere"])
def test_one_that_breaks_costs_nobody_anything(tmp_path: Path, body: str) -> None:
    own = f"import pytest\n@pytest.mark.points(2)\ndef test_ours(grading):\n    {body}\n"
    result, tests = graded(folder_with(tmp_path, own))
    assert tests["test_ours"].status is CriterionStatus.GRADER_ERROR
    assert tests["test_ours"].log
    assert (result.verdict, result.points) == (GradingVerdict.BROKEN, None)


@pytest.mark.long
def test_a_file_that_cannot_be_loaded_is_the_graders_fault(tmp_path: Path) -> None:
    own = "import nowhere, pytest\n@pytest.mark.points(2)\ndef test_ours(grading): pass\n"
    assert graded(folder_with(tmp_path, own))[1]["test_ours"].status is CriterionStatus.GRADER_ERROR


def test_what_is_not_named_is_not_run(tmp_path: Path) -> None:
    """Whoever hands in may work in the assignment's folder."""
    marker = tmp_path / "ran"
    own = f"open({str(marker)!r}, 'w')\nimport pytest\n@pytest.mark.points(9)\ndef test_free(): pass\n"
    result, tests = graded(folder_with(tmp_path, own, QUICK))
    assert set(tests) == {"runs", "moves", "reached"}
    assert result.max_points == 6
    assert not marker.exists()


@pytest.mark.long
def test_a_conftest_beside_or_above_them_is_not_run(tmp_path: Path) -> None:
    marker = tmp_path / "ran"
    folder = folder_with(tmp_path, "import pytest\n@pytest.mark.points(2)\ndef test_ours(grading): pass\n")
    for place in (folder, folder.parent):
        (place / "conftest.py").write_text(f"open({str(marker)!r}, 'w')\n")
    assert graded(folder)[1]["test_ours"].status is CriterionStatus.PASS
    assert not marker.exists()


@pytest.mark.parametrize(
    ("own", "sheet", "said"),
    [
        (OWN, QUICK + "tests: [own.py]\n", "must be a file test_"),
        (OWN, QUICK + "tests: [test_none.py]\n", "must be a file test_"),
        ("def test_x(:\n", QUICK + "tests: [test_own.py]\n", "test_own.py"),
        ("@mark.points(1 + 1j)\ndef test_x(): pass\n", QUICK + "tests: [test_own.py]\n", "test_own.py:1"),
        ("@mark.points(-1)\ndef test_x(): pass\n", QUICK + "tests: [test_own.py]\n", "a number from 0"),
        ("@mark.points(1, weight=2)\ndef test_x(): pass\n", QUICK + "tests: [test_own.py]\n", "visibility"),
    ],
)
def test_a_teachers_mistake_is_told_with_its_place(tmp_path: Path, own: str, sheet: str, said: str) -> None:
    with pytest.raises(WorldError, match=said) as caught:
        read_assignment(folder_with(tmp_path, own, sheet))
    assert "assignment.yaml:" in str(caught.value)


def test_marks_are_read_without_running_anything(tmp_path: Path) -> None:
    file = tmp_path / "test_x.py"
    file.write_text(
        "raise SystemExit\n@pytest.mark.points(2.5)\ndef test_a_b(): 'Say so.'\ndef test_c(): pass\n"
    )
    assert [(each.title, each.points, each.feedback) for each in read_teacher_tests(file)] == [
        ("A b", 2.5, "Say so."),
        ("C", 0.0, ""),
    ]


@pytest.mark.long
def test_a_cohort_counts_them(tmp_path: Path) -> None:
    queue = Queue(tmp_path / "queue")
    handed = tmp_path / "in"
    handed.mkdir()
    (handed / "ada.py").write_text(FORWARD)
    (handed / "link.py").symlink_to("/etc/passwd")
    prepare_queue(
        queue,
        handed,
        read_assignment(folder_with(tmp_path, OWN)),
        GradingOptions(Level.LIMITED, may_lower_level=False),
    )
    queue.run_job(*queue.waiting())
    ada, link = gradebook_rows(queue)
    assert (ada.max_points, link.max_points) == (17.0, 17.0)
    assert (ada.tests["test_it_drives"], ada.tests["test_it_turns"]) == (2.0, 0.0)


@pytest.mark.long
def test_the_plugin_gives_them_their_points_too(tmp_path: Path) -> None:
    file = tmp_path / "ada.py"
    file.write_text(FORWARD)
    code, text, report = run_pytest(folder_with(tmp_path, OWN), file)
    assert code == 1, text
    points = {
        case.attrib["name"]: {each.attrib["name"]: each.attrib["value"] for each in case.iter("property")}
        for case in report.iter("testcase")
    }
    assert points["test_it_drives"] == {"points": "2", "max_points": "2"}
    assert points["test_it_turns"] == {"points": "0", "max_points": "4"}


SLOW = """
import pytest

@pytest.fixture
def endless(grading):
    while True:
        pass

@pytest.mark.points(1)
def test_it_drives(grading):
    assert grading.evidence("moves")

@pytest.mark.points(2)
def test_looks_at_it_for_ever(grading):
    while True:
        try:
            pass
        except Exception:
            pass

@pytest.mark.points(2)
def test_prepares_for_ever(endless):
    pass

@pytest.mark.points(2)
def test_comes_too_late(grading):
    pass
"""


def _swallow_every_error() -> None:
    while True:
        with contextlib.suppress(Exception):
            time.sleep(0.001)


def test_what_never_ends_is_ended_and_nothing_begins_afterwards() -> None:
    handler, had_alarm = signal.getsignal(signal.SIGALRM), bool(signal.getitimer(signal.ITIMER_REAL)[0])
    deadline = TestDeadline(0.1)
    with pytest.raises(TestTimeUsedUp), deadline.watch():
        _swallow_every_error()
    with pytest.raises(TestTimeUsedUp), deadline.watch():
        raise AssertionError("the time is used up")
    assert signal.getsignal(signal.SIGALRM) is handler
    assert bool(signal.getitimer(signal.ITIMER_REAL)[0]) is had_alarm, "another's alarm goes on"


@pytest.mark.long
def test_tests_have_a_clock_and_what_makes_them_slow_is_not_taken_for_a_fault_of_theirs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A program could make a test of what it did endless, and would get no grade instead of none of the points."""
    monkeypatch.setattr("grader.teacher_tests.running.MIN_TIME_S", 10.0)
    sheet = QUICK + "tests: [test_own.py]\nbudget: {submission: 1.5}\n"
    result, tests = graded(folder_with(tmp_path, SLOW, sheet))
    assert tests["test_it_drives"].points == 1.0
    late = [tests[f"test_{name}"] for name in ("looks_at_it_for_ever", "prepares_for_ever", "comes_too_late")]
    assert [(test.status, test.points) for test in late] == [(CriterionStatus.TIMEOUT, 0.0)] * 3
    assert result.verdict is not GradingVerdict.BROKEN


def test_a_test_comes_after_what_it_names(tmp_path: Path) -> None:
    folder = write_assignment(tmp_path / "own", QUICK + "tests: [test_own.py]\n")
    (folder / "test_own.py").write_text(
        "import pytest\n\n"
        '@pytest.mark.points(1, after="reached")\ndef test_late(grading):\n    """Late."""\n\n'
        '@pytest.mark.points(1, after="moves")\ndef test_moved(grading):\n    """Moved."""\n\n'
        '@pytest.mark.points(1, after="test_late")\ndef test_later(grading):\n    """Later."""\n'
    )
    submission = Submission("ada", "controller.py", {"controller.py": FORWARD.encode()})
    tests = {each.id: each for each in grade(read_assignment(folder), submission, DESK).tests}
    assert tests["test_moved"].status is CriterionStatus.PASS
    assert (tests["test_late"].status, tests["test_late"].depends_on) == (CriterionStatus.SKIPPED, "reached")
    assert tests["test_later"].depends_on == "test_late"


def test_a_test_after_nothing_is_a_mistake_of_the_sheet(tmp_path: Path) -> None:
    folder = write_assignment(tmp_path / "own", QUICK + "tests: [test_own.py]\n")
    (folder / "test_own.py").write_text(
        'import pytest\n\n@pytest.mark.points(1, after="reachd")\ndef test_late(grading):\n    """Late."""\n'
    )
    with pytest.raises(WorldError, match="reached"):
        read_assignment(folder)


@LOCKS
def test_the_folder_may_be_named_from_where_one_stands(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = write_assignment(tmp_path / "own", QUICK + "tests: [test_own.py]\n")
    (folder / "test_own.py").write_text(
        'import pytest\n\n@pytest.mark.points(1)\ndef test_moved(grading):\n    """Moved."""\n'
    )
    monkeypatch.chdir(tmp_path)
    submission = Submission("ada", "controller.py", {"controller.py": FORWARD.encode()})
    result = grade(read_assignment(Path("own")), submission, GradingOptions(Level.FILTERED))
    assert result.tests[-1].status is CriterionStatus.PASS
