"""A lesson by lines that come all at once, as a screen reader or a script sends them, and through a drive."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner

from kit.cli import main
from kit.school.lessons.reading import lessons_folder, solutions_folder
from kit.school.progress import EventKind, ProgressJournal

LINES = "l 4\nd\ndrive 0.3 0 2\nquit\nl 3\nq\n"


@pytest.mark.long
def test_lines_that_come_at_once_are_all_heeded(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "kit", "lesson", "1", "--plain", "--workspace", str(tmp_path)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as lesson:
        assert lesson.stdin is not None
        lesson.stdin.write(LINES)
        lesson.stdin.flush()  # and it stays open: nothing but the lines themselves says that there is more
        try:
            assert lesson.wait(timeout=120) == 0
        finally:
            lesson.kill()
        assert lesson.stdout is not None
        output = lesson.stdout.read()
    assert "does nothing here" not in output
    assert output.rindex("Step 3 of") > output.index("Checking")
    with ProgressJournal(tmp_path) as progress:
        (attempt,) = progress.events(EventKind.ATTEMPT)
    assert attempt.content["points"] > 0


@pytest.mark.parametrize("words", [["lesson"], ["progress"]])
def test_one_lesson_that_cannot_be_read_does_not_hide_the_others(
    words: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    lessons = tmp_path / "lessons"
    shutil.copytree(lessons_folder() / "01-drive", lessons / "01-drive")
    shutil.copy(lessons_folder() / "outcomes.yaml", lessons)
    (lessons / "02-braking").mkdir()
    (lessons / "02-braking" / "lesson.yaml").write_text("title: Braking\nminuts: 3\n")
    monkeypatch.setattr("kit.school.lessons.catalogue.lessons_folder", lambda: lessons)
    workspace = tmp_path / "desk"
    workspace.mkdir()
    with ProgressJournal(workspace) as progress:
        progress.add(EventKind.STEP, "01-drive/1")
    done = CliRunner().invoke(main, [*words, "--workspace", str(workspace)])
    assert done.exit_code == 0, done.output
    assert "02-braking" in done.output
    assert "1/8" in done.output or "#......." in done.output


@pytest.mark.long
def test_letters_and_words_lead_to_steps_and_others_do_nothing(tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-m", "kit", "lesson", "1", "--plain", "--workspace", str(tmp_path)],
        input="l 3\nl 4\nprevious\ng 1\nq\n",
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert "'g 1' does nothing here" in done.stdout
    assert done.stdout.count("Step 3 of") == 2  # by its number, and as the one before step 4


def test_nothing_is_checked_that_was_not_driven_and_no_run_is_shown_that_is_not_there(tmp_path: Path) -> None:
    lines = "l 4\nc\nw\nl 6\na\nq\n"
    done = CliRunner().invoke(main, ["lesson", "1", "--plain", "--workspace", str(tmp_path)], input=lines)
    assert done.exit_code == 0, done.output
    assert "You have not driven yet" in done.output
    assert "No run was recorded yet" in done.output
    assert "tmux" in done.output


def test_the_file_that_is_really_to_be_changed_is_named(tmp_path: Path) -> None:
    done = CliRunner().invoke(
        main, ["lesson", "5", "--plain", "--workspace", str(tmp_path)], input="l 6\nq\n"
    )
    assert "to-scale/maps/hall.yaml, and the files beside it\n" in done.output


def test_the_end_names_the_next_lesson(tmp_path: Path) -> None:
    with ProgressJournal(tmp_path) as progress:
        for number in range(1, 5):
            progress.add(EventKind.STEP, f"00-what-this-is-about/{number}")
        points = {"points": 1.0, "max_points": 1.0, "verdict": "pass"}
        progress.add(EventKind.ATTEMPT, "00-what-this-is-about/who", points)
    done = CliRunner().invoke(
        main, ["lesson", "A1", "--plain", "--workspace", str(tmp_path)], input="l 5\nn\n"
    )
    assert "Enter opens the next lesson, A2 Drive." in done.output
    assert "n next lesson" in done.output


@pytest.mark.long
def test_the_students_own_run_is_said_in_words(tmp_path: Path) -> None:
    file = tmp_path / "lessons" / "01-drive" / "square" / "square.py"
    file.parent.mkdir(parents=True)
    shutil.copy(solutions_folder() / "01-drive" / "square" / "solution.py", file)
    lines = "l 8\ny\nc\nw\ny\n2\n9\n1\n1\nq\n"
    done = CliRunner().invoke(main, ["lesson", "1", "--plain", "--workspace", str(tmp_path)], input=lines)
    assert "Passed: ***" in done.output, done.output
    assert "First pass the exercise" in done.output.partition("Passed:")[0]
    told = done.output.partition("Passed:")[2]
    assert "4.0 m driven, 0 bumps" in told
    told = " ".join(told.split())
    assert re.search(r"After 10 s, is it standing still\? \+ ", told)
    assert re.search(r"Which way does it first turn, by 30 degrees or more\? \+ ", told)
