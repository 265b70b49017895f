"""``kit form`` line by line: each answer is kept at once, and it goes on where it stopped."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner

from kit.cli import main
from kit.school.form_answers import FormAnswers
from kit.school.form_reading import read_form
from kit.school.progress import EventKind, ProgressJournal
from kit.school.survey import AnswerShape, QuestionPurpose, SurveyPhase


def answer(workspace: Path, *arguments: str, lines: str = "") -> str:
    result = CliRunner().invoke(main, ["form", *arguments, "--workspace", str(workspace)], input=lines)
    if result.exception is not None and not isinstance(result.exception, SystemExit):
        raise result.exception
    assert result.exit_code == 0, result.output
    return result.output


def kept(workspace: Path) -> FormAnswers:
    with ProgressJournal(workspace) as progress:
        return FormAnswers.from_events(read_form(), progress.events(EventKind.FORM))


def test_it_goes_on_where_it_stopped(tmp_path: Path) -> None:
    answer(tmp_path, lines="2\n5\n\n")
    found = kept(tmp_path)
    assert found.value("experience.robotics", SurveyPhase.BEFORE) == 5
    assert found.is_answered("experience.ros1", SurveyPhase.BEFORE)
    assert found.value("experience.ros1", SurveyPhase.BEFORE) is None
    text = answer(tmp_path, lines="6\nq\n")
    assert "Robotics" not in text
    assert kept(tmp_path).value("experience.ros2", SurveyPhase.BEFORE) == 6


def test_a_wrong_line_is_asked_again_and_b_goes_back(tmp_path: Path) -> None:
    answer(tmp_path, lines="nine\n2\n8\n5\nb\n6\nq\n")
    found = kept(tmp_path)
    assert found.value("experience.robotics", SurveyPhase.BEFORE) == 6
    assert not found.is_answered("experience.ros1", SurveyPhase.BEFORE)


def test_the_whole_form_before_and_after(tmp_path: Path) -> None:
    assert "Thank you" in answer(tmp_path, lines="1\n" + "4\n" * 7 + "n\n")
    assert "setup.install" not in {question for _, question in kept(tmp_path).values}
    assert "after the lessons" in answer(tmp_path, lines="q\n"), "what comes next is the form after"
    lines = "".join(
        {"scale": "4\n", "yes_no": "y\n", "text": "fine\n"}[each.shape]
        for each in read_form().questions_in_phase(SurveyPhase.AFTER)
    )
    assert "Thank you" in answer(tmp_path, lines=lines)
    assert "is answered" in answer(tmp_path, "after")
    shown = answer(tmp_path, "--show")
    assert "Robotics: 4" in shown
    assert "fine" in shown


def test_what_was_learned_is_asked_once_more_after_the_quiz(tmp_path: Path) -> None:
    form = read_form()
    twice = {each.id for each in form.questions_in_phase(SurveyPhase.QUIZZED)}
    assert twice == {
        each.id
        for each in form.questions
        if each.purpose in (QuestionPurpose.GAINED, QuestionPurpose.OUTCOME)
    }
    with ProgressJournal(tmp_path) as progress:
        for each in form.questions_in_phase(SurveyPhase.AFTER):
            value = {AnswerShape.SCALE: 5, AnswerShape.YES_NO: True}.get(each.shape)
            progress.add(EventKind.FORM, each.id, {"phase": "after", "value": value})
    assert "is answered" in answer(tmp_path), "before the quiz nothing more is asked"
    with ProgressJournal(tmp_path) as progress:
        progress.add(EventKind.ANSWER, "item", {"chosen": 1, "right": False, "occasion": "quiz"})
    assert "Thank you" in answer(tmp_path, lines="3\n" * len(twice))
    answers = kept(tmp_path)
    assert {answers.value(each, SurveyPhase.AFTER) for each in twice} == {5}
    assert {answers.value(each, SurveyPhase.QUIZZED) for each in twice} == {3}


def test_again_keeps_or_blanks(tmp_path: Path) -> None:
    answer(tmp_path, lines="2\n5\n3\nq\n")
    answer(tmp_path, "before", "--again", lines="\n\nx\nq\n")
    found = kept(tmp_path)
    assert found.value("experience.robotics", SurveyPhase.BEFORE) == 5
    assert found.is_answered("experience.ros1", SurveyPhase.BEFORE)
    assert found.value("experience.ros1", SurveyPhase.BEFORE) is None


def test_the_screen_is_wide_enough(tmp_path: Path) -> None:
    text = answer(tmp_path, "after", lines="4\n" * 13 + "y\ny\n" + "4\n" * 16 + "words\ny\n")
    assert max(map(len, text.splitlines())) <= 80


@pytest.mark.long
@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGTERM])
def test_a_kill_loses_nothing_that_was_answered(tmp_path: Path, how: signal.Signals) -> None:
    process = subprocess.Popen(
        [sys.executable, "-m", "kit", "form", "before", "--workspace", str(tmp_path)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        env={**os.environ, "PYTHONUNBUFFERED": "1"},
    )
    assert process.stdin is not None
    assert process.stdout is not None
    try:
        process.stdin.write(b"3\n2\n7\n")
        process.stdin.flush()
        seen = b""
        while b"ROS 2" not in seen:  # asked only when the answers before it are on the disk
            seen += os.read(process.stdout.fileno(), 4096)
        process.send_signal(how)
    finally:
        process.wait(timeout=20)
        process.stdin.close()
        process.stdout.close()
    found = kept(tmp_path)
    assert found.value("experience.robotics", SurveyPhase.BEFORE) == 2
    assert found.value("experience.ros1", SurveyPhase.BEFORE) == 7


def test_an_unusable_workspace_is_reported(tmp_path: Path) -> None:
    file = tmp_path / "file"
    file.write_text("")
    result = CliRunner().invoke(main, ["form", "--workspace", str(file)], input="")
    assert result.exit_code == 2
    assert str(file) in result.output
