"""What an author is told of the works of an assignment; wrong works as edits of their solution."""

from __future__ import annotations

import difflib
import shutil
from dataclasses import replace
from pathlib import Path

import pytest

from grader import self_test
from grader.grading import GradingOptions
from grader.kinds.plan import kind
from grader.reading import read_assignment
from grader.self_test import (
    ENDING,
    STARTER_RULE,
    EditsError,
    WorkReport,
    apply_edits,
    list_wrong_works,
    try_works,
    written_out,
)
from grader.submission import Submission
from grader.submitted_files import SubmissionUnreadable
from kit.host.sandbox.sandbox_config import Level
from tests.grader.conftest import TEMPLATES

SOLUTION = "import math\n\n\ndef turn(angle):\n    speed = 2.0 * angle\n    return speed\n\n\ndef stop():\n    return 0.0\n"
ROOT = Path(__file__).parents[2]


def test_what_diff_prints_is_made() -> None:
    wrong = SOLUTION.replace("2.0 *", "-2.0 *").replace("return 0.0", "return 0.1") + "stop()\n"
    for around in (1, 2, 3):
        edits = difflib.unified_diff(
            SOLUTION.split("\n"), wrong.split("\n"), "solution.py", "wrong.py", n=around, lineterm=""
        )
        assert apply_edits(SOLUTION, "\n".join(edits) + "\n") == wrong


def test_no_edit_is_the_solution() -> None:
    assert apply_edits(SOLUTION, "") == SOLUTION


@pytest.mark.parametrize(
    ("edits", "complaint"),
    [
        ("@@\n-    speed = 3.0 * angle\n+    speed = 1.0\n", "edit 1: .* not in the solution"),
        ("@@\n-\n+# twice\n", "there 5 times"),
        ("@@\n+a line from nowhere\n", "nothing: give a line beside it"),
        ("@@\n     return 0.0\n+# end\n@@\n import math\n+import os\n", "edit 2: .* not in the solution"),
    ],
    ids=["another line", "not one place", "no place", "not in order"],
)
def test_what_does_not_fit_is_refused(edits: str, complaint: str) -> None:
    with pytest.raises(EditsError, match=complaint):
        apply_edits(SOLUTION, edits)


def test_a_folder_of_wrong_works_may_mix_them(tmp_path: Path) -> None:
    wrong, solution = tmp_path / "wrong", tmp_path / "solution.py"
    wrong.mkdir()
    solution.write_text(SOLUTION)
    (wrong / "turns__backwards.diff").write_text("@@\n-    speed = 2.0 * angle\n+    speed = -2.0 * angle\n")
    (wrong / "turns__never.py").write_text("def turn(angle):\n    return 0\n")
    (wrong / "__pycache__").mkdir()
    (wrong / "notes.txt").write_text("")
    works = list_wrong_works(wrong, ".py")
    assert [each.name for each in works] == ["turns__backwards.diff", "turns__never.py"]
    first, second = (written_out(each, solution, tmp_path) for each in works)
    assert first.name == "turns__backwards.py"
    assert first.read_text() == SOLUTION.replace("2.0 *", "-2.0 *")
    assert second == works[1]


def test_edits_of_a_missing_solution_are_named(tmp_path: Path) -> None:
    edits = tmp_path / "turns.diff"
    edits.write_text("@@\n-a\n+b\n")
    with pytest.raises(EditsError, match=r"turns\.diff"):
        written_out(edits, tmp_path / "solution.py", tmp_path)


def test_all_edits_of_the_lessons_fit_their_solution(tmp_path: Path) -> None:
    edits = list((ROOT / "tests" / "solutions").glob(f"*/*/wrong/*{ENDING}"))
    assert len(edits) > 100
    for each in edits:
        (solution,) = (file for file in each.parent.parent.glob("solution.*") if file.is_file())
        assert written_out(each, solution, tmp_path).read_text() != solution.read_text()


def test_wrong_works_do_not_repeat_their_solution() -> None:
    """What lies beside a solution and is nearly it is written as edits of it."""
    for work in (ROOT / "tests" / "solutions").glob("*/*/wrong/*.py"):
        solution = work.parent.parent / "solution.py"
        lines = work.read_text().splitlines()
        if not solution.exists() or len(lines) < 20:
            continue
        blocks = difflib.SequenceMatcher(
            None, solution.read_text().splitlines(), lines, autojunk=False
        ).get_matching_blocks()
        assert sum(block.size for block in blocks) < 0.9 * len(lines), f"{work}: write it as edits"


def test_works_are_graded_side_by_side_with_the_same_reports(tmp_path: Path) -> None:
    folder = tmp_path / "plan"
    shutil.copytree(TEMPLATES / "plan", folder)
    options = GradingOptions(Level.LIMITED)
    assignment = replace(read_assignment(folder), level=Level.LIMITED)
    assert list(try_works(assignment, options, jobs=2)) == list(try_works(assignment, options))


def test_where_a_reader_failed_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(path: Path, main: str) -> Submission:
        raise SubmissionUnreadable("It cannot be read.", "TypeError in my_kind/kind.py:57")

    monkeypatch.setattr(self_test, "read_submission", fail)
    folder = tmp_path / "plan"
    shutil.copytree(TEMPLATES / "plan", folder)
    reports = list(try_works(read_assignment(folder), GradingOptions(Level.LIMITED)))
    assert reports
    assert all("my_kind/kind.py:57" in problem for each in reports for problem in each.problems)


def plan_reports(folder: Path) -> list[WorkReport]:
    return list(try_works(read_assignment(folder), GradingOptions(Level.LIMITED)))


def test_a_starter_that_stops_is_told_the_rule(tmp_path: Path) -> None:
    folder = tmp_path / "plan"
    shutil.copytree(TEMPLATES / "plan", folder)
    assert STARTER_RULE not in plan_reports(folder)[0].problems
    (folder / "starter.yaml").write_text("layers: nothing yet\n")
    problems = plan_reports(folder)[0].problems
    assert problems[-1] == STARTER_RULE
    assert "starter.yaml:1" in problems[0] or "plan.yaml:1" in problems[0]


def test_where_a_check_failed_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(case: object, plan: object) -> object:
        return ()[1]

    monkeypatch.setattr(kind, "find_breaches", fail)
    folder = tmp_path / "plan"
    shutil.copytree(TEMPLATES / "plan", folder)
    problems = plan_reports(folder)[1].problems
    assert any("IndexError" in each and "grader/test_self_test.py:" in each for each in problems)
