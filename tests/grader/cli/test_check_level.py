"""`grader check` runs programs confined unless `--level 0` is said."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from grader.__main__ import main
from grader.reading import read_assignment
from kit.host.sandbox import probe
from kit.host.sandbox.sandbox_config import Level
from kit.school.lessons.reading import lessons_folder
from tests.grader.conftest import LOCKS, write_assignment

BLANK = """
title: One word
kind: function
submit: half.py
level: 0
functions: [{name: half}]
checks: [{check: agrees, points: 1}]
"""
REFERENCE = """
def half(x): return x / 2
def half_cases(random): yield {"x": random.random()}
"""


def check(folder: Path, *arguments: str) -> Result:
    task = write_assignment(folder / "task", BLANK)
    (task / "reference.py").write_text(REFERENCE)
    work = folder / "half.py"
    work.write_text("def half(x): return x / 2\n")
    return CliRunner().invoke(main, ["check", str(work), "--assignment", str(task), *arguments])


@LOCKS
def test_a_check_confines_whatever_the_sheet_says(tmp_path: Path) -> None:
    """The sheets of lessons say level 0, for the student's own screen; what is checked by command may be anybody's."""
    done = check(tmp_path, "--json")
    assert done.exit_code == 0
    result = json.loads(done.stdout)
    assert result["level"] == 1
    assert not any("confinement level" in notice for notice in result["notices"])


@LOCKS
@pytest.mark.parametrize(("arguments", "is_written"), [((), False), (("--level", "0"), True)])
def test_a_lesson_checked_for_somebody_else_writes_nothing(
    tmp_path: Path, arguments: tuple[str, ...], is_written: bool
) -> None:
    """The control is the second case: at level 0 the same program writes the teacher's file."""
    target, work = tmp_path / "teachers.txt", tmp_path / "functions.py"
    work.write_text(f"open({str(target)!r}, 'w').write('written')\n")
    lesson = lessons_folder() / "10-words-of-learning" / "sectors"
    assert read_assignment(lesson).level is Level.LIMITED
    work = work.rename(tmp_path / read_assignment(lesson).submit)
    CliRunner().invoke(main, ["check", str(work), "--assignment", str(lesson), *arguments])
    assert target.exists() is is_written


def test_level_0_is_told_beside_the_classs(tmp_path: Path) -> None:
    done = check(tmp_path, "--level", "0")
    assert done.exit_code == 0
    text = " ".join(done.output.split())
    assert "Run at confinement level 0. A class is graded at level 1 or higher." in text


def test_a_machine_without_confinement_refuses_and_names_the_way_out(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(probe, "_known_levels", set())
    monkeypatch.setattr(probe, "is_level_available", lambda level: level is Level.LIMITED)
    done = check(tmp_path)
    assert done.exit_code == 2
    assert "does not reach confinement level 1" in done.output
    assert "--level 0" in done.output
    assert check(tmp_path, "--level", "0").exit_code == 0


def test_a_machine_with_a_lower_level_names_that_one(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(probe, "_known_levels", set())
    monkeypatch.setattr(probe, "is_level_available", lambda level: level <= Level.FILTERED)
    done = check(tmp_path, "--level", "2")
    assert done.exit_code == 2
    assert "--level 1" in done.output


def test_secrets_that_are_not_used_are_named_and_cost_nothing(tmp_path: Path) -> None:
    (tmp_path / "task").mkdir()
    (tmp_path / "task" / "secret.yaml").write_text("seed: 4611686018427387905\n")
    done = check(tmp_path, "--json")
    assert "--secret was not given" in done.stderr
    assert json.loads(done.stdout)["verdict"] == "pass"
    assert "--secret" not in check(tmp_path, "--secret", "--level", "0", "--json").stderr
